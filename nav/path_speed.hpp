// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "core/config/platform.hpp"
#include "nav/footprint.hpp"
#include "nav/plan.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

struct PathSpeedParams {
  double caution{0.3};        ///< speed with an obstacle at the footprint, m/s, (0, 2]
  double caution_gain{2.4};   ///< more speed for each metre of clearance, 1/s, [0, 10]
  double blind{0.6};          ///< where the path leads behind something that hides it, m/s, (0, 5]
  double braking_share{0.7};  ///< of the platform's acceleration, to be down to these in time, (0, 1]
};

/// How fast a path may be driven from its start on, m/s: near obstacles, along all of its length, slower by
/// how near they are; where it comes behind something (as seen from `pose`), slow enough for what may
/// come out there. Later places count by as much as is left to brake for them.
double path_speed(const Plan& plan, const Pose2& pose, const Footprint& body, const Platform& platform,
                  std::span<const ObstaclePoint> obstacles, const PathSpeedParams& params);

}  // namespace adit::nav
