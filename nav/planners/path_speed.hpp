// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "core/config/platform.hpp"
#include "nav/geometry/footprint.hpp"
#include "nav/planners/plan.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

/// Parameters of path_speed().
struct PathSpeedParams {
  double caution{0.3};       ///< Speed with an obstacle at the footprint, m/s, (0, 2].
  double caution_gain{2.4};  ///< Additional speed per clearance, 1/s, [0, 10].
  double blind{0.6};         ///< Speed where the path enters hidden space, m/s, (0, 5].
  /// Fraction of the platform's acceleration used to brake to these speeds in time, (0, 1].
  double braking_share{0.7};
};

/// Speed limit at the start of a path, m/s. Near obstacles, anywhere along the path, the limit falls with the
/// clearance. Where the path enters space that is hidden from `pose`, it is low enough for obstacles that may
/// come out. Later places count as far as the distance to them is too short for braking.
double path_speed(const Plan& plan, const Pose2& pose, const Footprint& body, const Platform& platform,
                  std::span<const ObstaclePoint> obstacles, const PathSpeedParams& params = {});

}  // namespace adit::nav
