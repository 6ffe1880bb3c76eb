// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <limits>
#include <optional>

#include "core/geometry/scan_points.hpp"
#include "nav/local_map/local_map_builder.hpp"
#include "nav/planners/make_planner.hpp"
#include "nav/recovery/escape.hpp"
#include "nav/recovery/way_back.hpp"
#include "nav/tracking/prediction.hpp"

namespace adit::nav {

/// Creates the local planner of a LocalNavigation: at construction and at each clear().
using PlannerFactory = std::function<std::unique_ptr<Planner>()>;

/// The computationally heavy half of local navigation: terrain map, tracker and local planner turn scans into
/// plans. It has no thread and no clock; calls must not overlap. The light half, a Controller, shares only
/// the plan with it.
class LocalNavigation {
 public:
  /// Throws when the platform names an unknown planner: see make_planner.
  explicit LocalNavigation(const Platform& platform, std::shared_ptr<const PlannerLibrary> library = nullptr);
  /// Uses a local planner of the caller instead of the one that the platform names. `planner` never returns
  /// null.
  LocalNavigation(const Platform& platform, PlannerFactory planner);

  /// See TerrainMap::add_scan. `peers`: centre and radius of the other robots, odometry frame, m.
  void add_scan(const ScanPoints& scan, const LocalMapScan& at, std::span<const Eigen::Vector3f> peers = {});
  /// The same of a robot whose odometry is all that it has, without others.
  void add_scan(const ScanPoints& scan, const Pose3& body, double stamp_s) {
    add_scan(scan, {.stamp_s = stamp_s, .body = body, .located = body});
  }
  /// See TerrainMap::set_stairs.
  void set_stairs(std::span<const Staircase> stairs) { terrain_.set_stairs(stairs); }
  /// Plans over the terrain seen so far; see Planner::plan, and WayBack and Escape for the targets `back_up`
  /// and `leave`. A blocked plan has a cause. A plan to leave names the side of what nearly touches the body,
  /// and is blocked when no motion leads away from it. Before the first scan no space is known to be free,
  /// and the plan is blocked. `border`: places that no path may touch; `peers`: centre and radius of the
  /// other robots; odometry frame, m.
  Plan plan(const Target& target, const Pose2& pose, double stamp_s,
            std::span<const Eigen::Vector2f> border = {}, std::span<const Eigen::Vector3f> peers = {});

  /// What the scans so far show around the robot; null before the first one.
  const std::shared_ptr<const LocalMap>& map() const { return map_; }
  std::span<const Mover> movers() const { return tracker_.movers(); }
  /// Forgets all state in the odometry frame, for example after a jump of the odometry: terrain, movers and
  /// the local planner's state.
  void clear();

 private:
  /// Obstacles of one plan: those of the terrain, those of the border, and the predicted places of movers.
  struct Parts {
    std::size_t terrain{}, standing{};
  };
  Plan plan_path(const Target& target, const Pose2& pose, double stamp_s, const Parts& parts);
  /// What is nearest on the straight line to a goal, and its distance along that line, m.
  struct Hindrance {
    Cause cause{Cause::fixed};
    float along{};
  };
  Hindrance hindrance(const Target& target, const Pose2& pose, const Parts& parts,
                      std::span<const Eigen::Vector3f> peers) const;
  /// Speed of the robot between the last two plans, m/s.
  double speed(const Pose2& pose, double stamp_s);

  Platform platform_;
  PlannerFactory make_planner_;
  TerrainMap terrain_;
  std::optional<AirMap> air_{};  ///< Replaces the terrain map for flying robots.
  Tracker tracker_;
  LocalMapBuilder builder_{};
  std::shared_ptr<const LocalMap> map_{};
  std::vector<Eigen::Vector2f> moving_{};  ///< Surfaces of what moves, odometry frame, m.
  std::unique_ptr<Planner> planner_;
  Escape escape_;
  WayBack way_back_;
  std::vector<ObstaclePoint> obstacles_{};  ///< Of one plan.
  Pose2 last_pose_{};
  double last_stamp_s_{-std::numeric_limits<double>::infinity()};
};

}  // namespace adit::nav
