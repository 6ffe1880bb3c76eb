// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"

namespace adit::sim {

/// Displacement, in the frame of its begin, of a body that has this velocity for `dt` seconds.
Pose2 arc(const Twist2& velocity, double dt);

/// A robot's drive: what a commanded velocity becomes under the limits of its platform.
class Body {
 public:
  /// `watchdog`: seconds after which a command that is not repeated counts as zero.
  Body(const Platform& platform, const Pose2& start, double watchdog)
      : platform_(platform), pose_(start), above_(platform.hover_height), watchdog_(watchdog) {}

  /// A new cmd_vel; values that are not finite count as zero, others are brought within the platform's
  /// limits.
  void command(const Twist2& wanted);
  /// Velocity and pose after `dt` seconds, if nothing is in the way; changes only the velocity.
  Pose2 advance(double dt);
  /// What flies: the height of base_link after `dt` seconds, m, over that ground and under that ceiling. It
  /// keeps its height above the ground, which a velocity upwards changes, and stays away from the ceiling.
  double climb(double z, double ground, double ceiling, double dt);
  /// Takes the pose that advance() proposed.
  void take(const Pose2& pose) { pose_ = pose; }
  /// Contact: the body stands.
  void halt() { twist_ = {}; }

  const Platform& platform() const { return platform_; }
  const Pose2& pose() const { return pose_; }
  /// Of base_link. Tracks skid: less of their turn arrives. A car turns about its rear axle.
  Twist2 twist() const { return twist(turn_share_); }
  /// The same as the wheels say it, who know nothing of the share below.
  Twist2 wheels() const { return twist(1.0); }
  /// Share of the wheels' turn by which the body turns from now on, [0, 1]; 1 at the start.
  void set_turn_share(double share) { turn_share_ = share; }

 private:
  Twist2 twist(double turn_share) const;

  Platform platform_;
  Pose2 pose_;
  Twist2 twist_{};  ///< Velocity of the drive.
  Twist2 wanted_{};
  double wheels_{0.0}, wheels_wanted_{0.0};  ///< Car: steering angle, rad.
  double above_{0.0};                        ///< Aerial: target height above the ground, m.
  double watchdog_;
  double silence_{0.0};  ///< Time since the last command, s.
  double turn_share_{1.0};
};

}  // namespace adit::sim
