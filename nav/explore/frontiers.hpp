// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "nav/explore/coverage_map.hpp"

namespace adit::nav {

/// The border between free and unseen space: a place to look at.
struct Frontier {
  std::vector<CoverageVoxel> unseen{};  ///< The voxels beside it, in the order of the map's tiles.
  Eigen::Vector3d centre{0, 0, 0};      ///< Centre of the free voxel nearest to the middle of the group, m.
  double gain{0};                       ///< Volume that is expected behind it, m3.
  double weight{1};                     ///< Factor of its gain by the robot's areas.
};

/// The frontiers of a map and the volume of those that were left out.
struct Frontiers {
  std::vector<Frontier> list{};
  double dropped{0};  ///< m3.
};

/// Groups free voxels with an unseen voxel beside them (Yamauchi: *A frontier-based approach for autonomous
/// exploration*, 1997), column by column, in the order of the map's tiles: the same map gives the same list.
/// Voxels that were tried do not count as unseen. `least_gain`: a frontier with less behind it is left out,
/// m3.
Frontiers find_frontiers(const CoverageMap& map, double least_gain);

}  // namespace adit::nav
