// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/config/platform.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

/// A door, a gap in a wall, or the mouth of a corridor that is hardly wider than the robot. Frame: the map's.
struct NarrowPassage {
  Eigen::Vector3d middle{0, 0, 0};  ///< Between what bounds it on both sides, m.
  Eigen::Vector2d axis{1, 0};       ///< Through it, in the direction of the route; of length one.
  double clear_width{0};            ///< Of the widest straight strip through it, m.
};

/// The clear width below which a robot has to go through a passage straight along its axis, m: its width and,
/// on each side, the tracking error and three standard deviations of where the passage is after `approach`
/// metres of odometry. Any other path of the planner gets through a wider one.
double narrow_width(const Platform& platform, double approach);

/// Fits the widest straight strip between `obstacles`, which are relative to the middle of `guess`, m,
/// starting from its middle and axis. Its sides need not be opposite each other. Nothing where one side is
/// open.
std::optional<NarrowPassage> fit_passage(const NarrowPassage& guess,
                                         std::span<const ObstaclePoint> obstacles);

}  // namespace adit::nav
