// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>

#include "core/config/platform.hpp"
#include "core/geometry/staircase.hpp"

namespace adit::nav {

/// Before and behind a staircase a route keeps to its axis for so long, m.
inline constexpr double kStairsApproach = 0.8;

/// A height difference below this leads to no other floor, m: less than half a storey.
inline constexpr double kSameStorey = 0.7;

/// Whether a body climbs a staircase.
inline bool climbs(const Platform& platform, const Staircase& stairs) {
  constexpr double kRounding = 5e-4;  // m
  return platform.stairs && stairs.rise <= platform.step + kRounding;
}

/// A place relative to a staircase, m.
struct OnStairs {
  double along{};   ///< Distance behind the lowest riser, in the direction of climbing.
  double across{};  ///< To the left of the axis.
};
inline OnStairs on_stairs(const Staircase& stairs, double x, double y) {
  const Eigen::Vector2d d = stairs.direction();
  const double dx = x - stairs.foot.x(), dy = y - stairs.foot.y();
  return {dx * d.x() + dy * d.y(), dy * d.x() - dx * d.y()};
}

/// Horizontal distance from the lowest to the highest riser, m.
inline double length_of(const Staircase& stairs) { return (stairs.steps - 1) * stairs.run; }

/// Height of the tread at a distance behind the lowest riser; that of a floor before and behind, m.
inline double tread_height(const Staircase& stairs, double along) {
  const double treads = std::floor(along / stairs.run) + 1.0;
  return stairs.floor_below() + std::clamp(treads, 0.0, static_cast<double>(stairs.steps)) * stairs.rise;
}

}  // namespace adit::nav
