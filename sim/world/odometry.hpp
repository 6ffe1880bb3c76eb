// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "core/geometry/pose.hpp"
#include "sim/world/noise.hpp"

namespace adit::sim {

/// How wrong a robot's odometry is.
struct OdometryParams {
  double scale{0.01};       ///< Standard deviation of the distance scale, fraction, [0, 0.5].
  double drift{0.2};        ///< Standard deviation of the heading error, degrees per metre, [0, 45].
  double correlation{1.0};  ///< Correlation length of the heading's error rate, m, (0, 1000].
  double turn{0.0};         ///< Standard deviation of the turn scale, fraction, [0, 0.5].
};

/// Dead reckoning with errors. A constant factor, drawn once, multiplies every distance (wheels worn, feet
/// slipping): 1 % of distance. The heading drifts by a rate per metre that wanders around zero (a
/// Gauss-Markov process over the driven way with the given deviation and correlation): 0.2 degrees per metre,
/// nearly independent from one metre to the next. A robot that stands or turns on the spot gains no error,
/// but where it skids: there a constant factor multiplies every turn, too.
class Odometry {
 public:
  Odometry(const OdometryParams& params, std::uint64_t seed);

  /// Takes the true motion of one step: from one pose to the next, over `dt` seconds.
  void move(const Pose2& from, const Pose2& to, double dt);
  /// The ground under the robot rose by so much, m: measured by how the body leaned on the way.
  void rise(double by) { height_ += scale_ * by; }
  /// Starts at zero again, as after a restart of the driver. Its errors stay as they are.
  void reset() {
    pose_ = {};
    height_ = 0.0;
  }
  /// Above the start, m.
  double height() const { return height_; }
  /// Pose in the frame `odom`, which begins at the start pose.
  const Pose2& pose() const { return pose_; }
  /// Velocity as it was measured over the last step, body frame.
  const Twist2& twist() const { return twist_; }

 private:
  OdometryParams params_;
  Random random_;
  double scale_;
  double rate_;       ///< Rate of the heading error, rad/m.
  double turn_{1.0};  ///< Measured share of each turn.
  Pose2 pose_{};
  double height_{};
  Twist2 twist_{};
};

}  // namespace adit::sim
