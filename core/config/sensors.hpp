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

/// A camera of a platform: mounting, topics and view. The optical axis is the x axis of the mounting, z
/// points up in the picture.
struct CameraConfig {
  std::string name{"front"};  ///< Operators use it; up to 16 characters, other than those of other cameras.
  Mounting mounting{};
  /// Its driver's pictures are on TOPIC/image_raw and TOPIC/image_raw/compressed, without the leading slash.
  std::string topic{"camera"};
  double field_of_view{1.2};  ///< Horizontal, of a picture without distortion, rad, [0.2, 2.6].
  double rate{15};            ///< Simulated camera: pictures a second, [1, 60].
  int width{640};             ///< Simulated camera: pixels, [16, 1920].
  int height{480};            ///< Simulated camera: pixels, [16, 1080].
  bool compressed{true};      ///< Simulated camera: sends JPEG; else image_raw.
};

/// The sensors of one robot that perception uses.
struct Sensors {
  static constexpr std::size_t kMaxLidars = 4, kMaxCameras = 8;
  std::vector<LidarConfig> lidars{};
  std::optional<ImuConfig> imu{};
  std::vector<CameraConfig> cameras{};
};

}  // namespace adit
