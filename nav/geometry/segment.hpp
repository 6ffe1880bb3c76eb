// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>

namespace adit::nav {

/// z of the cross product; positive if b is to the left of a.
inline double cross_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The part of the line from `from` to `to` that lies before its point nearest to `place`, [0, 1].
inline double part_before(const Eigen::Vector2d& place, const Eigen::Vector2d& from,
                          const Eigen::Vector2d& to) {
  const Eigen::Vector2d way = to - from;
  const double square = way.squaredNorm();
  return square > 0.0 ? std::clamp((place - from).dot(way) / square, 0.0, 1.0) : 0.0;
}

/// Squared distance from a place to the line between two corners.
inline double squared_distance(const Eigen::Vector2d& place, const Eigen::Vector2d& from,
                               const Eigen::Vector2d& to) {
  const Eigen::Vector2d side = to - from;
  return (place - from - part_before(place, from, to) * side).squaredNorm();
}

}  // namespace adit::nav
