// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"

namespace adit::sim {

/// A point cloud file: points as they are written, m, and where the sensor was (VIEWPOINT).
struct PcdFile {
  PointCloud points{};
  Pose3 viewpoint{};
};

/// Reads a PCD file (Point Cloud Library, version 0.7): ascii, binary and binary_compressed; the fields x, y
/// and z, as 4 or 8 byte floats, whatever else there is. Points that are not finite are kept. Our own reader,
/// because the library's own is heavy and trusts what a file says of its size. Errors name file and line:
/// Reason::cannot_read, syntax, not_supported (more than 10 million points).
Result<PcdFile> read_pcd(const std::filesystem::path& file);

/// The .pcd files of a folder, by name. Reason::cannot_read when there is none.
Result<std::vector<std::filesystem::path>> pcd_files(const std::filesystem::path& folder);

}  // namespace adit::sim
