// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"

namespace adit {

/// Mounting pose of a sensor: its frame in `base_link`. The angles are applied as R = Rz(yaw) Ry(pitch)
/// Rx(roll), as in URDF.
struct Mounting {
  double x{}, y{}, z{};           ///< m
  double roll{}, pitch{}, yaw{};  ///< rad

  Eigen::Vector3d position() const { return {x, y, z}; }
  /// Returns T_base_sensor.
  Pose3 pose() const {
    using Eigen::AngleAxisd, Eigen::Vector3d;
    return {position(), AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
                            AngleAxisd(roll, Vector3d::UnitX())};
  }
  /// Whether the sensor's z axis points downwards.
  bool upside_down() const { return std::cos(roll) * std::cos(pitch) < 0; }
};

/// A lidar of a platform: mounting, topic, beams and errors.
struct LidarConfig {
  Mounting mounting{};
  std::string topic{"points"};  ///< Topic of its driver, without the leading slash.
  std::string frame{"lidar"};   ///< The frame_id in its driver's messages.
  int rings{16};                ///< Number of rings (beams at different elevations), [2, 128].
  double lowest{-15};           ///< Elevation of the lowest beam, degrees, [-89, 0].
  double highest{15};           ///< Elevation of the highest beam, degrees, [0, 89].
  double rate{10};              ///< Sweep rate, 1/s, [1, 50].
  double min_range{0.05};       ///< Shorter returns are discarded, m, [0, 5].
  double max_range{200};        ///< Longer returns are discarded, m, [1, 500].
  double noise{0.02};           ///< Standard deviation of a range, m, [0, 0.5].
  /// Simulated lidar: scans a rosette instead of rings.
  bool rosette{false};
};

/// The IMU of a platform: mounting and topic.
struct ImuConfig {
  Mounting mounting{};
  std::string topic{"imu/data"};
  std::string frame{"imu"};
  double rate{100};  ///< Sample rate, 1/s, [10, 2000].
};

/// The sensors of one robot that perception uses.
struct Sensors {
  static constexpr std::size_t kMaxLidars = 4;
  std::vector<LidarConfig> lidars{};
  std::optional<ImuConfig> imu{};
};

}  // namespace adit
