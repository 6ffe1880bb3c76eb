// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/config/platform.hpp"
#include "nav/routing/surface_map.hpp"

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

/// Finds the first narrow passage on the first `ahead` metres of a route: a place where the widest straight
/// strip between the obstacles on both sides is at most `width`, m. `beside`: minimum distance between the
/// route and the obstacles, m. The narrow place in which the route begins does not count, but a door at the
/// end of a corridor does. Returns nothing if there is no passage or the map is unknown there.
std::optional<NarrowPassage> find_passage(const SurfaceMap& map, std::span<const Eigen::Vector3d> points,
                                          double ahead, double width, double beside);

}  // namespace adit::nav
