#pragma once
#include "core/config/platform.hpp"
#include "nav/braking_check.hpp"
#include "nav/plan.hpp"

namespace adit::nav {

struct PathFollowerParams {
  double lookahead{0.35};      ///< least distance of the point that is steered at, m, [0.1, 2]
  double lookahead_time{0.5};  ///< plus so many seconds of travel, s, [0, 2]
  double turn_from{0.45};      ///< turns on the spot when the path starts off by more, rad, [0.1, 3]
  double turn_until{0.12};     ///< and until it is off by less, rad, [0.02, turn_from]
  double braking_share{0.7};   ///< share of the platform's acceleration that is planned with, (0, 1]
  double yaw_gain{1.8};        ///< of the heading while a holonomic robot drives, 1/s, [0, 10]
  BrakingCheckParams check{};
};

/// Turns a plan into velocities: pure pursuit (R. C. Coulter, CMU-RI-TR-92-01) with the speed regulated by
/// curvature, the way left and the plan's limit (S. Macenski et al., "Regulated pure pursuit", Autonomous
/// Robots 2023). Turns on the spot where the path starts to the side. Commands never change faster than
/// the platform's accelerations allow, and each one passes a BrakingCheck against the plan's obstacles.
class PathFollower {
 public:
  explicit PathFollower(const Platform& platform, const PathFollowerParams& params = {});

  /// The plan to follow from now on (copied). An empty one brings the robot to a smooth stop.
  void set_plan(const Plan& plan);
  /// The velocity for the next `dt` seconds, (0, 0.5], of a robot that is at `odom` (odometry frame).
  Twist2 follow(const Pose2& odom, double dt);
  /// Zero, at once, and no plan.
  Twist2 stop_now();

  const Twist2& command() const { return last_; }
  /// The last command was cut because it would have led into an obstacle.
  bool held() const { return held_; }

 private:
  Twist2 desired(const Pose2& odom);
  Twist2 turn_on_spot(double error) const;
  Twist2 pursue(const Pose2& odom, std::size_t nearest, double remaining) const;
  Twist2 towards(const Twist2& wanted, double dt) const;
  Twist2 braked(double dt) const;

  Platform platform_;
  PathFollowerParams params_;
  BrakingCheck check_;
  Plan plan_{};
  Twist2 last_{};
  bool turning_{false};
  bool held_{false};
};

}  // namespace adit::nav
