// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "nav/course.hpp"
#include "nav/lattice/lattice_search.hpp"
#include "nav/path_speed.hpp"
#include "nav/planner.hpp"

namespace adit::nav {

struct LatticePlannerParams {
  LatticeSearchParams search{};
  double tolerance{0.25};     ///< arrived within this distance of the goal, m, [0.02, 2]
  double better{0.6};         ///< another path must be so much cheaper where directions change, m, [0, 5]
  double off_path{0.25};      ///< a robot farther from its path is not on it any more, m, [0.05, 1]
  double off_heading{0.4};    ///< the same for the heading, rad, [0.05, 1.5]
  double stick_spread{50.0};  ///< paths may leave a stick's direction by so much, degrees, [10, 120]
  double reverse_speed{1.0};  ///< backwards no faster, m/s, (0, 10]
  double tight_speed{0.3};    ///< where only the tight margin is left, m/s, (0, 2]
  double rough_slows{0.75};   ///< share of the speed that ground of cost 1 takes, [0, 0.95]
  double effort{25.0};  ///< drives this long without coming nearer to a goal, then it is blocked, s, [1, 600]
  double rest{30.0};    ///< and stays blocked this long before it tries again, s, [0, 3600]
  double patience{2.0};  ///< blocked for so long on the way to a goal it backs away, s, [0, 60]
  double retreat{1.5};   ///< by so much, m, [0.3, 3]
  int retreats{3};       ///< times, until that brings it nearer to the goal, [0, 100]
  PathSpeedParams speed{};
};

/// The local planner of what cannot turn on the spot: searches a path of short motions, ahead and backwards,
/// for the next metres (LatticeSearch), from the curvature that the robot has. So it turns round in as many
/// moves as the place needs. A path whose directions change is kept to until another one is clearly better or
/// something is in its way; a plan is what is driven in one direction. Where no path leads on it backs away
/// and tries again from there. For every drive.
class LatticePlanner final : public Planner {
 public:
  explicit LatticePlanner(const Platform& platform, const LatticePlannerParams& params = {});

  Plan plan(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
            double stamp_s) override;
  /// Measures speed and curvature from one cycle to the next; plan() does so itself. For cycles in which
  /// another planner plans.
  void watch(const Pose2& pose, double stamp_s) { watch_motion(pose * Pose2{-rear_, 0, 0}, stamp_s); }
  /// As measured, m/s, negative backwards.
  double speed() const { return speed_; }
  /// Neither a part of the path that it keeps to nor a retreat leads backwards.
  bool drives_ahead() const;

 private:
  void watch_motion(const Pose2& rear, double stamp_s);
  LatticeTask task_of(const Target& target, const Pose2& pose, const Pose2& rear);
  float take_obstacles(std::span<const ObstaclePoint> obstacles);
  bool follows_on(const Pose2& rear);
  bool passable(const Pose2& rear) const;
  bool find(LatticeTask task);
  bool find_there(LatticeTask task);
  bool find_through(LatticeTask task);
  /// Writes the gap on the way to the target, when it is one that has to be met straight.
  void see_gate(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
                LatticeTask& task) const;
  bool misses(const Pose2& gate, const Pose2& rear) const;
  bool is_better(const Pose2& rear, bool to_gate) const;
  void adopt(const Pose2& rear);
  void next_part();
  bool changes_ahead() const;
  /// What is driven to now: the target, or a place to back away to.
  Target aim_of(const Target& target, const Pose2& pose, double stamp_s);
  void forget_retreat();
  void consider_retreat(const Target& target, const Pose2& pose, double stamp_s);
  bool given_up(const Target& target, double distance, bool drives, double stamp_s);
  bool tightens(const Pose2& back, std::size_t last) const;
  void write(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
             Plan& plan) const;

  Platform platform_;
  LatticePlannerParams params_;
  Footprint body_;
  double rear_;  ///< axle behind base_link, m
  LatticeSearch search_;
  ClearField clear_{};
  WayField way_{};
  LatticePath found_{}, kept_{};  ///< kept: odometry frame
  std::size_t at_{0},
      end_{0};  ///< of the kept path: where the robot is, and where its direction changes next
  Target kept_for_{};
  std::optional<Pose2> before_{};  ///< of the rear axle, odometry frame
  double before_s_{0};
  double speed_{0};      ///< m/s, negative backwards
  double curvature_{0};  ///< of the way driven, rad/m
  Course course_{};
  std::optional<Eigen::Vector2d> goal_{};  ///< that the effort and the retreats are about
  double closest_{0}, effort_{0}, last_s_{0}, rest_until_{0};
  std::optional<Eigen::Vector2d> retreat_{};  ///< odometry frame
  std::optional<double> blocked_since_{};
  double retreat_until_{0}, nearest_{0};  ///< nearest_: to the goal, when retreats were counted anew
  int retreats_left_{0};
};

}  // namespace adit::nav
