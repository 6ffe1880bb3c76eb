// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>

#include "geometry_msgs/msg/Quaternion.h"
#include "geometry_msgs/msg/Vector3.h"
#include "perception/types/imu_sample.hpp"
#include "sensor_msgs/msg/Imu.h"
#include "std_msgs/msg/Header.h"

namespace adit::agent {

/// Stamp of a message, ns; 0: it has none. A time before 1970 is none.
inline std::uint64_t nanoseconds_of(const std_msgs::msg::Header& header) {
  if (header.stamp().sec() < 0) return 0;
  return static_cast<std::uint64_t>(header.stamp().sec()) * 1'000'000'000u + header.stamp().nanosec();
}

inline Eigen::Vector3d vector_of(const geometry_msgs::msg::Vector3& v) { return {v.x(), v.y(), v.z()}; }

inline Eigen::Quaterniond quaternion_of(const geometry_msgs::msg::Quaternion& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

/// Whether it can be normalised.
inline bool is_rotation(const Eigen::Quaterniond& q) { return q.norm() > 1e-6 && q.norm() < 1e6; }

inline perception::ImuSample imu_sample_of(const sensor_msgs::msg::Imu& imu) {
  return {nanoseconds_of(imu.header()), vector_of(imu.angular_velocity()),
          vector_of(imu.linear_acceleration())};
}

}  // namespace adit::agent
