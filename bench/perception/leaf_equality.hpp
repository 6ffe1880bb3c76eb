// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <octomap/octomap.h>

#include <cstddef>

#include "perception/map/submap_grid.hpp"

namespace adit::bench {

/// Agreement of our grid with OctoMap's tree of the same scans, in voxels of the full resolution.
struct LeafEquality {
  std::size_t ours{}, theirs{};  ///< Known voxels.
  std::size_t ours_equal{};      ///< Of ours: known to OctoMap, and the same.
  std::size_t theirs_equal{};    ///< Of OctoMap's: known to us, and the same.
  std::size_t theirs_occupied{}, theirs_occupied_equal{};

  double of_ours() const { return share(ours_equal, ours); }
  double of_theirs() const { return share(theirs_equal, theirs); }
  double of_occupied() const { return share(theirs_occupied_equal, theirs_occupied); }

 private:
  static double share(std::size_t part, std::size_t all) {
    return all == 0 ? 1.0 : static_cast<double>(part) / static_cast<double>(all);
  }
};

LeafEquality compare(const perception::SubmapGrid& ours, const octomap::OcTree& theirs);

}  // namespace adit::bench
