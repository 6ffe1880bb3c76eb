// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/block_set.hpp"

#include <algorithm>

namespace adit::perception {

BlockSet block_set(std::span<const CoarseBlock> blocks) {
  BlockSet out{.level = 2};
  out.voxels.reserve(64 * blocks.size());
  for (const CoarseBlock& block : blocks) {
    out.indices.push_back(block.index);
    for (int i = 0; i < 64; ++i)
      out.voxels.push_back((block.known >> i & 1) == 0      ? Voxel::unknown
                           : (block.occupied >> i & 1) != 0 ? Voxel::occupied
                                                            : Voxel::free);
  }
  return out;
}

BlockSet block_set(std::span<const FineBlock> blocks) {
  BlockSet out{.level = 3};
  out.voxels.reserve(512 * blocks.size());
  for (const FineBlock& block : blocks) {
    out.indices.push_back(block.index);
    for (int z = 0; z < 8; ++z)
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) out.voxels.push_back(block.at(x, y, z));
  }
  return out;
}

BlockSet coarser(const BlockSet& set) {
  BlockSet out{.level = set.level - 1, .indices = set.indices};
  const auto edge = static_cast<std::size_t>(set.edge()), half = edge / 2;
  out.voxels.assign(set.indices.size() * out.voxels_in_block(), Voxel::unknown);
  for (std::size_t b = 0; b < set.indices.size(); ++b) {
    const Voxel* parts = &set.voxels[b * set.voxels_in_block()];
    Voxel* block = &out.voxels[b * out.voxels_in_block()];
    for (std::size_t z = 0; z < edge; ++z)
      for (std::size_t y = 0; y < edge; ++y)
        for (std::size_t x = 0; x < edge; ++x) {
          Voxel& voxel = block[x / 2 + half * (y / 2) + half * half * (z / 2)];
          voxel = std::max(voxel, parts[x + edge * y + edge * edge * z]);
        }
  }
  return out;
}

std::uint64_t in_large_voxels(std::uint64_t voxels) {
  voxels |= voxels >> 1;
  voxels |= voxels >> 4;
  voxels |= voxels >> 16;
  voxels &= 0x0000'0505'0000'0505ULL;  // The first voxel of each eight, if any of them is.
  voxels |= voxels << 1;
  voxels |= voxels << 4;
  return voxels | voxels << 16;
}

CoarseBlock in_large_voxels(const CoarseBlock& block) {
  return {block.index, in_large_voxels(block.known), in_large_voxels(block.occupied)};
}

std::vector<CoarseBlock> coarse_blocks(const BlockSet& set) {
  std::vector<CoarseBlock> out;
  if (set.level > 2) return out;
  const int shift = 2 - set.level, edge = set.edge();
  for (std::size_t b = 0; b < set.indices.size(); ++b) {
    CoarseBlock block{set.indices[b], 0, 0};
    for (int i = 0; i < 64; ++i) {
      const int x = i % 4 >> shift, y = i / 4 % 4 >> shift, z = i / 16 >> shift;
      const auto at = static_cast<std::size_t>(x + edge * (y + edge * z));
      const Voxel voxel = set.voxels[b * set.voxels_in_block() + at];
      block.known |= static_cast<std::uint64_t>(voxel != Voxel::unknown) << i;
      block.occupied |= static_cast<std::uint64_t>(voxel == Voxel::occupied) << i;
    }
    out.push_back(block);
  }
  return out;
}

}  // namespace adit::perception
