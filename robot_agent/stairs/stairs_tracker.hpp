// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/staircase.hpp"

namespace adit::agent {

/// Staircases over the clouds of a robot, in its odometry frame. One is confirmed once it was seen from three
/// places; what is seen once may be rubble. Each further sight refines it (information filter). Pure.
class StairsTracker {
 public:
  /// A confirmed staircase, with a number that no other one of any tracker of this robot had.
  struct Tracked {
    std::uint64_t id{};
    Staircase stairs{};
  };
  static constexpr int kConfirmed = 3;      ///< Places from which it was seen.
  static constexpr double kApart = 0.3;     ///< Between them, m.
  static constexpr std::size_t kMost = 64;  ///< Tracks; then the one that was seen longest ago is dropped.

  /// `instance`: number of this tracker since the start of the agent.
  explicit StairsTracker(std::uint32_t instance = 0) : next_(std::uint64_t{instance} << 32) {}

  /// Takes what one cloud shows. `from`: place of the robot, m.
  void take(std::span<const Staircase> seen, const Eigen::Vector3d& from);
  /// The odometry frame is another one.
  void clear() { tracks_.clear(); }
  /// The confirmed ones, as they are known best.
  std::vector<Tracked> confirmed() const;

 private:
  struct Track {
    std::uint64_t id{};
    Staircase stairs{};
    Eigen::Vector3d from{};  ///< The last place that counted.
    int places{1};
    std::size_t seen{};  ///< Number of the cloud.
  };
  std::vector<Track> tracks_{};
  std::size_t clouds_{};
  std::uint64_t next_;
};

/// Clouds of one robot share the errors of its odometry: no number of them makes a flight more certain than
/// this.
Staircase with_least_sigma(Staircase stairs);
/// Whether an operator, or a robot that climbs, would want to know.
bool differs(const Staircase& a, const Staircase& b);

}  // namespace adit::agent
