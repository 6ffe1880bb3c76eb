// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/result/result.hpp"
#include "perception/stream/block_set.hpp"
#include "perception/stream/range_coder.hpp"

namespace adit::perception {

constexpr std::size_t kMaxSetBlocks = 512;

/// Writes a set of blocks. The blocks must be in rising order, all different, within BlockIndex::kLimit and
/// at most kMaxSetBlocks. `find_base`: an older state of a block that its receivers have, of which each known
/// voxel must be known in the set, too: then little more is written than what differs. For sets of level 2.
/// `bits`: if given, gets about how many bits each block took, the indices left out.
void write_blocks(RangeEncoder& to, const BlockSet& set, const FindBase& find_base = {},
                  std::vector<std::uint32_t>* bits = nullptr);

/// Reads what write_blocks() wrote. `find_base`: what is here of a block. Reason::malformed for what makes no
/// sense and for a level above `max_level`, before its voxels are read; out_of_range if another base is here
/// than it was written for. Takes bounded time and memory whatever the bytes are.
Result<BlockSet> read_blocks(RangeDecoder& from, int max_level = BlockSet::kLevels - 1,
                             const FindBase& find_base = {});

}  // namespace adit::perception
