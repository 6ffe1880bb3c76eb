// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/config/platform.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

/// A door, a gap in a wall, or the mouth of a corridor, hardly wider than the robot. Map frame.
struct NarrowPassage {
  Eigen::Vector3d middle{0, 0, 0};  ///< Centre between the obstacles on both sides, m.
  Eigen::Vector2d axis{1, 0};       ///< Unit vector through the passage, in the direction of the route.
  double clear_width{0};            ///< Width of the widest straight strip through it, m.
};

/// Clear width below which a robot has to follow the axis of a passage, m: its width plus, on each side, the
/// tracking error and three standard deviations of the passage's position after `approach` metres of
/// odometry. Any path of the planner fits through a wider one.
double narrow_width(const Platform& platform, double approach);

/// Fits the widest straight strip between `obstacles`, which are relative to the middle of `guess`, m,
/// starting from its middle and axis. Its sides need not be opposite each other. Returns nothing if one side
/// is open.
std::optional<NarrowPassage> fit_passage(const NarrowPassage& guess,
                                         std::span<const ObstaclePoint> obstacles);

}  // namespace adit::nav
