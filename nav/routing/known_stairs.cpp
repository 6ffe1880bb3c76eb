// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/known_stairs.hpp"

#include <cmath>
#include <utility>

#include "core/geometry/pose.hpp"

namespace adit::nav {

bool leads_the_same(const Staircase& a, const Staircase& b) {
  constexpr double kShift = 0.05, kTurn = 0.03;  // m, rad
  return a.steps == b.steps && (a.foot - b.foot).norm() < kShift && (a.top() - b.top()).norm() < kShift &&
         std::abs(a.width - b.width) < 2 * kShift && std::abs(wrap_angle(a.heading - b.heading)) < kTurn;
}

std::vector<Flight> flights_towards(std::span<const Staircase> stairs, double height) {
  std::vector<Flight> flights;
  for (const Staircase& each : stairs) {
    const double below = std::abs(height - each.floor_below()), above = std::abs(height - each.floor_above());
    if (std::abs(below - above) < kSameStorey) continue;
    const Eigen::Vector2d clear = kStairsApproach * each.direction();
    const Eigen::Vector2d foot = each.foot.head<2>() - clear, top = each.top().head<2>() + clear;
    Flight flight{each, {foot.x(), foot.y(), each.floor_below()}, {top.x(), top.y(), each.floor_above()}};
    if (below < above) std::swap(flight.begin, flight.end);
    flights.push_back(flight);
  }
  return flights;
}

}  // namespace adit::nav
