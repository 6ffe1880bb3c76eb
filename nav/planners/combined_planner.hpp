// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "nav/planners/falco/falco_planner.hpp"
#include "nav/planners/hybrid_astar/hybrid_astar_planner.hpp"

namespace adit::nav {

/// Parameters of CombinedPlanner.
struct CombinedPlannerParams {
  double clearance{0.25};  ///< Space with less clearance beside the body than this is tight, m, [0, 1].
  double ahead{2.0};  ///< Distance that is checked along the route, beyond the braking distance, m, [0.5, 4].
  double hysteresis{1.0};  ///< Distance after the last tight place at which open space begins, m, [0, 4].
};

/// Plans with the trajectory library in open space and with hybrid A* (HybridAStarPlanner) in tight space:
/// where the clearance along the route ahead is less than half the body's width plus
/// CombinedPlannerParams::clearance, or the route leads through a narrow passage. When the selected planner
/// finds no path, the other one plans. Both start from the robot's pose and motion, so a switch causes no
/// jump. Direction targets, and goals without a route, belong to the trajectory library.
class CombinedPlanner final : public Planner {
 public:
  explicit CombinedPlanner(const Platform& platform, const FalcoPlannerParams& open = {},
                           std::shared_ptr<const PlannerLibrary> library = nullptr,
                           const CombinedPlannerParams& params = {});

  Plan plan(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
            double stamp_s) override;
  /// Whether the last plan was one for tight space.
  bool tight() const { return tight_; }

 private:
  bool is_tight(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles) const;
  void choose(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles);

  Platform platform_;
  CombinedPlannerParams params_;
  FalcoPlanner open_;
  HybridAStarPlanner lattice_;
  bool tight_{false};
  bool instead_{false};  ///< It plans because the other planner found no path.
  /// Where space was last tight, or where `instead_` began; odometry frame.
  Eigen::Vector2d switched_at_{0, 0};
};

}  // namespace adit::nav
