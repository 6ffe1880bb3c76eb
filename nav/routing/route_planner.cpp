// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/route_planner.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr double kApproach = 2.5;  // m: distance at which the estimate of a passage is fixed.

}  // namespace

RoutePlanner::RoutePlanner(const Platform& platform, const RouteParams& params)
    : platform_(platform),
      params_(params),
      passage_width_(narrow_width(platform, kApproach)),
      map_(params, ScanProfile::most_wrong(platform)),
      profile_(platform, params),
      graph_(map_, platform, params) {}

void RoutePlanner::add_scan(const ScanPoints& scan, const Pose3& body, double stamp_s, bool search) {
  // On stairs one step would be registered to another, so there the odometry's heights are used.
  profile_.add(scan, platform_.stairs ? body : registration_.apply(scan.all(), body, map_), map_);
  map_.expire(stamp_s);
  for (int i = 0; search && i < params_.rebuilds; ++i) {
    const int index = map_.next_dirty();
    if (index < 0) break;
    graph_.builder().build(map_, index);
    graph_.builder().connect(map_, index);
  }
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
  for (int index = map_.next_dirty(); index >= 0; index = map_.next_dirty())
    graph_.builder().build(map_, index);
}

void RoutePlanner::block(const Eigen::Vector3d& place, double stamp_s) {
  map_.block(place.x(), place.y(), place.z(), stamp_s);
}

bool RoutePlanner::has_blocked_places() const {
  const auto& places = map_.blocked_places();
  return std::any_of(places.begin(), places.end(), [](const BlockedPlace& p) { return p.active; });
}

std::size_t RoutePlanner::memory() const {
  const auto of = [](const SurfaceMap& map, const RouteGraph& graph) {
    return static_cast<std::size_t>(map.size()) * (sizeof(Tile) + 96) + graph.search().memory();
  };
  return of(map_, graph_) + (doubts_ ? of(doubts_->map, doubts_->graph) : 0);
}

RouteGraph& RoutePlanner::doubtful_graph() {
  if (!doubts_) doubts_ = std::make_unique<Doubts>(platform_, params_);
  doubts_->map.copy(map_);
  return doubts_->graph;
}

std::vector<float> RoutePlanner::costs(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> goals) {
  std::vector<float> costs = graph_.costs(from, goals);
  const auto missing = [](float cost) { return !std::isfinite(cost); };
  if (std::none_of(costs.begin(), costs.end(), missing)) return costs;
  const std::vector<float> doubtful = doubtful_graph().costs(from, goals);
  for (std::size_t i = 0; i < costs.size(); ++i) costs[i] = std::min(costs[i], doubtful[i]);
  return costs;
}

Route RoutePlanner::plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Route route = graph_.plan(from, to);
  if (route.found()) doubts_.reset();
  if (route.status != RouteStatus::unreachable) return route;
  // What was seen from afar proves nothing.
  Route doubtful = doubtful_graph().plan(from, to);
  doubtful.doubtful = true;
  return doubtful.found() ? doubtful : route;
}

}  // namespace adit::nav
