// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <iosfwd>
#include <string_view>

#include "core/result/result.hpp"
#include "perception/map/voxel_image.hpp"

/// OctoMap's files (A. Hornung et al. 2013), written and read without its library, which stops the process or
/// prints on files that are damaged.
namespace adit::perception {

/// Writes OctoMap's binary format, .bt (`id OcTree`): occupied or free. Errors: map_empty, out_of_range when
/// voxels lie beyond 32768 voxels from the origin, cannot_write.
Result<void> write_bt(const VoxelImage& image, std::ostream& to);
/// Writes OctoMap's full format, .ot: log-odds, which are at OctoMap's bounds. Errors: as write_bt().
Result<void> write_ot(const VoxelImage& image, std::ostream& to);

/// Reads a .bt or .ot file's content: the first line says which. Errors: syntax (not such a file, cut off,
/// damaged), not_supported (another type of tree, or a map larger than VoxelImage::kMaxBlocks), map_empty.
Result<VoxelImage> read_octree(std::string_view content);

}  // namespace adit::perception
