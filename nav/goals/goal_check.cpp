// SPDX-License-Identifier: Apache-2.0
#include "nav/goals/goal_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace adit::nav {

struct GoalCheck::Ground {
  bool solid{}, hole{}, unknown{}, steep{};
  bool sure{true};      ///< Each height was measured from near.
  double nearest{1e9};  ///< Distance from the place to the nearest obstacle under the footprint, m.
};

// Half a cell is the position error of an obstacle in the map.
GoalCheck::GoalCheck(const Platform& platform)
    : body_(Footprint(platform).grown(-kRouteCell / 2, -kRouteCell / 2)),
      limits_(Traversability::of(platform)),
      reach_(least_reach(platform)),
      flies_(platform.flies()) {}

GoalCheck::Ground GoalCheck::under(const SurfaceMap& map, const Eigen::Vector3d& place, double yaw) const {
  Ground found;
  const double c = std::cos(yaw), s = std::sin(yaw);
  const int reach = static_cast<int>(body_.radius() / kRouteCell) + 1;
  const int cx = route_cell(place.x()), cy = route_cell(place.y());
  // Fits a plane to the ground under the body.
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  for (int iy = cy - reach; iy <= cy + reach; ++iy) {
    const GroundCell* ground = nullptr;  // The cell before, if its ground is known and free.
    for (int ix = cx - reach; ix <= cx + reach; ++ix) {
      const GroundCell* const before = std::exchange(ground, nullptr);
      const GroundCell* cell = map.cell(ix, iy, place.z());
      const Eigen::Vector2d at = cell && cell->blocked
                                     ? obstacle_place(ix, iy, *cell)
                                     : Eigen::Vector2d((ix + 0.5) * kRouteCell, (iy + 0.5) * kRouteCell);
      const Eigen::Vector2d off = at - place.head<2>();
      const bool inside = body_.depth(static_cast<float>(c * off.x() + s * off.y()),
                                      static_cast<float>(c * off.y() - s * off.x())) >= 0.0f;
      if (!inside) continue;
      if (!cell || (!cell->known && !cell->blocked)) {
        found.unknown = true;
        continue;
      }
      if (cell->blocked) {
        found.solid = true;
        if (off.norm() < found.nearest) {
          found.nearest = off.norm();
          found.hole = cell->obstacle_height <= kHoleHeight;
        }
        continue;
      }
      const double rise = before ? std::abs(cell->z - before->z) : 0.0;
      found.steep = found.steep || rise > limits_.obstacle + limits_.slope * kRouteCell;
      ground = cell;
      found.sure = found.sure && cell->sure;
      const Eigen::Vector3d row(off.x(), off.y(), 1.0);
      squares += row * row.transpose();
      sums += row * static_cast<double>(cell->z);
    }
  }
  if (!found.solid && !found.unknown && !found.steep) {
    const Eigen::Vector3d plane = squares.ldlt().solve(sums);
    found.steep = plane.head<2>().norm() > limits_.slope + limits_.obstacle - limits_.step;
  }
  // Heights seen from afar tilt with the error of the attitude, so they prove neither a slope nor a step.
  if (found.steep && !found.sure) {
    found.steep = false;
    found.unknown = true;
  }
  return found;
}

Standing GoalCheck::stand(const RoutePlanner& planner, const Eigen::Vector3d& place, double floor) const {
  Eigen::Vector3d at = place;
  if (!std::isfinite(at.z())) at.z() = planner.ground(place.x(), place.y(), floor).value_or(floor);
  if (!areas_.permits(at, reach_)) return Standing::forbidden;
  if (flies_) return Standing::unseen;
  bool open = false, steep = false, hole = false;
  double nearest = 1e9;
  const int headings = body_.symmetric() ? kHeadings / 2 : kHeadings;
  for (int k = 0; k < headings; ++k) {
    const Ground ground = under(planner.map(), at, 2.0 * M_PI * k / kHeadings);
    if (ground.solid) {
      if (ground.nearest < nearest) hole = ground.hole;
      nearest = std::min(nearest, ground.nearest);
      continue;
    }
    if (ground.steep) {
      steep = true;
      continue;
    }
    if (!ground.unknown) return Standing::standable;
    open = true;
  }
  if (open) return Standing::unseen;
  if (steep) return Standing::too_steep;
  if (!hole && is_between(planner.map(), at)) return Standing::too_narrow;
  return hole ? Standing::no_floor : Standing::occupied;
}

bool GoalCheck::is_between(const SurfaceMap& map, const Eigen::Vector3d& place) const {
  const GroundCell* own = map.cell(route_cell(place.x()), route_cell(place.y()), place.z());
  if (!own || !own->known || own->blocked) return false;
  std::vector<Eigen::Vector2d> obstacles;
  map.visit_obstacles(place, body_.radius(), [&](const Eigen::Vector2d& obstacle) {
    const Eigen::Vector2d off = obstacle - place.head<2>();
    if (off.norm() <= body_.radius()) obstacles.push_back(off);
  });
  const auto nearest =
      std::ranges::min_element(obstacles, {}, [](const Eigen::Vector2d& off) { return off.squaredNorm(); });
  return std::ranges::any_of(obstacles, [&](const Eigen::Vector2d& off) { return off.dot(*nearest) < 0.0; });
}

std::optional<Eigen::Vector3d> GoalCheck::nearest(const RoutePlanner& planner, const Eigen::Vector3d& place,
                                                  double floor) const {
  struct Candidate {
    double range;
    int dx, dy;
  };
  std::vector<Candidate> candidates;
  constexpr int kReach = static_cast<int>(kNearest / kRouteCell);
  for (int dy = -kReach; dy <= kReach; ++dy)
    for (int dx = -kReach; dx <= kReach; ++dx)
      if (const double range = std::hypot(dx, dy) * kRouteCell; range <= kNearest)
        candidates.push_back({range, dx, dy});
  std::ranges::stable_sort(candidates, {}, &Candidate::range);
  for (const Candidate& candidate : candidates) {
    const Eigen::Vector3d at = place + kRouteCell * Eigen::Vector3d(candidate.dx, candidate.dy, 0.0);
    if (stand(planner, at, floor) == Standing::standable) return at;
  }
  return std::nullopt;
}

GoalFinding GoalCheck::check(RoutePlanner& planner, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                             bool replace) const {
  GoalFinding found{.standing = stand(planner, to, from.z()), .place = to};
  if (replace && is_refused(found.standing)) {
    if (const auto other = nearest(planner, to, from.z())) {
      found.moved = (*other - to).head<2>().norm();
      found.place = *other;
      found.standing = Standing::standable;
    }
  }
  if (is_refused(found.standing)) return found;
  const Route route = planner.plan(from, found.place);
  found.length = route.length;
  found.unknown_length = route.unknown_length;
  if (route.status == RouteStatus::unreachable && !planner.map().has_blocked_places())
    found.standing = route.stairs ? Standing::over_stairs : Standing::not_connected;
  found.stairs = found.standing == Standing::over_stairs ? route.stairs : std::nullopt;
  return found;
}

}  // namespace adit::nav
