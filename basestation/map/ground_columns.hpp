// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>

#include "basestation/map/chunk_store.hpp"

namespace adit::station {

/// Calls `visit(x, y, block)` for each column of 0.2 m of which a submap's block knows anything: x and y are
/// the column's place in the map frame, in cells of 0.2 m. Submaps without a pose have none.
template <class Visit>
void for_each_column(const ChunkStore::Submap& submap, const Visit& visit) {
  constexpr double kCell = perception::CoarseBlock::kVoxel;
  if (!submap.T_map_submap) return;
  for (const auto& [index, block] : submap.blocks) {
    std::uint64_t columns = block.known;
    columns = (columns | columns >> 32 | columns >> 16 | columns >> 48) & 0xffff;
    for (int column = 0; column < 16; ++column) {
      if ((columns >> column & 1) == 0) continue;
      const Eigen::Vector3d centre((index.x * 4 + column % 4 + 0.5) * kCell,
                                   (index.y * 4 + column / 4 + 0.5) * kCell, (index.z * 4 + 2) * kCell);
      const Eigen::Vector3d at = *submap.T_map_submap * centre;
      visit(static_cast<std::int32_t>(std::floor(at.x() / kCell)),
            static_cast<std::int32_t>(std::floor(at.y() / kCell)), block);
    }
  }
}

}  // namespace adit::station
