// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "nav/planners/plan.hpp"

namespace adit::nav {

/// Heading hold for the smart joystick: while the stick is held straight ahead or back, the robot keeps the
/// heading that it had then. It passes an obstacle and returns to that heading; a direction relative to the
/// body would turn with each detour and make the robot follow a wall.
class HeadingHold {
 public:
  /// Converts a direction target into a bearing in the body frame at `pose`, rad.
  double bearing(const Target& target, const Pose2& pose) {
    constexpr double kStraightStick = 15.0 * M_PI / 180.0;  // Maximum deviation from ahead or back.
    constexpr double kSteadyStick = 4.0 * M_PI / 180.0;     // A stick that moves more sets a new heading.
    const double stick = wrap_angle(target.direction);
    held_ = target.speed > 0.0 && std::fabs(std::sin(stick)) < std::sin(kStraightStick);
    if (!held_) {
      known_ = false;
      return stick;
    }
    if (!known_ || std::fabs(wrap_angle(stick_ - stick)) > kSteadyStick) {
      stick_ = stick;
      heading_ = wrap_angle(pose.yaw + stick);
      known_ = true;
    }
    return wrap_angle(heading_ - pose.yaw);
  }
  /// Whether the last bearing was a held heading.
  bool held() const { return held_; }
  void forget() { held_ = known_ = false; }

 private:
  double heading_{0};  ///< Held heading, odometry frame, rad.
  double stick_{0};    ///< Stick direction that set it, rad.
  bool known_{false}, held_{false};
};

}  // namespace adit::nav
