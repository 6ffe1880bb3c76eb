// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <limits>
#include <optional>

#include "nav/air_map.hpp"
#include "nav/dynamic/prediction.hpp"
#include "nav/make_planner.hpp"
#include "nav/recovery/escape.hpp"
#include "nav/terrain/terrain_map.hpp"

namespace adit::nav {

/// Makes the local planner of a Navigator: at its construction, and again when clear() forgets everything.
using PlannerFactory = std::function<std::unique_ptr<Planner>()>;

/// The heavy half of navigation, a scan in and a plan out: terrain map, what moves, and local planner. Has no
/// thread and no clock; calls must not overlap. The light half, a Controller, shares nothing with it but the
/// plan.
class Navigator {
 public:
  /// Throws when the platform names a planner that there is not: see make_planner.
  explicit Navigator(const Platform& platform, const TerrainParams& terrain = {},
                     const LocalPlannerParams& planner = {},
                     std::shared_ptr<const PlannerLibrary> library = nullptr);
  /// With a local planner of the caller's instead of the one that the platform names. `planner` never returns
  /// null.
  Navigator(const Platform& platform, const TerrainParams& terrain, PlannerFactory planner);

  /// See TerrainMap::add_scan.
  void add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s);
  /// See Planner::plan; over what the scans showed. Where that finds no path to a goal and less than
  /// Escape::kClear is free beside the body, the plan leads out of there at Escape::kSpeed; where nothing
  /// does, its reason is start_in_collision. Before the first scan nothing is known to be free: the plan is
  /// blocked with Reason::terrain_stale.
  Plan plan(const Target& target, const Pose2& pose, double stamp_s);

  const TerrainMap& terrain() const { return terrain_; }
  /// What cannot be passed, into `cells`: their middles, odometry frame, m.
  void blocked(std::vector<Eigen::Vector2f>& cells) const;
  std::span<const Mover> movers() const { return tracker_.movers(); }
  /// Forgets everything that is in the odometry frame, as after a jump of the odometry: what was seen, what
  /// moves, and what the local planner was about to do.
  void clear();

 private:
  /// Of the robot between the last two plans, m/s.
  double speed(const Pose2& pose, double stamp_s);

  Platform platform_;
  PlannerFactory make_planner_;
  TerrainMap terrain_;
  std::optional<AirMap> air_{};  ///< of what flies, in place of the former
  Tracker tracker_;
  std::unique_ptr<Planner> planner_;
  Escape escape_;
  std::vector<ObstaclePoint> obstacles_{};  ///< of one plan
  bool has_scan_{false};
  Pose2 last_pose_{};
  double last_stamp_s_{-std::numeric_limits<double>::infinity()};
};

}  // namespace adit::nav
