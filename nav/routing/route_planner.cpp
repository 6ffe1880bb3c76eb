// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/route_planner.hpp"

#include <algorithm>

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
  return static_cast<std::size_t>(map_.size()) * (sizeof(Tile) + 96) + graph_.search().memory();
}

std::vector<float> RoutePlanner::costs(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> goals) {
  return graph_.costs(from, goals);
}

Route RoutePlanner::plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return graph_.plan(from, to);
}

}  // namespace adit::nav
