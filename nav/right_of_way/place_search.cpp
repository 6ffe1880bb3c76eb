// SPDX-License-Identifier: Apache-2.0
#include "nav/right_of_way/place_search.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr double kPlaceSpacing = 0.4;     // m, between places.
constexpr double kBesideCorridor = 0.1;   // m, between outline and corridor.
constexpr double kBesideObstacles = 0.1;  // m, between outline and obstacles.
constexpr double kDearest = 1000.0;       // m: a dearer route leads across a robot.
constexpr std::size_t kBatch = 64;
constexpr int kBatches = 8;
constexpr int kPlans = 16;
constexpr double kPartlySeen = 0.02;

/// Offsets of the places around the robot, the nearest first.
const std::vector<Eigen::Vector2d>& offsets() {
  static const std::vector<Eigen::Vector2d> all = [] {
    std::vector<Eigen::Vector2d> grid;
    const int most = static_cast<int>(kFarthestClearPlace / kPlaceSpacing);
    for (int y = -most; y <= most; ++y)
      for (int x = -most; x <= most; ++x)
        if (std::hypot(x, y) <= most) grid.emplace_back(kPlaceSpacing * x, kPlaceSpacing * y);
    std::ranges::stable_sort(grid, {}, [](const Eigen::Vector2d& at) { return at.squaredNorm(); });
    return grid;
  }();
  return all;
}

/// The share of a disc that is known ground; 0 if an obstacle is in it.
double known_share(const RoutePlanner& planner, const Eigen::Vector3d& place, double radius) {
  constexpr int kRings = 3;
  int known = 0, all = 0;
  for (int ring = 1; ring <= kRings; ++ring) {
    const double distance = radius * ring / kRings;
    const int sides = std::max(8, static_cast<int>(2 * M_PI * distance / kRouteCell));
    for (int side = 0; side < sides; ++side) {
      const double bearing = 2 * M_PI * side / sides;
      const GroundCell* cell =
          planner.map().cell(route_cell(place.x() + distance * std::cos(bearing)),
                             route_cell(place.y() + distance * std::sin(bearing)), place.z());
      if (cell && cell->blocked) return 0.0;
      known += cell && cell->known ? 1 : 0;
      ++all;
    }
  }
  return static_cast<double>(known) / all;
}

/// Calls `look` with the places outside the corridor, the nearest first, until it returns false.
/// `least_known`: share of the ground there that must be known.
template <class Look>
void for_places(const RoutePlanner& planner, const ClearQuery& query, double least_known, Look look) {
  const double away = query.corridor.width / 2 + query.radius + kBesideCorridor;
  for (const Eigen::Vector2d& offset : offsets()) {
    const Eigen::Vector2d at = query.from.head<2>() + offset;
    if (beside_route(query.corridor.route, at).distance < away) continue;
    const double z = planner.ground(at.x(), at.y(), query.from.z()).value_or(query.from.z());
    const Eigen::Vector3d place(at.x(), at.y(), z);
    if (known_share(planner, place, query.radius + kBesideObstacles) < least_known) continue;
    if (!look(place, offset.norm())) return;
  }
}

std::optional<Eigen::Vector3d> on_seen_ground(RoutePlanner& planner, const ClearQuery& query) {
  std::optional<Eigen::Vector3d> best;
  double least = kDearest;
  std::vector<Eigen::Vector3d> batch;
  int batches = 0;
  const auto ask = [&] {
    const std::vector<float> costs = planner.costs(query.from, batch);
    for (std::size_t i = 0; i < batch.size(); ++i)
      if (costs[i] < least) {
        least = costs[i];
        best = batch[i];
      }
    batch.clear();
    ++batches;
  };
  for_places(planner, query, 1.0, [&](const Eigen::Vector3d& place, double distance) {
    if (batches >= kBatches || distance >= least) return false;
    batch.push_back(place);
    if (batch.size() == kBatch) ask();
    return true;
  });
  if (!batch.empty() && batches < kBatches) ask();
  return best;
}

/// A place such as a niche of which the robot sees only the mouth. What is seen on the way decides.
std::optional<Eigen::Vector3d> on_partly_seen_ground(RoutePlanner& planner, const ClearQuery& query) {
  std::optional<Eigen::Vector3d> best;
  double least = kDearest;
  int plans = 0;
  for_places(planner, query, kPartlySeen, [&](const Eigen::Vector3d& place, double distance) {
    if (plans >= kPlans || distance >= least) return false;
    ++plans;
    const Route route = planner.plan(query.from, {place.x(), place.y(), std::nan("")});
    if (!route.found() || route.cost >= least) return true;
    if (route.unknown_length > 2 * query.radius) return true;
    least = route.cost;
    best = place;
    return true;
  });
  return best;
}

}  // namespace

std::optional<Eigen::Vector3d> find_clear_place(RoutePlanner& planner, const ClearQuery& query) {
  const auto seen = on_seen_ground(planner, query);
  return seen ? seen : on_partly_seen_ground(planner, query);
}

}  // namespace adit::nav
