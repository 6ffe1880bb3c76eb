// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/result/result.hpp"
#include "core/time/time.hpp"

namespace adit::station {

/// A single picture of a camera, whole.
struct ShotPicture {
  std::vector<std::uint8_t> jpeg{};
  double age{};                                 ///< From its exposure until it was whole here, s.
  std::optional<std::array<float, 4>> place{};  ///< Of the robot: x y z yaw, map frame, m, rad.
};

/// Single pictures that this station asked robots for, as their pieces come. Bounded.
class ShotDesk {
 public:
  static constexpr std::size_t kMost = 8;  ///< Pictures that are awaited.
  static constexpr Duration kFirst{20s};   ///< So long after its first request the first piece must be here.
  static constexpr Duration kSilence{120s};   ///< Without a new piece for so long, a picture is given up.
  static constexpr Duration kPatience{600s};  ///< A picture whose turn does not come is given up.

  using Done = std::function<void(const Result<ShotPicture>&)>;

  /// `first`: of the numbers; drawn at each start, so that robots do not take them for those of the run
  /// before.
  explicit ShotDesk(std::uint32_t first = 0) : last_(first) {}

  /// Awaits a picture; returns its number, not 0, which the request to the robot carries; 0: too many are
  /// awaited, and `done` is not called.
  std::uint32_t await(const std::string& robot, const std::string& camera, Time now, Done done);
  /// Notes that robots were asked for that picture.
  void asked(std::uint32_t number, Time now);
  /// The oldest picture that is awaited of that camera; 0: none is.
  std::uint32_t awaited(const std::string& robot, const std::string& camera) const;
  /// Robot and camera of the awaited pictures, each once.
  std::vector<std::pair<std::string, std::string>> awaited_cameras() const;
  /// Takes a piece of a robot. Errors: as of transfer::decode_shot_piece(); malformed also for a picture
  /// that is damaged as a whole. A piece of no awaited picture counts as taken.
  Result<void> take(const std::string& robot, std::span<const std::uint8_t> bytes, Time now);
  /// Gives up what is late: no_answer.
  void tick(Time now);
  /// Ends all: cancelled.
  void cancel_all();

  /// Share of the picture that is here, [0, 1].
  double progress(std::uint32_t number) const;

 private:
  struct Awaited {
    std::string robot{}, camera{};
    std::uint64_t order{};
    Time since{};                ///< When it was wanted.
    std::optional<Time> last{};  ///< When robots were first asked for it, or a piece came.
    Done done{};
    std::uint32_t bytes{}, crc{};
    std::size_t here{};
    std::vector<bool> blocks{};
    std::vector<std::uint8_t> jpeg{};
  };
  void finish(std::uint32_t number, const Result<ShotPicture>& result);

  std::map<std::uint32_t, Awaited> all_{};
  std::uint32_t last_;
  std::uint64_t orders_{};
};

}  // namespace adit::station
