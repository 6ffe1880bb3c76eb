// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "core/component/call.hpp"
#include "core/geometry/pose.hpp"

namespace adit::agent {

/// The pose of the odometry frame in the map, and the epochs in which it is in force.
///
/// A correction is computed from the MapFrame that was in force when the computation began. It has the same
/// epochs, so that the robot can refuse a correction of an outdated pose.
struct MapFrame {
  Pose3 T_map_odom{};          ///< Level: x, y, z in m, and yaw.
  std::uint32_t odom_epoch{};  ///< Rises when the odometry begins again elsewhere.
  std::uint32_t map_epoch{};   ///< Rises with each change of T_map_odom and each restart.
};

/// A request for the MapFrame in force.
struct MapFrameQuery {};

/// The services of the command component for programs that correct the map.
struct FrameServices {
  Service<MapFrameQuery, MapFrame> find{"map frame", 4};
  Service<MapFrame, MapFrame> correct{"map correction", 4};  ///< Answers with the MapFrame then in force.
};

}  // namespace adit::agent
