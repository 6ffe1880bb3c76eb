// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "perception/map/block.hpp"
#include "perception/map/submap_grid.hpp"

namespace adit::perception {

/// Blocks of a submap at one level of detail. A block of 0.8 m has 1, 2^3, 4^3 or 8^3 voxels at levels 0 to
/// 3: voxels of 0.8, 0.4, 0.2 and 0.1 m. A voxel is occupied when one of its eight parts is, free when none
/// is and at least one is free.
struct BlockSet {
  static constexpr int kLevels = 4;
  int level{2};
  std::vector<BlockIndex> indices{};
  std::vector<Voxel> voxels{};  ///< 8^level of each block, x + edge y + edge^2 z.
  /// Whether of a block only voxels of 0.4 m are known: all parts of one are as it is. At level 2 only;
  /// empty: of none.
  std::vector<bool> coarse{};

  int edge() const { return 1 << level; }
  std::size_t voxels_in_block() const { return std::size_t{1} << (3 * level); }
  bool operator==(const BlockSet&) const = default;
};

/// What the receiver of blocks has of one already, its base; nothing: none, or it is not to be used.
using FindBase = std::function<std::optional<CoarseBlock>(const BlockIndex&)>;

BlockSet block_set(std::span<const CoarseBlock> blocks);
BlockSet block_set(std::span<const FineBlock> blocks);
/// The same blocks one level higher; `set` must not be of level 0.
BlockSet coarser(const BlockSet& set);
/// The voxels of 0.2 m of a block that are part of one of 0.4 m of which any part is in these.
std::uint64_t in_large_voxels(std::uint64_t voxels);
/// A block whose voxels of 0.2 m all are as their voxel of 0.4 m.
CoarseBlock in_large_voxels(const CoarseBlock& block);
/// Blocks of a set of at most level 2 as masks: all parts of a larger voxel are as it is.
std::vector<CoarseBlock> coarse_blocks(const BlockSet& set);

}  // namespace adit::perception
