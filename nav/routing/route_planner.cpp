// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/route_planner.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr double kApproach = 2.5;  // m: distance at which the estimate of a passage is fixed.
// m: a robot close to an obstacle may start up to this far from a passable cell.
constexpr double kStartReach = 1.5;
// m: if the goal was moved by more, the last leg leads from the cell to the goal.
constexpr double kOwnGoal = 0.1;

}  // namespace

RoutePlanner::RoutePlanner(const Platform& platform, const RouteParams& params)
    : platform_(platform),
      params_(params),
      passage_width_(narrow_width(platform, kApproach)),
      limits_(Traversability::of(platform)),
      level_(ScanProfile::most_wrong(platform)),
      map_(params, ScanProfile::most_wrong(platform)),
      near_(platform.stairs),
      profile_(platform, params),
      builder_(platform, params),
      line_(map_, builder_),
      search_(map_, builder_, params) {}

void RoutePlanner::add_scan(const ScanPoints& scan, const Pose3& body, double stamp_s, bool search,
                            const LocalMap* near) {
  // On stairs one step would be registered to another, so there the odometry's heights are used.
  const Pose3 corrected = platform_.stairs ? body : registration_.apply(scan.all(), body, map_);
  near_.clear();
  if (near) {
    const Pose3& located = near->scan().located;
    near_.take(*near, platform_.stairs ? located : registration_.correct(located));
  }
  profile_.add(scan, corrected, near_, map_);
  follow_height();
  map_.expire(stamp_s);
  for (int i = 0; search && i < params_.rebuilds; ++i) {
    const int index = map_.next_dirty();
    if (index < 0) break;
    builder_.build(map_, index);
    builder_.connect(map_, index);
  }
}

// The registration leaves the heights where they were, and has limits.
void RoutePlanner::follow_height() {
  constexpr float kApart = 0.1f;  // m: well within the limit of the registration, which is 0.25 m.
  const float height = registration_.height();
  if (std::abs(height) < kApart) return;
  map_.raise(height);
  registration_.map_raised(height);
}

void RoutePlanner::set_ground(const Eigen::Vector3d& place) {
  map_.see_free(route_cell(place.x()), route_cell(place.y()), static_cast<float>(place.z()), 0.0f,
                SurfaceMap::Seen::given);
}

void RoutePlanner::set_obstacle(const Eigen::Vector3d& place, double obstacle_height) {
  map_.see_obstacle(static_cast<float>(place.x()), static_cast<float>(place.y()),
                    static_cast<float>(place.z()), static_cast<float>(obstacle_height), true);
}

void RoutePlanner::finish() {
  for (int index = map_.next_dirty(); index >= 0; index = map_.next_dirty()) builder_.build(map_, index);
}

std::size_t RoutePlanner::memory() const {
  return static_cast<std::size_t>(map_.size()) * (sizeof(Tile) + 96) + search_.memory();
}

std::optional<double> RoutePlanner::ground(double x, double y, double z) const {
  const int ix = route_cell(x), iy = route_cell(y);
  std::optional<double> best;
  bool free = false;
  for (int i = map_.first(tile_of(ix), tile_of(iy)); i >= 0; i = map_.tile(i).next) {
    const GroundCell& cell = map_.tile(i).cells[cell_in_tile(ix, iy)];
    // The side of a ramp stands on the floor below it: free cells win over blocked ones.
    if (!cell.known || (free && cell.blocked)) continue;
    const bool better = !best || free == cell.blocked || std::abs(cell.z - z) < std::abs(*best - z);
    if (better) best = cell.z;
    free = !cell.blocked;
  }
  return best;
}

double RoutePlanner::goal_height(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  if (std::isfinite(to.z())) return to.z();
  return ground(to.x(), to.y(), from.z()).value_or(from.z());
}

bool RoutePlanner::is_blocked_between(const Eigen::Vector3d& place, int ix, int iy) const {
  const Eigen::Vector2d way =
      Eigen::Vector2d((ix + 0.5) * kRouteCell, (iy + 0.5) * kRouteCell) - place.head<2>();
  const int steps = static_cast<int>(way.norm() / (kRouteCell / 2)) + 1;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = place.head<2>() + way * i / steps;
    const int x = route_cell(p.x()), y = route_cell(p.y());
    const GroundCell* cell = map_.cell(x, y, place.z());
    if (cell && builder_.solid(*cell)) return true;
  }
  return false;
}

// Finds the passable cell nearest to a place with nothing between them; unknown space without a tile is
// passable.
std::optional<RouteEnd> RoutePlanner::find_end(const Eigen::Vector3d& place, double reach) {
  const int cx = route_cell(place.x()), cy = route_cell(place.y());
  if (params_.through_unknown && map_.at_cell(cx, cy, place.z()) < 0 && map_.areas().permits(place, 0.0))
    return RouteEnd{place, -1, 0};
  const int cells = static_cast<int>(reach / kRouteCell);
  std::optional<RouteEnd> best;
  double least = reach + kRouteCell;
  bool best_level = false;  // Of the ground of `place`; other ground is taken only where there is none.
  for (int iy = cy - cells; iy <= cy + cells; ++iy)
    for (int ix = cx - cells; ix <= cx + cells; ++ix) {
      const double d = std::hypot((ix + 0.5) * kRouteCell - place.x(), (iy + 0.5) * kRouteCell - place.y());
      if (d >= reach + kRouteCell || (d >= least && best_level)) continue;
      const int index = map_.at_cell(ix, iy, place.z());
      if (index < 0) continue;
      const Tile& tile = builder_.current(map_, index);
      const int c = cell_in_tile(ix, iy);
      const bool level = std::abs(double{tile.cell_z(c)} - place.z()) <= level_ + limits_.slope * d;
      if (level == best_level ? d >= least : best_level) continue;
      if (tile.cost[c] == 0 || is_blocked_between(place, ix, iy)) continue;
      best_level = level;
      least = d;
      best = RouteEnd{{tile.cell_x(c), tile.cell_y(c), tile.cell_z(c)}, index, c};
    }
  return best;
}

// The search ends at passable cells; this adds the exact start and goal to the route.
void RoutePlanner::finish_ends(Route& route, const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  const auto join = [&](const Eigen::Vector3d& cell, const Eigen::Vector3d& place) {
    return (cell - place).head<2>().norm() > kOwnGoal;
  };
  const Eigen::Vector3d goal{to.x(), to.y(), route.points.back().z()};
  if (join(route.points.back(), goal)) {
    const double more = (goal - route.points.back()).norm();
    route.points.push_back(goal);
    route.unknown.push_back(0);
    route.length += more;
    route.cost += more;
  } else {
    route.points.back() = goal;
  }
  if (join(route.points.front(), from)) {
    const double more = (from - route.points.front()).head<2>().norm();
    route.points.insert(route.points.begin(), {from.x(), from.y(), route.points.front().z()});
    route.unknown.insert(route.unknown.begin(), 0);
    route.length += more;
    route.cost += more;
  } else {
    route.points.front().head<2>() = from.head<2>();
  }
}

std::vector<Staircase> RoutePlanner::closed() const {
  std::vector<Staircase> stairs;
  std::ranges::copy_if(map_.stairs(), std::back_inserter(stairs),
                       [this](const Staircase& each) { return !climbs(platform_, each); });
  return stairs;
}

bool RoutePlanner::has_closed_stairs(double height) const {
  return !flights_towards(closed(), height).empty();
}

bool RoutePlanner::leads_on(const Flight& flight, const std::optional<RouteEnd>& goal,
                            const Eigen::Vector3d& to) {
  if (!goal) {
    const OnStairs place = on_stairs(flight.stairs, to.x(), to.y());
    return place.along >= -kStairsApproach && place.along <= length_of(flight.stairs) + kStairsApproach &&
           std::abs(place.across) <= flight.stairs.width / 2 &&
           std::abs(tread_height(flight.stairs, place.along) - to.z()) < kSameStorey;
  }
  const auto behind = find_end(flight.end, kStartReach);
  if (!behind || behind->tile < 0 || std::abs(behind->place.z() - flight.end.z()) > kSameStorey) return true;
  std::vector<Eigen::Vector3d> points;
  return search_.search(*behind, *goal, points) == RouteStatus::found;
}

std::optional<Staircase> RoutePlanner::closed_stairs(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr int kSearches = 8;  // Each may cross the whole map.
  const Eigen::Vector3d goal_place{to.x(), to.y(), goal_height(from, to)};
  std::vector<Flight> left = flights_towards(closed(), goal_place.z());
  if (left.empty()) return std::nullopt;
  const auto goal = find_end(goal_place, params_.snap);
  // A flight that is reached, and the first one on the way to it.
  struct Reached {
    Flight flight;
    Staircase first;
    double travelled;  // Up to its end, m.
    double length;     // The same, and straight on to the goal, m.
  };
  std::vector<Reached> open;
  const auto reach = [&](const Eigen::Vector3d& place, double travelled, const Staircase* first) {
    std::vector<Eigen::Vector3d> begins;
    for (const Flight& flight : left) begins.push_back(flight.begin);
    const std::vector<float> found = costs(place, begins);
    std::vector<Flight> others;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const Flight& flight = left[i];
      if (found[i] < kUnreached) {
        const double to_end = travelled + double{found[i]} + (flight.end - flight.begin).norm();
        open.push_back(
            {flight, first ? *first : flight.stairs, to_end, to_end + (goal_place - flight.end).norm()});
      } else {
        others.push_back(flight);
      }
    }
    left = std::move(others);
  };
  reach(from, 0.0, nullptr);
  for (int n = 0; n < kSearches && !open.empty(); ++n) {
    const auto next = std::ranges::min_element(open, {}, &Reached::length);
    const Reached tried = *next;
    open.erase(next);
    if (leads_on(tried.flight, goal, goal_place)) return tried.first;
    if (!left.empty()) reach(tried.flight.end, tried.travelled, &tried.first);
  }
  return std::nullopt;
}

Route RoutePlanner::plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Route route;
  const Eigen::Vector3d goal_place{to.x(), to.y(), goal_height(from, to)};
  const auto start = find_end(from, kStartReach);
  auto goal = find_end(goal_place, params_.snap);
  // The ground at the goal is unknown and no height was given: it may be on any floor, also a deck above.
  const bool any_floor = !std::isfinite(to.z()) && !ground(to.x(), to.y(), from.z());
  if (params_.through_unknown && any_floor && (!goal || goal->tile < 0) &&
      map_.areas().permits(goal_place, 0.0))
    goal = RouteEnd{goal_place, -1, 0, true};
  if (!start)
    route.status = RouteStatus::start_blocked;
  else if (!goal)
    route.status = RouteStatus::unreachable;
  else
    route.status = search_.search(*start, *goal, route.points);
  if (route.status == RouteStatus::unreachable) route.stairs = closed_stairs(from, goal_place);
  if (!route.found()) return route;
  line_.shorten(route.points);
  line_.measure(route);
  finish_ends(route, from, goal_place);
  return route;
}

std::vector<float> RoutePlanner::costs(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> goals) {
  std::vector<float> costs(goals.size(), kUnreached);
  const auto start = find_end(from, kStartReach);
  if (!start || start->tile < 0) return costs;
  std::vector<RouteEnd> ends;
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < goals.size(); ++k) {
    const auto end = find_end({goals[k].x(), goals[k].y(), goal_height(from, goals[k])}, params_.snap);
    if (!end || end->tile < 0) continue;
    ends.push_back(*end);
    indices.push_back(k);
  }
  std::vector<float> found(ends.size(), kUnreached);
  search_.costs(*start, ends, found);
  const auto start_leg = static_cast<float>((start->place - from).head<2>().norm());
  for (std::size_t i = 0; i < ends.size(); ++i)
    costs[indices[i]] =
        found[i] + start_leg + static_cast<float>((ends[i].place - goals[indices[i]]).head<2>().norm());
  return costs;
}

}  // namespace adit::nav
