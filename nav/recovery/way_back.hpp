// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "core/config/platform.hpp"
#include "nav/geometry/footprint.hpp"
#include "nav/planners/plan.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

/// The last metres that a robot drove, along which it can back up: that ground was free a moment ago, and the
/// body fits there at those headings. Odometry frame. The size is fixed, and nothing is allocated.
class WayBack {
 public:
  static constexpr double kLength = 3.0;    ///< Length that is kept, m.
  static constexpr double kSpeed = 0.4;     ///< Speed limit on the way back, m/s.
  static constexpr double kMargin = 0.02;   ///< Clearance around the body beyond the trail, m.
  static constexpr double kLeast = 0.15;    ///< A shorter way back is none, m.
  static constexpr double kStraight = 1.2;  ///< A shorter trail is continued straight to this length, m.

  explicit WayBack(const Platform& platform);

  /// Records a pose of the robot that drives towards its target.
  void note(const Pose2& pose);
  /// Plans the way back from `pose`, as far as it is free of `obstacles` (robot's frame at `pose`) and driven
  /// in one direction. Nothing if no way back is free.
  std::optional<Plan> plan(const Pose2& pose, std::span<const ObstaclePoint> obstacles);
  void clear() { count_ = 0; }

 private:
  static constexpr double kSpacing = 0.1;  ///< m
  static constexpr std::size_t kMax = static_cast<std::size_t>(kLength / kSpacing);

  const Pose2& newest(std::size_t back = 0) const { return poses_[count_ - 1 - back]; }
  /// Whether no obstacle is deeper in the body than `depth`, m.
  static bool is_free(const Footprint& body, const Pose2& at, std::span<const ObstaclePoint> obstacles,
                      float depth);

  Platform platform_;
  Footprint body_, grown_;
  std::array<Pose2, kMax> poses_{};
  std::size_t count_{0};
};

}  // namespace adit::nav
