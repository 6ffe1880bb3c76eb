// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace adit::sim {

/// Red, green and blue of a surface, each a reflectance in [0, 1].
using SurfaceColour = Eigen::Array3f;

/// A side of a solid cell of the world: a wall across the x axis or across the y axis, a floor or a ceiling.
enum class SurfaceSide : std::uint8_t { wall_x, wall_y, floor, ceiling };

/// The colour of the world's surface at a point (world frame, m). It depends on the arguments alone: floors
/// are dark tiles of 0.5 m, ceilings bright panels of 0.6 m, walls panels of 1 m, coloured by the place. What
/// is finer than `footprint`, the width of the surface that one pixel sees, m, fades.
SurfaceColour surface_colour(SurfaceSide side, const Eigen::Vector3d& point, float footprint);

/// The bodies that cameras see.
enum class BodyKind : std::uint8_t { robot, person, door };

/// The colour of a body at that share of its height, [0, 1]: robots are orange on dark wheels, people blue
/// with a bright head, doors brown. No surface of the world has these colours.
SurfaceColour body_colour(BodyKind kind, float height);

}  // namespace adit::sim
