// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "nav/planners/falco/falco_planner.hpp"
#include "nav/planners/hybrid_astar/hybrid_astar_planner.hpp"

namespace adit::nav {

/// Plans with the trajectory library in open space and with hybrid A* (HybridAStarPlanner) in tight space:
/// where the clearance along the route ahead is less than half the body's width plus kClearance, or the route
/// leads through a narrow passage. When the selected planner finds no path, the other one plans. Both start
/// from the robot's pose and motion, so a switch causes no jump. Direction targets, and goals without a
/// route, belong to the trajectory library.
class CombinedPlanner final : public Planner {
 public:
  /// Space with less clearance beside the body than this is tight, m.
  static constexpr double kClearance = 0.25;

  explicit CombinedPlanner(const Platform& platform, std::shared_ptr<const PlannerLibrary> library = nullptr)
      : platform_(platform), open_(platform, std::move(library)), lattice_(platform) {}

  Plan plan(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
            double stamp_s) override;

 private:
  bool is_tight(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles) const;
  void choose(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles);

  Platform platform_;
  FalcoPlanner open_;
  HybridAStarPlanner lattice_;
  bool tight_{false};
  bool instead_{false};  ///< It plans because the other planner found no path.
  /// Where space was last tight, or where `instead_` began; odometry frame.
  Eigen::Vector2d switched_at_{0, 0};
};

}  // namespace adit::nav
