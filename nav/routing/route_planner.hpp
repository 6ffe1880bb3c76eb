// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/config/traversability.hpp"
#include "core/geometry/pose.hpp"
#include "core/geometry/scan_points.hpp"
#include "nav/routing/ground_registration.hpp"
#include "nav/routing/known_stairs.hpp"
#include "nav/routing/narrow_passage.hpp"
#include "nav/routing/route_line.hpp"
#include "nav/routing/route_search.hpp"
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
  /// remaining tiles as it reaches them. `near`: the local map of about that time; null: the scan has to show
  /// what is near the robot, too, which it does worse.
  void add_scan(const ScanPoints& scan, const Pose3& body, double stamp_s, bool search = true,
                const LocalMap* near = nullptr);
  /// Adds known ground, or an obstacle that rises `obstacle_height` metres above the ground, m, from a map.
  /// An obstacle overrides all other evidence of its cell. Call finish() afterwards.
  void set_ground(const Eigen::Vector3d& place);
  void set_obstacle(const Eigen::Vector3d& place, double obstacle_height);
  /// Updates the whole graph.
  void finish();

  /// Sets the known staircases, frame of the poses: see SurfaceMap::set_stairs() and TileBuilder.
  void set_stairs(std::span<const Staircase> stairs) { map_.set_stairs(stairs); }
  /// Whether a known staircase that the body does not climb leads nearer to a height, m.
  bool has_closed_stairs(double height) const;
  /// The first known staircase on the way between two places, for a body that does not climb it: known ground
  /// leads to its one end, and from its other end a route leads to the goal, perhaps over further ones. A
  /// goal or an end where no body has room counts as reached from the staircase that it is at.
  std::optional<Staircase> closed_stairs(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  /// Plans a route between two places. z NaN in the goal: the floor nearest to the start's, or any floor if
  /// none is known there. A route never crosses a known obstacle. Steps up to 0.36 m that were only seen from
  /// afar cost RouteParams::doubtful_cost.
  Route plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  /// Costs of the routes from one place to many through known space, m; infinite where there is none. One
  /// search serves all goals. The costs are those along the graph before straightening, so plan()'s are lower
  /// by some per cent. `goals`: as for plan().
  std::vector<float> costs(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> goals);
  /// The first passage on the first `ahead` metres of a route that is narrower than narrow_width().
  std::optional<NarrowPassage> passage(std::span<const Eigen::Vector3d> points, double ahead) const {
    return find_passage(map_, points, ahead, passage_width_, platform_.width / 2);
  }

  LineCost line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, LineEnds ends = {}) {
    return line_.line(from, to, ends);
  }
  /// Updates the costs, lengths and unknown legs of a route; false if it is not passable any more.
  bool measure(Route& route) { return line_.measure(route); }
  /// Height of the free ground nearest to z; nothing if it is unknown.
  std::optional<double> ground(double x, double y, double z) const;
  const SurfaceMap& map() const { return map_; }
  /// For what is known from elsewhere than scans: areas, other robots, places that were found blocked.
  SurfaceMap& map() { return map_; }
  /// Number of nodes that the last search expanded.
  std::size_t expanded() const { return search_.expanded(); }
  /// Memory of map, graph and search, bytes.
  std::size_t memory() const;
  /// Forgets everything, for example after a jump of the poses.
  void clear() {
    map_.clear();
    registration_.clear();
  }

 private:
  std::vector<Staircase> closed() const;
  /// Whether a route leads from behind a staircase to the goal; also true where the map shows no ground
  /// there.
  bool leads_on(const Flight& flight, const std::optional<RouteEnd>& goal, const Eigen::Vector3d& to);
  /// Moves the map to the heights of the odometry, which drifts.
  void follow_height();
  bool is_blocked_between(const Eigen::Vector3d& place, int ix, int iy) const;
  std::optional<RouteEnd> find_end(const Eigen::Vector3d& place, double reach);
  double goal_height(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
  void finish_ends(Route& route, const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  Platform platform_;
  RouteParams params_;
  double passage_width_;  // m: the robot must cross narrower passages straight.
  Traversability limits_;
  double level_;  // m: heights at one place that differ by at most this belong to one ground.
  SurfaceMap map_;
  NearGround near_;
  ScanProfile profile_;
  GroundRegistration registration_{};
  TileBuilder builder_;
  RouteLine line_;
  RouteSearch search_;
};

}  // namespace adit::nav
