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

/// Writes a set of blocks, which can be read alone. The blocks must be in rising order, all different, within
/// BlockIndex::kLimit and at most kMaxSetBlocks. `bits`: if given, gets about how many bits each block took,
/// the indices left out.
void write_blocks(RangeEncoder& to, const BlockSet& set, std::vector<std::uint32_t>* bits = nullptr);

/// Reads what write_blocks() wrote. Reason::malformed for what makes no sense and for a level above
/// `max_level`, before its voxels are read; takes bounded time and memory whatever the bytes are.
Result<BlockSet> read_blocks(RangeDecoder& from, int max_level = BlockSet::kLevels - 1);

}  // namespace adit::perception
