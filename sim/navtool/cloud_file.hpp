// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"

namespace adit::sim {

/// Reads a cloud by its extension: .pcd (read_pcd), or .bin as KITTI has them (x, y, z and reflectance as
/// little-endian 4 byte floats). Points in the sensor's frame, m; those that are not finite are kept.
/// Errors: Reason::cannot_read, syntax, not_supported (another extension, more than 10 million points).
Result<PointCloud> read_cloud(const std::filesystem::path& file);

/// The clouds of a folder, by name, or the file itself. Reason::cannot_read when there is none.
Result<std::vector<std::filesystem::path>> cloud_files(const std::filesystem::path& place);

/// The poses of a TUM file: `stamp x y z qx qy qz qw`, one a line, # begins a comment. Errors name file and
/// line: Reason::cannot_read, syntax.
struct StampedPose {
  double stamp_s{};
  Pose3 pose{};
};
Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& file);

}  // namespace adit::sim
