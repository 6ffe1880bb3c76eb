// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "basestation/model/numbering.hpp"
#include "basestation/model/world.hpp"
#include "core/result/result.hpp"

/// Worlds as differences, which a front end puts together again.
namespace adit::station {

/// A world as JSON, each part by its name. Without notices, which front ends receive one by one.
struct EncodedWorld {
  double at{};
  nlohmann::json head{};  ///< Station, link, counts.
  std::map<std::string, nlohmann::json> robots{}, stations{}, traffic{};
};
EncodedWorld encoded(const World& world);

/// The urgency of a difference for a front end.
enum class Urgency : std::uint8_t {
  none,    ///< Nothing differs but ages that grew with time.
  motion,  ///< Only values that change all the time: poses, charge, rates.
  change,  ///< Something that an operator acts on.
};

/// A difference that leads from one world to a later one.
struct Delta {
  nlohmann::json json{};
  Urgency urgency{};
};
/// `before` may be any earlier one: a front end that slept reads one difference, not many. Of a robot only
/// the keys that differ are in it.
Delta difference(const EncodedWorld& before, const EncodedWorld& now);

/// The front end's side: the world after a complete one and all differences since.
class WorldBuilder {
 public:
  /// Takes {"at": ..., ...} of json_of(World).
  Result<void> start(const nlohmann::json& complete);
  /// Errors: malformed; then only start() helps.
  Result<void> apply(const nlohmann::json& delta);
  /// Adds a notice; the newest kMaxNotices are stored.
  void add(const Notice& notice);
  /// Ages count up to the time of the last difference; robots and stations are in natural order of names.
  World world() const;

 private:
  static constexpr std::size_t kMaxNotices = 30;

  /// A part that was read, its JSON, and when it was heard by the station's clock, s.
  template <class T>
  struct Part {
    nlohmann::json json{};
    T value{};
    double heard{};
  };
  template <class T>
  using Parts = std::map<std::string, Part<T>, NaturalOrder>;
  template <class T>
  static Result<void> merge(const nlohmann::json& delta, const char* key, double at, const char* what,
                            Parts<T>& parts);

  double at_{};
  nlohmann::json head_{};
  World head_world_{};
  Parts<Robot> robots_{};
  Parts<StationSummary> stations_{};
  Parts<AgentRate> traffic_{};
  std::vector<Part<Notice>> notices_{};
};

}  // namespace adit::station
