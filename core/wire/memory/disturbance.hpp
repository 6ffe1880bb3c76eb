#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/wire/link/model.hpp"

namespace adit::wire {

/// Attenuation by what stands between two places, dB.
using Attenuation = std::function<double(const Position& a, const Position& b)>;

/// What is wrong between machines for a while. Several may be on at once, also of the same kind between the
/// same machines: each ends alone. The worst loss counts, delays add up, chances combine.
struct Disturbance {
  /// Whom it concerns: frames from one of `from` to one of `to`; empty: all machines.
  std::vector<std::string> from{}, to{};
  bool both_ways{true};  ///< also from one of `to` to one of `from`
  /// Instead: machines of different groups; a machine of no group is not concerned.
  std::vector<std::vector<std::string>> groups{};

  bool cut{};                    ///< nothing passes
  std::optional<double> loss{};  ///< chance that a frame is lost, instead of the link's, [0, 1]
  Duration delay{};              ///< added to the latency
  double reorder{};              ///< chance that a message is held back by up to `reorder_by`, [0, 1]
  Duration reorder_by{200ms};
  double duplicate{};  ///< chance that a message arrives twice, [0, 1]
  double slower{1.0};  ///< the bandwidth is divided by this, [1, 1e6]
};

using DisturbanceId = std::uint64_t;

/// Those that are on.
class Disturbances {
 public:
  /// All of them together on one direction.
  struct Effect {
    bool cut{};
    std::optional<double> loss{};
    Duration delay{};
    double reorder{};
    Duration reorder_by{};
    double duplicate{};
    double slower{1.0};
  };

  DisturbanceId add(Disturbance disturbance);
  void end(DisturbanceId id) { on_.erase(id); }
  Effect on(const std::string& from, const std::string& to) const;
  bool none() const { return on_.empty(); }

 private:
  std::map<DisturbanceId, Disturbance> on_{};
  DisturbanceId next_{1};
};

}  // namespace adit::wire
