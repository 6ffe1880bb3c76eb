// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <iosfwd>
#include <span>

#include "core/result/result.hpp"
#include "perception/map/voxel_image.hpp"

namespace adit::perception {

/// Write the centres of the occupied voxels, map frame, m, as float32 in binary, little-endian. Errors:
/// map_empty, cannot_write.
Result<void> write_pcd(const VoxelImage& image, std::ostream& to);
Result<void> write_ply(const VoxelImage& image, std::ostream& to);

/// The same of any points.
Result<void> write_pcd(std::span<const Eigen::Vector3f> points, std::ostream& to);
Result<void> write_ply(std::span<const Eigen::Vector3f> points, std::ostream& to);

}  // namespace adit::perception
