// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "core/geometry/pose.hpp"
#include "sim/world/lidar.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {

/// Calls `visit(direction, length)` for each beam of one turn of a lidar at `sensor` (world frame): a unit
/// vector, and how far the beam reaches, at most `range`, m.
template <class Visit>
void for_each_beam(const World& world, const LidarPattern& lidar, const Pose3& sensor, double range,
                   const Visit& visit) {
  const Eigen::Matrix3d R = sensor.orientation.toRotationMatrix();
  const VoxelGrid::Start start = world.grid().locate(sensor.position);
  std::vector<Eigen::Vector3d> directions(lidar.elevations().size());
  std::vector<double> lengths(directions.size());
  for (const Eigen::Vector2d& azimuth : lidar.azimuths()) {
    const Eigen::Vector3d ahead = R.col(0) * azimuth.x() + R.col(1) * azimuth.y();
    for (std::size_t n = 0; n < directions.size(); ++n)
      directions[n] = ahead * lidar.elevations()[n].x() + R.col(2) * lidar.elevations()[n].y();
    world.grid().cast(start, directions, range, lengths);
    for (std::size_t n = 0; n < directions.size(); ++n) visit(directions[n], lengths[n]);
  }
}

}  // namespace adit::sim
