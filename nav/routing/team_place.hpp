// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>

namespace adit::nav {

/// Another robot of the team on the ground. It blocks no cell, because it may move away, but a route through
/// it costs more. Frame of the map, m.
struct TeamPlace {
  Eigen::Vector3d place{0.0, 0.0, 0.0};
  double radius{};  ///< Of the disc that a route may not cross free of charge.
  double cost{};    ///< Of a route across the middle of the disc, beside its length.
};

/// The additional cost of a straight line, m.
inline double team_cost(std::span<const TeamPlace> team, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& to) {
  constexpr double kSameFloor = 1.0;  // m
  const Eigen::Vector2d way = (to - from).head<2>();
  const double length = way.norm();
  double cost = 0.0;
  for (const TeamPlace& robot : team) {
    if (length < 1e-6 || std::fabs((from.z() + to.z()) / 2 - robot.place.z()) > kSameFloor) continue;
    const Eigen::Vector2d to_robot = (robot.place - from).head<2>();
    const double along = to_robot.dot(way) / length;
    const double half2 = robot.radius * robot.radius - to_robot.squaredNorm() + along * along;
    if (half2 <= 0.0) continue;
    const double half = std::sqrt(half2);
    const double chord = std::min(along + half, length) - std::max(along - half, 0.0);
    if (chord > 0.0) cost += robot.cost * chord / (2 * robot.radius);
  }
  return cost;
}

}  // namespace adit::nav
