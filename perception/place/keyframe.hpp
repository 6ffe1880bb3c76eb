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
  static constexpr std::uint16_t kVersion = 2;  ///< Of encode(); version 1 has no `planar`.
  static constexpr float kReach = 32.0f;        ///< Farther points are left out, m along each axis.

  Pose3 T_odom_base{};
  std::uint32_t odom_epoch{};             ///< Of the odometry frame.
  bool planar{};                          ///< Of a lidar of one horizontal ring, see kPlanarHeight.
  std::vector<Eigen::Vector3f> points{};  ///< In base_link, m.
};

/// Thins a scan to a keyframe. `points`: in base_link, m. `planar`: of one horizontal ring.
Keyframe make_keyframe(std::span<const Eigen::Vector3f> points, const Pose3& T_odom_base,
                       std::uint32_t odom_epoch, bool planar = false);

/// In whole millimetres, at most 55 kB: epoch, planar, pose, points. Little endian.
std::vector<std::uint8_t> encode(const Keyframe& keyframe);
/// `version`: of the bytes, [1, Keyframe::kVersion]. Errors: malformed.
Result<Keyframe> decode_keyframe(std::span<const std::uint8_t> bytes,
                                 std::uint16_t version = Keyframe::kVersion);

}  // namespace adit::perception
