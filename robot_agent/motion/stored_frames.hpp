// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"

namespace adit::agent {

/// A pose of the body in the driver's odometry frame, and when it was measured.
struct OdometrySample {
  Pose3 T_odom_base{};
  std::uint64_t stamp{};  ///< Of the driver's clock, ns; 0: the driver sends none.
  Time received{};        ///< Of the agent's clock.
  bool operator==(const OdometrySample&) const = default;
};

/// The state of Frames that survives a restart of the agent.
struct StoredFrames {
  Pose2 T_map_odom{};
  std::uint32_t odom_epoch{};              ///< Rises when the odometry begins again elsewhere.
  std::optional<OdometrySample> newest{};  ///< The last pose in the odometry frame; unset: there was none.
  /// Height of the odometry frame's origin in the map, m; unset: unknown.
  std::optional<double> height{};
  std::uint32_t map_epoch{};  ///< Rises with each change of T_map_odom.
  /// The driver's odometry in the odometry frame; the identity with `perception: off`.
  Pose3 T_odom_driver{};
  /// False: after a restart the robot did not recognise its surroundings, and waits for its pose.
  bool recognised{true};
  /// Standard deviation of the horizontal position since the start, m; unset: unknown.
  std::optional<double> pose_sigma{};
  double yaw_sigma{};  ///< Of the heading, rad; 0 as long as nothing measures it.
  bool same_frame(const StoredFrames& other) const {
    return T_map_odom == other.T_map_odom && height == other.height && odom_epoch == other.odom_epoch &&
           map_epoch == other.map_epoch && recognised == other.recognised;
  }
  bool operator==(const StoredFrames&) const = default;
};

}  // namespace adit::agent
