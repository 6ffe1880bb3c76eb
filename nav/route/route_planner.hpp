// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "nav/route/gate.hpp"
#include "nav/route/ground_registration.hpp"
#include "nav/route/route_graph.hpp"
#include "nav/route/scan_profile.hpp"

namespace adit::nav {

/// The global planner: a sparse graph of free space, kept up to date as the map grows, across floors and
/// slopes; unknown space may be tried, at a price. Has no thread and no clock; calls must not overlap. Frame:
/// whatever the poses are in, m, z up. Bounded: see RouteParams::tiles and memory().
class RoutePlanner {
 public:
  explicit RoutePlanner(const Platform& platform, const RouteParams& params = {});
  RoutePlanner(const RoutePlanner&) = delete;
  RoutePlanner& operator=(const RoutePlanner&) = delete;

  /// Takes a scan; when a `search` is to follow soon, brings RouteParams::rebuilds tiles of the graph up to
  /// date, at most, which the search would do else where it comes to them. `points`: in
  /// base_link, m, not finite where nothing was hit. `body`: base_link, which is on the ground, at the scan's
  /// time; `stamp_s`: that time, s, not decreasing.
  void add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s,
                bool search = true);
  /// From a map that is known: ground, or an obstacle that stands `top` metres above the ground, m. An
  /// obstacle counts whatever else was said of its cell. To be followed by finish().
  void set_ground(const Eigen::Vector3d& place);
  void set_obstacle(const Eigen::Vector3d& place, double top);
  /// Brings all of the graph up to date.
  void finish();

  /// The way from one place to another. Goal: z NaN is the floor nearest to the start's, and
  /// where none is known any. Never through a known obstacle. Where nothing else leads
  /// there, steps up to 0.36 m that were only seen from afar do not count: a way that has to be looked at.
  Route plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  /// Costs of the routes from one place to many, through known space only, m; infinite where none leads. One
  /// search for all goals; a cost is that of the route along the graph, before it is straightened: plan()'s
  /// is lower by some per cent. `goals`: as for plan().
  std::vector<float> costs(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> goals) {
    return graph_.costs(from, goals);
  }
  /// That place was found blocked, whatever the scans say; it counts for RouteParams::block_time.
  void block(const Eigen::Vector3d& place, double stamp_s);
  bool has_blocked_places() const;
  /// The first passage over a route's first `ahead` metres that is narrower than narrow_width().
  std::optional<NarrowPassage> gate(std::span<const Eigen::Vector3d> points, double ahead) const {
    return find_gate(map_, points, ahead, gate_width_, platform_.width / 2);
  }

  LineCost line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, LineEnds ends = {}) {
    return graph_.line().line(from, to, ends);
  }
  /// Brings costs, lengths and unknown legs of a route up to date; false when it is not passable any more.
  bool measure(Route& route) { return graph_.line().measure(route); }
  /// Height of the ground there, of the floor nearest to z on which nothing stands; nothing when it is not
  /// known.
  std::optional<double> ground(double x, double y, double z) const { return graph_.ground(x, y, z); }
  const SurfaceMap& map() const { return map_; }
  /// Nodes that the last search looked at.
  std::size_t expanded() const { return graph_.search().expanded(); }
  /// Held by map, graph and search, bytes.
  std::size_t memory() const;
  /// Forgets everything, as after a jump of the poses.
  void clear() {
    map_.clear();
    registration_.clear();
    doubts_.reset();
  }

 private:
  /// A copy of the map in which doubtful steps do not count.
  struct Doubts {
    SurfaceMap map;
    RouteGraph graph;
    Doubts(const Platform& platform, const RouteParams& params)
        : map(params, ScanProfile::most_wrong(platform)), graph(map, platform, params, true) {}
  };

  Platform platform_;
  RouteParams params_;
  double gate_width_;  // m: through what is no wider the robot is to go straight
  SurfaceMap map_;
  ScanProfile profile_;
  GroundRegistration registration_{};
  RouteGraph graph_;
  std::unique_ptr<Doubts> doubts_{};  ///< made when a goal seems to be out of reach
};

}  // namespace adit::nav
