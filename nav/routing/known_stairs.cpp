// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/known_stairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/geometry/pose.hpp"

namespace adit::nav {
namespace {

// From the line between foot and top, m.
double distance_to_stairs(const Staircase& stairs, const Eigen::Vector3d& place) {
  Eigen::Vector3d line = stairs.top() - stairs.foot, to = place - stairs.foot;
  if (!std::isfinite(to.z())) line.z() = to.z() = 0.0;
  const double t = std::clamp(to.dot(line) / line.squaredNorm(), 0.0, 1.0);
  return (to - t * line).norm();
}

}  // namespace

bool leads_the_same(const Staircase& a, const Staircase& b) {
  constexpr double kShift = 0.05, kTurn = 0.03;  // m, rad
  return a.steps == b.steps && (a.foot - b.foot).norm() < kShift && (a.top() - b.top()).norm() < kShift &&
         std::abs(a.width - b.width) < 2 * kShift && std::abs(wrap_angle(a.heading - b.heading)) < kTurn;
}

std::vector<Staircase> nearest_stairs(std::span<const Staircase> stairs,
                                      std::span<const Eigen::Vector3d> places, std::size_t most) {
  if (stairs.size() <= most) return {stairs.begin(), stairs.end()};
  std::vector<double> distances;
  for (const Staircase& each : stairs) {
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& place : places) least = std::min(least, distance_to_stairs(each, place));
    distances.push_back(least);
  }
  std::vector<std::size_t> order(stairs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return distances[i]; });
  order.resize(most);
  std::ranges::sort(order);
  std::vector<Staircase> nearest;
  for (const std::size_t i : order) nearest.push_back(stairs[i]);
  return nearest;
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
