// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/route_line.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

LineCost RouteLine::line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, LineEnds ends) {
  constexpr double kRelaxedLength = 0.5;  // m at an end, where cells may be too narrow but must be free.
  const Eigen::Vector2d way = to.head<2>() - from.head<2>();
  const double length = way.norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(length / kRouteCell)));
  const double share = length / steps;
  LineCost result;
  double z = from.z();
  int tx = 0, ty = 0;
  const Tile* tile = nullptr;          // The tile under the line, if the ground is known.
  const GroundCell* before = nullptr;  // The previous cell, if its height is known.
  bool have = false, relaxed_start = ends.relax_start, relaxed_end = false;
  for (int i = 0; i <= steps; ++i) {
    if (result.cost > ends.most) return {};
    const double t = static_cast<double>(i) / steps;
    const int ix = route_cell(from.x() + t * way.x()), iy = route_cell(from.y() + t * way.y());
    if (!have || tile_of(ix) != tx || tile_of(iy) != ty) {
      tx = tile_of(ix);
      ty = tile_of(iy);
      const int index = map_.at_cell(ix, iy, z);
      tile = index < 0 ? nullptr : &builder_.current(map_, index);
      have = true;
    }
    const double weight = i == 0 || i == steps ? share / 2 : share;
    if (!tile) {
      if (!map_.areas().empty() &&
          !map_.areas().permits({from.x() + t * way.x(), from.y() + t * way.y(), z}, 0.0))
        return {};
      result.cost += weight * builder_.unknown_cost();
      result.unknown += weight;
      before = nullptr;
      relaxed_start = false;
      continue;
    }
    const auto c = static_cast<std::size_t>(cell_in_tile(ix, iy));
    const GroundCell& cell = tile->cells[c];
    if (tile->cost[c] == 0) {
      relaxed_start = relaxed_start && t * length <= kRelaxedLength;
      relaxed_end = ends.relax_end && (1 - t) * length <= kRelaxedLength;
      if (builder_.solid(cell) || !(relaxed_start || relaxed_end)) return {};
      result.cost += weight * builder_.unknown_cost();
    } else if (relaxed_end) {
      return {};
    } else {
      relaxed_start = false;
      result.cost += weight * tile->cost[c] / 16.0;
    }
    if (!cell.known) {
      result.unknown += weight;
    } else {
      if (before && std::abs(cell.z - before->z) > 2 * builder_.most_rise(*before, cell)) return {};
      z = cell.z;
    }
    before = cell.known ? &cell : nullptr;
  }
  if (map_.has_team()) result.cost += map_.team_cost(from, to);
  result.passable = std::abs(z - to.z()) <= kFloorSeparation + 0.1;
  return result;
}

void RouteLine::shorten_once(std::vector<Eigen::Vector3d>& points) {
  constexpr double kLongestLeg = 40.0;  // Maximum length of a leg, m.
  constexpr int kGiveUp = 3;            // Consecutive corners without a straight line.
  if (points.size() < 3) return;
  std::vector<double> before(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i)
    before[i] = before[i - 1] + line(points[i - 1], points[i]).cost;
  std::vector<Eigen::Vector3d> result{points.front()};
  for (std::size_t anchor = 0; anchor + 1 < points.size();) {
    std::size_t best = anchor + 1;
    int unseen = 0;
    for (std::size_t j = anchor + 2; j < points.size() && unseen < kGiveUp; ++j) {
      if ((points[j] - points[anchor]).squaredNorm() > kLongestLeg * kLongestLeg) break;
      const double most = before[j] - before[anchor] + 1e-3;
      const LineCost direct = line(points[anchor], points[j], {.most = most});
      if (direct.passable && direct.cost <= most) {
        best = j;
        unseen = 0;
      } else {
        ++unseen;
      }
    }
    result.push_back(points[best]);
    anchor = best;
  }
  points = std::move(result);
}

void RouteLine::shorten(std::vector<Eigen::Vector3d>& points) {
  constexpr double kResample = 0.5;  // m
  shorten_once(points);
  std::vector<Eigen::Vector3d> dense;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector3d way = points[i + 1] - points[i];
    const int parts = std::max(1, static_cast<int>(std::ceil(way.norm() / kResample)));
    for (int k = 0; k < parts; ++k) dense.push_back(points[i] + way * k / parts);
  }
  if (!points.empty()) dense.push_back(points.back());
  // Interpolated points on a slope take the height of the ground.
  for (Eigen::Vector3d& p : dense) {
    const GroundCell* cell = map_.cell(route_cell(p.x()), route_cell(p.y()), p.z());
    if (cell && cell->known && std::abs(cell->z - p.z()) < kFloorSeparation / 2) p.z() = cell->z;
  }
  shorten_once(dense);
  // A part of a line may round to other cells than the line, and along a wall it may not be passable.
  for (std::size_t i = 0; i + 1 < dense.size(); ++i)
    if (!line(dense[i], dense[i + 1]).passable) return;
  points = std::move(dense);
}

std::vector<Eigen::Vector3d> first_part(std::span<const Eigen::Vector3d> points, double length) {
  std::vector<Eigen::Vector3d> part;
  double passed = 0.0;
  for (const Eigen::Vector3d& point : points) {
    const double leg = part.empty() ? 0.0 : (point - part.back()).norm();
    passed += leg;
    if (passed > length) {
      part.push_back(point - (point - part.back()) * ((passed - length) / leg));
      break;
    }
    part.push_back(point);
  }
  return part;
}

bool RouteLine::measure(Route& route) {
  bool passable = true;
  route.length = route.unknown_length = route.cost = 0;
  route.unknown.clear();
  for (std::size_t i = 0; i + 1 < route.points.size(); ++i) {
    const LineCost leg = line(route.points[i], route.points[i + 1],
                              {.relax_start = i == 0, .relax_end = i + 2 == route.points.size()});
    const double length = (route.points[i + 1] - route.points[i]).norm();
    passable = passable && leg.passable;
    route.cost += leg.passable ? leg.cost : length;
    route.unknown.push_back(leg.passable && leg.unknown > 2 * kRouteCell);
    route.unknown_length += route.unknown.back() ? leg.unknown : 0.0;
    route.length += length;
  }
  return passable;
}

}  // namespace adit::nav
