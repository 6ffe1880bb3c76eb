// SPDX-License-Identifier: Apache-2.0
#include "sim/cloud/pcl_file.hpp"

namespace adit::sim {

Result<CloudFile> read_with_pcl(const std::filesystem::path& file, double) {
  return {Reason::not_supported,
          file.string() + ": built without the Point Cloud Library (ADIT_PCL), which reads .pcd and .ply"};
}

}  // namespace adit::sim
