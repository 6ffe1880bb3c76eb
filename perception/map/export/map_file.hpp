// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <span>

#include "core/result/result.hpp"
#include "perception/map/voxel_image.hpp"

namespace adit::perception {

/// Writes a file that appears under its name only when it is complete: FILE.part, synced, renamed, and the
/// folder synced. On failure the .part file is removed and the old file stays. Errors: those of `write`, or
/// cannot_write with the file and the system's reason.
Result<void> write_file_atomically(const std::filesystem::path& file,
                                   const std::function<Result<void>(std::ostream&)>& write);

/// Writes these bytes so. Error: cannot_write.
Result<void> write_file_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// Options of save_map().
struct SaveOptions {
  std::size_t floor{0};  ///< Of a .pgm file.
};

/// Saves a map in the format that the file's extension names: .bt, .ot, .pcd, .ply, or .pgm with its .yaml
/// beside it. Errors: bad_argument for another extension (the text lists them), map_empty, out_of_range,
/// cannot_write.
Result<void> save_map(const VoxelImage& image, const std::filesystem::path& file,
                      const SaveOptions& options = {});

/// Loads a .bt or .ot file. Errors name the file: cannot_read, syntax, not_supported, map_empty.
Result<VoxelImage> load_map(const std::filesystem::path& file);

}  // namespace adit::perception
