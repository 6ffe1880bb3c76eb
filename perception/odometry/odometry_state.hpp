// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/config/perception_level.hpp"
#include "core/geometry/pose.hpp"

namespace adit::perception {

/// Degree to which the lidar determines a direction.
enum class Observability : std::uint8_t { none, weak, strong };

/// Degrees to which the lidar determines the three directions of translation and the three axes of rotation,
/// in the frame of the odometry.
struct Localizability {
  Eigen::Matrix3d axes_t{Eigen::Matrix3d::Identity()};  ///< Columns: directions, the least known first.
  Eigen::Matrix3d axes_r{Eigen::Matrix3d::Identity()};  ///< Columns: axes of rotation.
  std::array<Observability, 3> t{}, r{};
  Eigen::Vector3d sigma_t{0, 0, 0};  ///< Standard deviation along each direction by the lidar alone, m.
  Eigen::Vector3d sigma_r{0, 0, 0};  ///< The same about each axis, rad.

  bool all_strong() const {
    for (const auto each : t)
      if (each != Observability::strong) return false;
    for (const auto each : r)
      if (each != Observability::strong) return false;
    return true;
  }
};

/// Result of the odometry after a sweep.
struct OdometryState {
  std::uint64_t stamp{};                                    ///< End of the sweep, driver's clock, ns.
  Pose3 pose{};                                             ///< T_odom_base.
  Eigen::Vector3d velocity{0, 0, 0};                        ///< Of base_link in odom, m/s.
  Eigen::Vector3d gyro_bias{0, 0, 0}, accel_bias{0, 0, 0};  ///< In rad/s and m/s2.
  double wheel_scale{1.0};                                  ///< True distance per distance by the wheels.
  /// Of the pose since the start: position (odom, m), then rotation (odom axes, rad).
  Eigen::Matrix<double, 6, 6> covariance{Eigen::Matrix<double, 6, 6>::Zero()};
  Localizability localizability{};
  /// `ok`: the lidar determines the horizontal position and the heading. `weak`: it leaves something of them
  /// open, a sensor of motion is missing, or the pose is `unplaced`. `lost`: clouds do not fit the map.
  Localisation health{Localisation::starting};
  /// After it was lost it began a new map, whose place is not known but for the covariance. It ends by
  /// LidarOdometry::relocalised(), or when clouds fit the map before.
  bool unplaced{};
  /// sigma() when the last cloud fitted a map whose place was known, m. What is more of it is how far the
  /// body can have been moved since.
  double sigma_seen{};
  std::uint32_t relocalised{};  ///< Calls of LidarOdometry::relocalised() that had an effect.
  /// Steps of the pose that are no motion of the body: by relocalised(), or by a map that it had lost and
  /// that fits again. A correction that was found for a pose before the last step is none of a pose after it.
  std::uint32_t steps{};
  /// The wheels report a motion that lidar or IMU contradict, as of a body that is stuck.
  bool wheels_slip{};
  std::size_t matched{};  ///< Points that lie on a known plane.
  std::size_t used{};     ///< Points that were compared.
  /// Points of the last cloud that entered the map for which it had no room.
  std::size_t refused{};
  int iterations{};

  /// Standard deviation of the horizontal position in its worst direction, m.
  double sigma() const;
};

}  // namespace adit::perception
