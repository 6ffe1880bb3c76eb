// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace adit::nav {

/// The place of a point beside a polyline, m.
struct BesideRoute {
  double distance{std::numeric_limits<double>::infinity()};
  double along{};                       ///< From the beginning of the polyline to the nearest point.
  Eigen::Vector2d direction{1.0, 0.0};  ///< Of the polyline there.
};

/// Finds the nearest point of a polyline of two points or more.
inline BesideRoute beside_route(std::span<const Eigen::Vector2d> route, const Eigen::Vector2d& place) {
  BesideRoute best;
  double passed = 0.0;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const Eigen::Vector2d way = route[i + 1] - route[i];
    const double length = way.norm();
    const double t = length > 0 ? std::clamp((place - route[i]).dot(way) / (length * length), 0.0, 1.0) : 0.0;
    const double distance = (place - route[i] - t * way).norm();
    if (distance < best.distance - 1e-9)
      best = {distance, passed + t * length, length > 0 ? Eigen::Vector2d(way / length) : best.direction};
    passed += length;
  }
  return best;
}

/// Half the width of a rectangle of the given length and width, seen along `direction`, m.
inline double half_extent(double length, double width, double yaw, const Eigen::Vector2d& direction) {
  const double turn = yaw - std::atan2(direction.y(), direction.x());
  return (std::fabs(std::sin(turn)) * length + std::fabs(std::cos(turn)) * width) / 2;
}

/// The strip of ground that a robot needs for its way ahead, m.
struct Corridor {
  std::vector<Eigen::Vector2d> route{};  ///< Two corners or more.
  double width{};
};

}  // namespace adit::nav
