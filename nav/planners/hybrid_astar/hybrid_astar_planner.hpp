// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "nav/planners/heading_hold.hpp"
#include "nav/planners/hybrid_astar/hybrid_astar_search.hpp"
#include "nav/planners/path_speed.hpp"
#include "nav/planners/planner.hpp"

namespace adit::nav {

/// Local planner for tight space and for robots that cannot turn on the spot, of any drive. HybridAStarSearch
/// finds a path of short motions, forwards and backwards, for the next metres, starting with the robot's
/// curvature, so the robot turns round in as many moves as the place requires. A path whose direction changes
/// is followed until another one is clearly better or an obstacle blocks it; each plan is the part that is
/// driven in one direction.
class HybridAStarPlanner final : public Planner {
 public:
  explicit HybridAStarPlanner(const Platform& platform);

  Plan plan(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
            double stamp_s) override;
  /// Measures speed and curvature between cycles. plan() calls it itself; call it in cycles in which another
  /// planner plans.
  void watch(const Pose2& pose, double stamp_s) { watch_motion(pose * Pose2{-rear_, 0, 0}, stamp_s); }
  /// Measured speed, m/s, negative backwards.
  double speed() const { return speed_; }
  /// Whether the rest of the current path does not lead backwards.
  bool drives_ahead() const;

 private:
  void watch_motion(const Pose2& rear, double stamp_s);
  HybridAStarTask task_of(const Target& target, const Pose2& pose, const Pose2& rear);
  float take_obstacles(std::span<const ObstaclePoint> obstacles);
  bool follows_on(const Pose2& rear);
  /// Whether the robot is at the part of its path that is a turn on the spot.
  bool turns() const { return at_ < end_ && current_.spots[end_].direction == 0; }
  bool passable(const Pose2& rear) const;
  bool find(HybridAStarTask task);
  bool find_there(HybridAStarTask task);
  bool find_through(HybridAStarTask task);
  /// Sets the task's gap if one on the path to the target must be crossed straight.
  void see_passage(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
                   HybridAStarTask& task) const;
  bool misses(const Pose2& passage, const Pose2& rear) const;
  bool is_better(const Pose2& rear, bool to_passage) const;
  void adopt(const Pose2& rear);
  std::size_t end_of_part(std::size_t begin) const;
  void next_part();
  bool changes_ahead() const;
  bool tightens(const Pose2& back, std::size_t last) const;
  void write(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
             Plan& plan) const;

  Platform platform_;
  Footprint body_;
  double rear_;  ///< Distance of the rear axle behind base_link, m.
  HybridAStarSearch search_;
  DistanceField distance_field_{};
  CostToGo cost_to_go_{};
  HybridAStarPath found_{}, current_{};  ///< current_: odometry frame.
  std::size_t at_{0}, end_{0};     ///< On the current path: the robot, and the next change of direction.
  Target current_target_{};        ///< Of the current path.
  std::optional<Pose2> before_{};  ///< Of the rear axle, odometry frame.
  double before_s_{0};
  double speed_{0};      ///< Negative backwards, m/s.
  double curvature_{0};  ///< Of the driven path, rad/m.
  HeadingHold heading_hold_{};
};

}  // namespace adit::nav
