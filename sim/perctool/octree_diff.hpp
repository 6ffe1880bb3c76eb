// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>

#include "sim/world/octomap_file.hpp"

namespace adit::sim::perctool {

/// Cells of two maps compared, each of the maps' resolution; a pruned leaf counts as all of its cells.
struct OctreeDiff {
  std::uint64_t equal{};      ///< In both, of the same state.
  std::uint64_t missing{};    ///< Known in the first alone.
  std::uint64_t more{};       ///< Known in the second alone.
  std::uint64_t different{};  ///< Free in the one and occupied in the other.
  /// Share of the equal among all, [0, 1]; 1 for two empty maps.
  double share() const {
    const std::uint64_t all = equal + missing + more + different;
    return all == 0 ? 1.0 : static_cast<double>(equal) / static_cast<double>(all);
  }
};

/// Reads .bt, or .ot with liboctomap. Errors name the file: Reason::cannot_read, syntax, not_supported.
Result<OctomapFile> read_map(const std::filesystem::path& file);

/// Reason::bad_argument for maps of different resolutions.
Result<OctreeDiff> compare(const OctomapFile& a, const OctomapFile& b);

}  // namespace adit::sim::perctool
