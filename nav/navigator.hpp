#pragma once
#include <optional>

#include "nav/air_map.hpp"
#include "nav/make_planner.hpp"
#include "nav/obstacle_map.hpp"

namespace adit::nav {

/// The heavy half of navigation, a scan in and a plan out: obstacle map and local planner. Has no thread and
/// no clock; calls must not overlap. The light half, a Controller, shares nothing with it but the plan.
class Navigator {
 public:
  /// Throws when the platform names a planner that there is not: see make_planner.
  explicit Navigator(const Platform& platform, const ObstacleMapParams& map = {},
                     const LocalPlannerParams& planner = {},
                     std::shared_ptr<const PlannerLibrary> library = nullptr);

  /// See ObstacleMap::add_scan.
  void add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s);
  /// See Planner::plan; over what the scans showed. Before the first scan nothing is known to be free:
  /// the plan is blocked with Reason::terrain_stale.
  Plan plan(const Target& target, const Pose2& pose, double stamp_s);

  const ObstacleMap& obstacles() const { return map_; }
  /// What cannot be passed: middles of cells, odometry frame, m.
  std::span<const Eigen::Vector2f> cells() const { return air_ ? air_->cells() : map_.cells(); }
  /// Forgets what was seen, as after a jump of the odometry.
  void clear();

 private:
  ObstacleMap map_;
  std::optional<AirMap> air_{};  ///< of what flies, in place of the former
  std::unique_ptr<Planner> planner_;
  std::vector<ObstaclePoint> obstacles_{};  ///< of one plan
  bool has_scan_{false};
};

}  // namespace adit::nav
