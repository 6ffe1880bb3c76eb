#pragma once
#include <optional>

#include "nav/air_map.hpp"
#include "nav/make_planner.hpp"
#include "nav/terrain/terrain_map.hpp"

namespace adit::nav {

/// The heavy half of navigation, a scan in and a plan out: terrain map and local planner. Has no thread and
/// no clock; calls must not overlap. The light half, a Controller, shares nothing with it but the plan.
class Navigator {
 public:
  /// Throws when the platform names a planner that there is not: see make_planner.
  explicit Navigator(const Platform& platform, const TerrainParams& terrain = {},
                     const LocalPlannerParams& planner = {},
                     std::shared_ptr<const PlannerLibrary> library = nullptr);

  /// See TerrainMap::add_scan.
  void add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s);
  /// See Planner::plan; over what the scans showed. Before the first scan nothing is known to be free:
  /// the plan is blocked with Reason::terrain_stale.
  Plan plan(const Target& target, const Pose2& pose, double stamp_s);

  const TerrainMap& terrain() const { return terrain_; }
  /// What cannot be passed, into `cells`: their middles, odometry frame, m.
  void blocked(std::vector<Eigen::Vector2f>& cells) const;
  /// Forgets what was seen, as after a jump of the odometry.
  void clear();

 private:
  TerrainMap terrain_;
  std::optional<AirMap> air_{};  ///< of what flies, in place of the former
  std::unique_ptr<Planner> planner_;
  std::vector<ObstaclePoint> obstacles_{};  ///< of one plan
  bool has_scan_{false};
};

}  // namespace adit::nav
