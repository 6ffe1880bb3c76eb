// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "perception/map/submap_grid.hpp"
#include "perception/stream/block_set.hpp"

namespace adit::bench {

/// Bytes of a map in pieces that can be decoded alone.
struct Coded {
  std::size_t pieces{};
  std::size_t bytes{};              ///< With each piece's own header.
  double encode_us{}, decode_us{};  ///< Of a block.
  std::size_t on_air() const;       ///< With the headers of the radio.
};

/// Headers of a datagram of up to 1200 bytes: IPv4 20, UDP 8, RTPS 20, INFO_TS 12, DATA 24, and 36 of the
/// message around the piece.
constexpr std::size_t kHeaders = 120;
std::size_t on_air(std::size_t bytes);

/// The blocks at a level in pieces of at most `max_bytes`, by the coder of blocks.
Coded code(std::span<const perception::FineBlock> blocks, int level, std::size_t max_bytes);
/// Voxels of 0.2 m as pieces had them before: up to 64 blocks, indices and masks compressed with Zstandard.
Coded compress_blocks(std::span<const perception::FineBlock> blocks, std::size_t max_bytes);
/// The whole map at a level as a .bt file, compressed with `zstd -19`.
std::size_t octree_bytes(std::span<const perception::FineBlock> blocks, int level);
/// Ground under what is known: columns of 0.2 m, m2.
double seen_area(std::span<const perception::FineBlock> blocks);

}  // namespace adit::bench
