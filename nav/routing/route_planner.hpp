// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/geometry/scan_points.hpp"
#include "nav/routing/find_passage.hpp"
#include "nav/routing/ground_registration.hpp"
#include "nav/routing/route_graph.hpp"
#include "nav/routing/scan_profile.hpp"

namespace adit::nav {

/// The global planner: a sparse graph of free space across floors and slopes, updated as the map grows.
/// Routes may cross unknown space at a higher cost. It has no thread and no clock; calls must not overlap.
/// Frame: that of the poses, m, z up. Its memory is bounded: see RouteParams::tiles and memory().
class RoutePlanner {
 public:
  explicit RoutePlanner(const Platform& platform, const RouteParams& params = {});
  RoutePlanner(const RoutePlanner&) = delete;
  RoutePlanner& operator=(const RoutePlanner&) = delete;

  /// Takes a scan; points are not finite where there was no return. `body`: base_link, which is
  /// on the ground, at the scan's time. `stamp_s`: that time, s, not decreasing. `search`: a search will
  /// follow soon, so up to RouteParams::rebuilds tiles of the graph are updated now; a search updates the
  /// remaining tiles as it reaches them.
  void add_scan(const ScanPoints& scan, const Pose3& body, double stamp_s, bool search = true);
  /// Adds known ground, or an obstacle that rises `obstacle_height` metres above the ground, m, from a map.
  /// An obstacle overrides all other evidence of its cell. Call finish() afterwards.
  void set_ground(const Eigen::Vector3d& place);
  void set_obstacle(const Eigen::Vector3d& place, double obstacle_height);
  /// Updates the whole graph.
  void finish();

  /// Plans a route between two places. z NaN in the goal: the floor nearest to the start's, or any floor if
  /// none is known there. A route never crosses a known obstacle. Steps up to 0.36 m that were only seen from
  /// afar cost RouteParams::doubtful_cost.
  Route plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  /// Costs of the routes from one place to many through known space, m; infinite where there is none. One
  /// search serves all goals. The costs are those along the graph before straightening, so plan()'s are lower
  /// by some per cent. `goals`: as for plan().
  std::vector<float> costs(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> goals);
  /// Sets the other robots of the team, which cost a route that leads through them.
  void set_team(std::vector<TeamPlace> team) { map_.set_team(std::move(team)); }
  /// Forgets an obstacle: a robot was seen there.
  void clear_obstacle(const Eigen::Vector3d& place) { map_.clear_obstacle(place.x(), place.y(), place.z()); }
  /// Marks a place as blocked regardless of the scans, for RouteParams::block_time.
  void block(const Eigen::Vector3d& place, double stamp_s);
  bool has_blocked_places() const;
  /// Takes the last block back.
  void unblock_last() { map_.unblock_last(); }
  /// Ends all blocks; a place that is blocked again is so for longer.
  void unblock() { map_.expire(std::numeric_limits<double>::infinity()); }
  /// Sets the areas that no route leaves or enters, in the frame of the poses.
  void set_areas(const AreaSet& areas) { map_.set_areas(areas); }
  /// The first passage on the first `ahead` metres of a route that is narrower than narrow_width().
  std::optional<NarrowPassage> passage(std::span<const Eigen::Vector3d> points, double ahead) const {
    return find_passage(map_, points, ahead, passage_width_, platform_.width / 2);
  }

  LineCost line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, LineEnds ends = {}) {
    return graph_.line().line(from, to, ends);
  }
  /// Updates the costs, lengths and unknown legs of a route; false if it is not passable any more.
  bool measure(Route& route) { return graph_.line().measure(route); }
  /// Height of the free ground nearest to z; nothing if it is unknown.
  std::optional<double> ground(double x, double y, double z) const { return graph_.ground(x, y, z); }
  const SurfaceMap& map() const { return map_; }
  /// Number of nodes that the last search expanded.
  std::size_t expanded() const { return graph_.search().expanded(); }
  /// Memory of map, graph and search, bytes.
  std::size_t memory() const;
  /// Forgets everything, for example after a jump of the poses.
  void clear() {
    map_.clear();
    registration_.clear();
  }

 private:
  Platform platform_;
  RouteParams params_;
  double passage_width_;  // m: the robot must cross narrower passages straight.
  SurfaceMap map_;
  ScanProfile profile_;
  GroundRegistration registration_{};
  RouteGraph graph_;
};

}  // namespace adit::nav
