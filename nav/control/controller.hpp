// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/config/platform.hpp"
#include "core/result/result.hpp"
#include "nav/planners/plan.hpp"

namespace adit::nav {

/// Computes velocity commands that follow a plan. The base class turns on the spot where the path starts to
/// the side and limits accelerations and a car's steering rate; subclasses implement the path tracking.
/// Controllers do not see obstacles: the planner avoids them, and the CollisionMonitor checks every command.
class Controller {
 public:
  explicit Controller(const Platform& platform);
  virtual ~Controller() = default;

  /// Sets the plan to follow (copied). An empty plan brings the robot to a smooth stop.
  void set_plan(const Plan& plan);
  /// Returns the velocity for the next `dt` seconds, (0, 0.5], of a robot at `odom` (odometry frame).
  Twist2 follow(const Pose2& odom, double dt);
  /// Drops the plan and returns zero at once, without a braking ramp.
  Twist2 stop_now();

  /// The velocity that the body is expected to have. Skidding tracks are sent a higher turn rate than this.
  const Twist2& command() const { return last_; }
  /// Reports the velocity that was sent to the driver, when it differs from the last command.
  void sent(const Twist2& velocity);

 protected:
  /// Fraction of the platform's acceleration used for planned braking.
  static constexpr double kBrakingShare = 0.7;
  /// Position of the robot along the path.
  struct Place {
    std::size_t nearest{};  ///< Index of the path's nearest pose.
    double remaining{};     ///< Length of the path from there to its end, m.
  };
  /// Computes the next velocity along plan().path(), which has at least two poses. Limits of acceleration are
  /// applied afterwards. Poses are those of the point that does not move sideways: the rear axle of a car,
  /// base_link of other platforms.
  virtual Twist2 track(const Pose2& odom, const Place& place, double dt) = 0;
  /// Called when the robot stops or turns on the spot: resets the state of path tracking.
  virtual void rest() {}

  /// The estimated angle of a car's front wheels, rad.
  double steering() const { return steering_; }

  const Platform& platform() const { return platform_; }
  const Plan& plan() const { return plan_; }

 private:
  Twist2 desired(const Pose2& odom, double dt);
  Twist2 turn_on_spot(double error) const;
  Twist2 towards(const Twist2& wanted, double dt) const;
  Twist2 steered(const Twist2& wanted, double dt);
  void learn_grip(const Pose2& odom, double dt);
  Twist2 against_slip(const Twist2& body);

  Platform platform_;
  Plan plan_{};
  Twist2 last_{};
  bool turning_{false};
  double steering_{0}, steering_before_{0};  ///< Of a car, rad.
  /// Turn effectiveness of tracks: the measured turn divided by the commanded turn. It starts from the
  /// platform file and is then estimated by least squares.
  double grip_{1}, asked_{0}, come_{0}, sent_turn_{0};
  std::optional<double> yaw_before_{};
};

/// Names of all controllers, for configuration files and help.
const std::vector<std::string>& controller_names();
/// Creates the controller `name` for a platform. Errors: bad_argument, which lists the known names.
Result<std::unique_ptr<Controller>> make_controller(const std::string& name, const Platform& platform);

}  // namespace adit::nav
