// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "sim/cloud/cloud_file.hpp"

namespace adit::sim {

/// Reads a .pcd or .ply file with the Point Cloud Library; Reason::not_supported in a build without it
/// (ADIT_PCL). See read_cloud_file().
Result<CloudFile> read_with_pcl(const std::filesystem::path& file, double period);

}  // namespace adit::sim
