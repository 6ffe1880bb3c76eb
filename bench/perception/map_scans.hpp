// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "sim/world/lidar.hpp"

namespace adit::bench {

/// A scan in the map's frame, m.
struct MapScan {
  Eigen::Vector3f origin{Eigen::Vector3f::Zero()};
  PointCloud points{};
};

/// Scans of a lidar that is carried along the corridor of geb079, one each 0.2 m.
Result<std::vector<MapScan>> building_scans(const sim::LidarParams& lidar, int scans);
/// Scans of a lidar that is carried through a hall of 36 m x 36 m with pillars.
Result<std::vector<MapScan>> hall_scans(const sim::LidarParams& lidar, int scans);

}  // namespace adit::bench
