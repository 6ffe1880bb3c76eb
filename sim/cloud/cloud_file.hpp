// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "perception/types/sweep.hpp"

namespace adit::sim {

/// One cloud as it was written.
struct CloudFile {
  /// In the sensor's frame, m; points that are not finite remain. Its stamp is 0. It has times if the file
  /// has a field for them, see perception::PointLayout.
  perception::Sweep sweep{};
  Pose3 viewpoint{};  ///< Where the sensor was (VIEWPOINT of a .pcd).
};

inline constexpr std::uint64_t kMaxCloudPoints = 10'000'000;  ///< Of one file.
inline constexpr double kCloudPeriod = 0.1;  ///< From one cloud to the next where nothing says it, s.

/// Reads a cloud by its extension: .pcd and .ply with the Point Cloud Library, or .bin as KITTI has them (x,
/// y, z and reflectance as little-endian 4 byte floats).
///
/// @param period  How long a sweep takes, s: decides about the unit of the points' times.
///
/// Errors name the file: Reason::cannot_read, syntax, not_supported (another extension, more than 10 million
/// points, a build without the library), sensor_times.
Result<CloudFile> read_cloud_file(const std::filesystem::path& file, double period = kCloudPeriod);

/// The points alone, m.
Result<PointCloud> read_cloud(const std::filesystem::path& file);
PointCloud points_of(const perception::Sweep& sweep);

/// The clouds of a folder, by name, or the file itself. Reason::cannot_read when there is none.
Result<std::vector<std::filesystem::path>> cloud_files(const std::filesystem::path& place);

}  // namespace adit::sim
