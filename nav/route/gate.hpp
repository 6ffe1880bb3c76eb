#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "nav/route/surface_map.hpp"

namespace adit::nav {

/// A place on a route that is hardly wider than the robot: a door, a gap in a wall, the mouth of a passage.
struct Gate {
  Eigen::Vector3d middle{0, 0, 0};  ///< between what stands on both sides, m
  Eigen::Vector2d axis{1, 0};       ///< through it, the way that the route leads; of length one
};

/// The first gate of a route over its first `ahead` metres: where what stands on both sides, by way of the
/// route, is no more than `width` (m) apart. Who is led there keeps at least about `beside` (m) from it. The
/// place that the route begins in is none, but a door at the end of a passage is. Nothing when there is none,
/// or the map does not know.
std::optional<Gate> find_gate(const SurfaceMap& map, std::span<const Eigen::Vector3d> points, double ahead,
                              double width, double beside);

}  // namespace adit::nav
