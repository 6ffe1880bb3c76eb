// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"

namespace adit::perception {

/// A thinned cloud that the lidar saw from one place.
struct Keyframe {
  /// Enough that a robot which only began to move finds planes in one keyframe.
  static constexpr std::size_t kMaxPoints = 6000;
  static constexpr float kReach = 32.0f;  ///< Farther points are left out, m along each axis.

  Pose3 T_odom_base{};
  std::uint32_t odom_epoch{};             ///< Of the odometry frame.
  std::vector<Eigen::Vector3f> points{};  ///< In base_link, m.
};

/// Thins a scan to a keyframe. `points`: in base_link, m.
Keyframe make_keyframe(std::span<const Eigen::Vector3f> points, const Pose3& T_odom_base,
                       std::uint32_t odom_epoch);

/// In whole millimetres, at most 55 kB: epoch, pose, points. Little endian.
std::vector<std::uint8_t> encode(const Keyframe& keyframe);
/// Errors: malformed.
Result<Keyframe> decode_keyframe(std::span<const std::uint8_t> bytes);

}  // namespace adit::perception
