// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/config/platform.hpp"
#include "core/result/result.hpp"
#include "nav/plan.hpp"

namespace adit::nav {

struct ControllerParams {
  double turn_from{0.45};     ///< turns on the spot when the path starts off by more, rad, [0.1, 3]
  double turn_until{0.12};    ///< and until it is off by less, rad, [0.02, turn_from]
  double braking_share{0.7};  ///< share of the platform's acceleration that is planned with, (0, 1]
  double grip_memory{3.0};    ///< tracked: over so long it learns how much of a turn arrives, s, [0.5, 60]
};

/// Turns a plan into velocities. What all controllers share is here: turning on the spot where the path
/// starts to the side, and the platform's limits of acceleration; of a car its steering instead. How the path
/// is tracked is each one's own. Obstacles are the planner's matter and, after all else, the
/// CollisionMonitor's.
class Controller {
 public:
  Controller(const Platform& platform, const ControllerParams& params);
  virtual ~Controller() = default;

  /// The plan to follow from now on (copied). An empty one brings the robot to a smooth stop.
  void set_plan(const Plan& plan);
  /// The velocity for the next `dt` seconds, (0, 0.5], of a robot that is at `odom` (odometry frame).
  Twist2 follow(const Pose2& odom, double dt);
  /// Zero, at once, and no plan.
  Twist2 stop_now();

  /// The body's velocity as the controller reckons it; of tracks that skid more turn was asked for.
  const Twist2& command() const { return last_; }
  /// What became of the last command on its way to the driver, when that was something else.
  void sent(const Twist2& velocity);

 protected:
  /// Where the robot is on the path.
  struct Place {
    std::size_t nearest{};  ///< index of the path's pose
    double remaining{};     ///< of the path from there, m
  };
  /// The velocity wanted next along plan().path(), which has two poses at least; limits of acceleration are
  /// applied afterwards.
  /// Poses are those of what does not move sideways: a car's rear axle, base_link of others.
  virtual Twist2 track(const Pose2& odom, const Place& place, double dt) = 0;
  /// The robot stands, or turns on the spot: what was tracked is over.
  virtual void rest() {}

  /// Of a car: the angle of its front wheels as far as is known, rad.
  double steering() const { return steering_; }

  const Platform& platform() const { return platform_; }
  const ControllerParams& params() const { return params_; }
  const Plan& plan() const { return plan_; }

 private:
  Twist2 desired(const Pose2& odom, double dt);
  Twist2 turn_on_spot(double error) const;
  Twist2 towards(const Twist2& wanted, double dt) const;
  Twist2 steered(const Twist2& wanted, double dt);
  void learn_grip(const Pose2& odom, double dt);
  Twist2 against_slip(const Twist2& body);

  Platform platform_;
  ControllerParams params_;
  Plan plan_{};
  Twist2 last_{};
  bool turning_{false};
  double steering_{0}, steering_before_{0};  ///< of a car, rad
  /// Of tracks: the share of a turn that arrives. The platform's file tells it first, then what was asked for
  /// and what came, by least squares.
  double grip_{1}, asked_{0}, come_{0}, sent_turn_{0};
  std::optional<double> yaw_before_{};
};

/// Every controller there is, for configuration files and help.
const std::vector<std::string>& controller_names();
/// The controller of that name for a platform. Errors: bad_argument, naming those there are.
Result<std::unique_ptr<Controller>> make_controller(const std::string& name, const Platform& platform);

}  // namespace adit::nav
