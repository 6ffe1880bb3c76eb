// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "nav/lattice/lattice_planner.hpp"
#include "nav/local_planner.hpp"

namespace adit::nav {

struct CombinedPlannerParams {
  double clearance{0.25};  ///< Space is tight where less than this is free beside the body, m, [0, 1].
  double ahead{2.0};       ///< Looked at along the route, beyond the way that braking takes, m, [0.5, 4].
  double hysteresis{1.0};  ///< The open begins so much way after the last tight place, m, [0, 4].
};

/// Plans with the trajectory library in the open and with hybrid A* (LatticePlanner) in tight space: where
/// the clearance along the route ahead is less than half the body's width and
/// CombinedPlannerParams::clearance, or the route leads through a narrow passage. Where the one whose turn it
/// is finds no way, the other one is asked. Both plan from the pose and the motion that the robot has, so
/// that a switch is no jump. Directions, and goals that no route leads to, are the library's.
class CombinedPlanner final : public Planner {
 public:
  explicit CombinedPlanner(const Platform& platform, const LocalPlannerParams& open = {},
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
  LocalPlanner open_;
  LatticePlanner lattice_;
  bool tight_{false};
  bool instead_{false};  ///< It plans because the other one found no way.
  Eigen::Vector2d switched_at_{
      0, 0};  ///< Where space was last tight, or where `instead_` began; odometry frame.
};

}  // namespace adit::nav
