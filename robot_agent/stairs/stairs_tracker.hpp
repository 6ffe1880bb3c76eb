// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/staircase.hpp"

namespace adit::agent {

/// Staircases over the clouds of a robot, in its odometry frame. One is confirmed once it was seen from three
/// places; what is seen once may be rubble. Each further sight refines it (information filter). Pure.
class StairsTracker {
 public:
  static constexpr int kConfirmed = 3;      ///< Places from which it was seen.
  static constexpr double kApart = 0.3;     ///< Between them, m.
  static constexpr std::size_t kMost = 64;  ///< Tracks; then the one that was seen longest ago is dropped.

  /// Takes what one cloud shows.
  /// @param from  Place of the robot, m.
  /// @return  Those confirmed that are new, or changed by more than their use allows.
  std::vector<Staircase> take(std::span<const Staircase> seen, const Eigen::Vector3d& from);
  /// The odometry frame is another one.
  void clear() { tracks_.clear(); }
  /// The confirmed ones, as they are known best.
  std::vector<Staircase> confirmed() const;

 private:
  struct Track {
    Staircase stairs{};
    Eigen::Vector3d from{};  ///< The last place that counted.
    int places{1};
    std::size_t seen{};  ///< Number of the cloud.
    std::optional<Staircase> reported{};
  };
  std::vector<Track> tracks_{};
  std::size_t clouds_{};
};

}  // namespace adit::agent
