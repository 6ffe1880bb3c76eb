// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

namespace adit::perception {

/// A point of a planar lidar stands for a piece of wall from this far below it to as far above it, m: with
/// the copies of its points at both ends, a wall that it sees is a plane (VoxelPlanes). A robot that drives
/// leans by less than 0.03 rad, so that its ring meets a wall in 10 m within this height again.
inline constexpr float kPlanarHeight = 0.15f;

/// Appends the point and its copies at both ends of that piece of wall.
template <class Points, class Point>
void add_piece_of_wall(Points& points, const Point& at) {
  using Scalar = typename Point::Scalar;
  const Point up(Scalar{0}, Scalar{0}, static_cast<Scalar>(kPlanarHeight));
  points.push_back(at);
  points.push_back(at + up);
  points.push_back(at - up);
}

}  // namespace adit::perception
