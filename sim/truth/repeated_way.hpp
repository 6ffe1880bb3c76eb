// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace adit::sim {

/// How much of their way robots drove where one of them had been before: within 1.5 m of a track more than
/// 10 s old. Positions are true ones, world frame, m.
class RepeatedWay {
 public:
  static constexpr double kNear = 1.5;  ///< m
  static constexpr double kOld = 10.0;  ///< s

  explicit RepeatedWay(std::size_t robots) : tracks_(robots) {}

  /// Where a robot is now; to be called in the order of time, a few times a second.
  void add(std::size_t robot, double time_s, const Eigen::Vector2d& position);

  double metres() const { return metres_; }
  /// Repeated metres over all metres, [0, 1].
  double share() const { return metres_ > 0 ? repeated_ / metres_ : 0; }

 private:
  struct Place {
    Eigen::Vector2d position;
    double time_s;
  };
  static constexpr double kApart = 0.25;  ///< Distance between the recorded places of a track, m.
  struct Track {
    Eigen::Vector2d now, recorded;
  };
  bool was_here(const Eigen::Vector2d& position, double before_s) const;

  std::vector<std::optional<Track>> tracks_;                        ///< By robot.
  std::unordered_map<std::uint64_t, std::vector<Place>> places_{};  ///< By square of kNear.
  double metres_{}, repeated_{};
};

}  // namespace adit::sim
