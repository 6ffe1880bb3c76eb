// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>

#include "core/geometry/pose.hpp"

/// Motion models of the platforms, for predictive controllers. Every model has `kVelocities` velocity states,
/// and the controls are their rates. The state is (x, y, yaw, velocity states) in the odometry frame, m and
/// rad.
///
/// twist() returns the body's velocity (vx, vy, wz) for given velocity states, jacobian() its derivative, and
/// inverse() the velocity states nearest to a twist.
namespace adit::nav::model {

/// Velocity states (v, w): forward speed, m/s, and turn rate, rad/s.
struct Unicycle {
  static constexpr int kVelocities = 2;
  using V = Eigen::Vector2d;
  Eigen::Vector3d twist(const V& v) const { return {v[0], 0.0, v[1]}; }
  Eigen::Matrix<double, 3, 2> jacobian(const V&) const {
    return (Eigen::Matrix<double, 3, 2>() << 1, 0, 0, 0, 0, 1).finished();
  }
  V inverse(const Twist2& t) const { return {t.vx, t.wz}; }
};

/// Velocity states (v, steer): speed of the rear axle, m/s, and angle of the front wheels, rad. base_link
/// lies above the rear axle.
struct Car {
  double wheelbase{0.5};  ///< m, (0, 5]
  static constexpr int kVelocities = 2;
  using V = Eigen::Vector2d;
  Eigen::Vector3d twist(const V& v) const { return {v[0], 0.0, v[0] * std::tan(v[1]) / wheelbase}; }
  Eigen::Matrix<double, 3, 2> jacobian(const V& v) const {
    const double t = std::tan(v[1]);
    return (Eigen::Matrix<double, 3, 2>() << 1, 0, 0, 0, t / wheelbase, v[0] * (1 + t * t) / wheelbase)
        .finished();
  }
  V inverse(const Twist2& t) const {
    return {t.vx, std::fabs(t.vx) < 1e-3 ? 0.0 : std::atan(wheelbase * t.wz / t.vx)};
  }
};

/// Velocity states (vx, vy, wz): the velocity of the body.
struct Holonomic {
  static constexpr int kVelocities = 3;
  using V = Eigen::Vector3d;
  Eigen::Vector3d twist(const V& v) const { return v; }
  Eigen::Matrix3d jacobian(const V&) const { return Eigen::Matrix3d::Identity(); }
  V inverse(const Twist2& t) const { return {t.vx, t.vy, t.wz}; }
};

}  // namespace adit::nav::model
