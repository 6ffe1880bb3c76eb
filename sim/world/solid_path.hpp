// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

#include "sim/world/voxel_grid.hpp"

namespace adit::sim {

/// Metres of what is solid on the straight way from `a` to `b`, world coordinates, m. Below and above the
/// grid all is solid, beside it what the grid says. Ends early beyond `enough` m. Voxel traversal after
/// Amanatides and Woo (1987).
double solid_between(const VoxelGrid& grid, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                     double max_length);

}  // namespace adit::sim
