// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "nav/plan.hpp"

namespace adit::nav {

/// A stick held straight ahead, or back, holds the course that the robot had then: it goes round what is in
/// the way and on, where turning with each detour would follow a wall.
class Course {
 public:
  /// Where a target lies that is a direction: the bearing in the body frame at `pose`, rad.
  double bearing(const Target& target, const Pose2& pose) {
    constexpr double kStraightStick = 15.0 * M_PI / 180.0;  // within this of ahead or back
    constexpr double kSteadyStick = 4.0 * M_PI / 180.0;     // a stick that moves more sets a new course
    const double stick = wrap_angle(target.direction);
    held_ = target.speed > 0.0 && std::fabs(std::sin(stick)) < std::sin(kStraightStick);
    if (!held_) {
      known_ = false;
      return stick;
    }
    if (!known_ || std::fabs(wrap_angle(stick_ - stick)) > kSteadyStick) {
      stick_ = stick;
      course_ = wrap_angle(pose.yaw + stick);
      known_ = true;
    }
    return wrap_angle(course_ - pose.yaw);
  }
  /// Whether the last bearing was a course that is held.
  bool held() const { return held_; }
  void forget() { held_ = known_ = false; }

 private:
  double course_{0};  ///< odometry frame, rad
  double stick_{0};   ///< that set it
  bool known_{false}, held_{false};
};

}  // namespace adit::nav
