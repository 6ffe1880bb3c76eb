// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>

#include "core/geometry/pose.hpp"
#include "perception/odometry/so3.hpp"

namespace adit::perception {

inline constexpr double kStandardGravity = 9.81;  ///< m/s2

/// The motion of a body and its covariance. The body's point is where its IMU sits, its axes are base_link's.
///
/// Error state: position (odom), rotation (right-perturbed, body axes), velocity (odom), bias of gyro and
/// accelerometer, horizontal gravity (odom), scale of the wheels.
struct MotionState {
  static constexpr int kP = 0, kR = 3, kV = 6, kBg = 9, kBa = 12, kG = 15, kS = 17, kSize = 18;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  std::uint64_t stamp{};  ///< Driver's clock, ns; 0: not started.
  Eigen::Vector3d position{0, 0, 0};
  Eigen::Quaterniond rotation{Eigen::Quaterniond::Identity()};
  Eigen::Vector3d velocity{0, 0, 0};
  Eigen::Vector3d gyro_bias{0, 0, 0}, accel_bias{0, 0, 0};
  Eigen::Vector2d gravity{0, 0};  ///< Horizontal part of gravity in odom, m/s2: how much odom is tilted.
  double wheel_scale{1.0};        ///< True way per way by the wheels.
  Matrix P{Matrix::Zero()};

  Eigen::Vector3d gravity_vector() const {
    const double g = kStandardGravity;
    return {gravity.x(), gravity.y(), -std::sqrt(std::max(0.0, g * g - gravity.squaredNorm()))};
  }
  /// Position and rotation by which a pose of the body's point differs from this one, as in the error state.
  Eigen::Matrix<double, 6, 1> to(const Pose3& pose) const {
    Eigen::Matrix<double, 6, 1> off;
    off.head<3>() = pose.position - position;
    off.tail<3>() = log_so3(rotation.conjugate() * pose.orientation);
    return off;
  }
  /// Adds an error state.
  void add(const Vector& dx) {
    position += dx.segment<3>(kP);
    rotation = (rotation * exp_so3(dx.segment<3>(kR))).normalized();
    velocity += dx.segment<3>(kV);
    gyro_bias += dx.segment<3>(kBg);
    accel_bias += dx.segment<3>(kBa);
    gravity += dx.segment<2>(kG);
    wheel_scale += dx[kS];
  }
};

}  // namespace adit::perception
