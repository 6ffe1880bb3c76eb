// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/result/result.hpp"

namespace adit::sim {

/// A cube of an octree that is known to be free or occupied.
struct OctreeLeaf {
  int x, y, z;  ///< Corner with the smallest coordinates, cells; cell 0 begins at 0 m.
  int size;     ///< Edge in cells, a power of two.
  bool occupied;
};

struct OctomapFile {
  double resolution{};  ///< Edge of a cell, m.
  std::vector<OctreeLeaf> leaves{};
};

/// Reads OctoMap's binary file format (.bt, `id OcTree`): A. Hornung et al., OctoMap (2013). Our own reader,
/// because the library's own does not withstand a truncated file. Errors: Reason::cannot_read, syntax,
/// not_supported.
Result<OctomapFile> read_octomap_file(const std::filesystem::path& file);

}  // namespace adit::sim
