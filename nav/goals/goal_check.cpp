// SPDX-License-Identifier: Apache-2.0
#include "nav/goals/goal_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace adit::nav {
namespace {

constexpr double kRing = 0.25;            // m
constexpr double kTimeToReplace = 0.025;  // s
// s: of one cell in a check of the footprint. Measured among pillars in a map of 5 000 tiles: 34 ns.
constexpr double kTimePerCell = 40e-9;
// m: a larger circle costs more than the checks that it saves.
constexpr double kMaxCovered = 0.3;

double covered_by(const Footprint& body) {
  constexpr float kCoverError = 1e-4f;  // m
  float least = static_cast<float>(kMaxCovered);
  for (const Footprint::Edge& edge : body.edges()) least = std::min(least, edge.offset - kCoverError);
  return least;
}

/// The place; where its z is NaN on the floor nearest to `floor`, m.
Eigen::Vector3d on_floor(const RoutePlanner& planner, const Eigen::Vector3d& place, double floor) {
  Eigen::Vector3d at = place;
  if (!std::isfinite(at.z())) at.z() = planner.ground(place.x(), place.y(), floor).value_or(floor);
  return at;
}

}  // namespace

struct GoalCheck::Ground {
  bool solid{}, hole{}, unknown{}, steep{};
  bool sure{true};      ///< Each height was measured from near.
  double nearest{1e9};  ///< Distance from the place to the nearest obstacle under the footprint, m.
  bool carries() const { return !solid && !steep && !unknown; }
};

// Half a cell is the position error of an obstacle in the map.
GoalCheck::GoalCheck(const Platform& platform)
    : body_(Footprint(platform).grown(-kRouteCell / 2, -kRouteCell / 2)),
      always_covered_(covered_by(body_)),
      limits_(Traversability::of(platform)),
      reach_(least_reach(platform)),
      flies_(platform.flies()) {}

GoalCheck::Ground GoalCheck::under(const SurfaceMap& map, const Eigen::Vector3d& place, double yaw) const {
  Ground found;
  const double c = std::cos(yaw), s = std::sin(yaw);
  const int reach = cells_around();
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
  const Eigen::Vector3d at = on_floor(planner, place, floor);
  if (!areas_.permits(at, reach_)) return Standing::forbidden;
  if (flies_) return Standing::unseen;
  bool open = false, steep = false, hole = false;
  double nearest = 1e9;
  for (int k = 0; k < headings(); ++k) {
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

int GoalCheck::budget() const {
  const int side = 2 * cells_around() + 1;
  return static_cast<int>(kTimeToReplace / (kTimePerCell * side * side));
}

bool GoalCheck::never_stands(const SurfaceMap& map, const Eigen::Vector3d& place) const {
  const int reach = static_cast<int>(always_covered_ / kRouteCell) + 1;
  const int cx = route_cell(place.x()), cy = route_cell(place.y());
  for (int iy = cy - reach; iy <= cy + reach; ++iy)
    for (int ix = cx - reach; ix <= cx + reach; ++ix) {
      const GroundCell* cell = map.cell(ix, iy, place.z());
      if (cell && cell->known && !cell->blocked) continue;
      const Eigen::Vector2d at = cell && cell->blocked
                                     ? obstacle_place(ix, iy, *cell)
                                     : Eigen::Vector2d((ix + 0.5) * kRouteCell, (iy + 0.5) * kRouteCell);
      if ((at - place.head<2>()).norm() <= always_covered_) return true;
    }
  return false;
}

bool GoalCheck::stands(const RoutePlanner& planner, const Eigen::Vector3d& place, double floor,
                       int& checks) const {
  const Eigen::Vector3d at = on_floor(planner, place, floor);
  if (flies_ || !areas_.permits(at, reach_) || never_stands(planner.map(), at)) return false;
  for (int k = 0; k < headings() && checks > 0; ++k) {
    --checks;
    const Ground ground = under(planner.map(), at, 2.0 * M_PI * k / kHeadings);
    if (ground.carries()) return true;
  }
  return false;
}

std::optional<Eigen::Vector3d> GoalCheck::nearest(const RoutePlanner& planner, const Eigen::Vector3d& place,
                                                  double floor, int& checks) const {
  struct Candidate {
    double range;
    int dx, dy;
  };
  std::vector<Candidate> ring;
  for (double inner = -kRing; inner < kNearest - kRing / 2; inner += kRing) {
    const double outer = inner + kRing;
    const int reach = static_cast<int>(outer / kRouteCell) + 1;
    ring.clear();
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx)
        if (const double range = std::hypot(dx, dy) * kRouteCell; range > inner && range <= outer)
          ring.push_back({range, dx, dy});
    std::ranges::stable_sort(ring, {}, &Candidate::range);
    for (const Candidate& candidate : ring) {
      if (checks <= 0) return std::nullopt;
      const Eigen::Vector3d at = place + kRouteCell * Eigen::Vector3d(candidate.dx, candidate.dy, 0.0);
      if (stands(planner, at, floor, checks)) return at;
    }
  }
  return std::nullopt;
}

GoalFinding GoalCheck::check(RoutePlanner& planner, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                             bool replace, int checks) const {
  GoalFinding found{.standing = stand(planner, to, from.z()), .place = to};
  if (replace && is_refused(found.standing)) {
    if (const auto other = nearest(planner, to, from.z(), checks)) {
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
