// SPDX-License-Identifier: Apache-2.0
// Pieces of a map as libFuzzer makes them up. Built by tools/fuzz.sh. The first byte chooses the reader.
#include <cstdlib>
#include <map>

#include "perception/stream/block_coder.hpp"
#include "perception/stream/piece.hpp"

using namespace adit::perception;

/// Writes blocks as changes to others, and reads them again. 40 bytes a block.
static void change(std::span<const std::uint8_t> bytes) {
  const auto number = [&](std::size_t at) {
    std::uint64_t out = 0;
    for (std::size_t i = 0; i < 8; ++i) out |= std::uint64_t{bytes[at + i]} << 8 * i;
    return out;
  };
  std::map<BlockIndex, CoarseBlock> blocks, bases;
  std::map<BlockIndex, bool> coarse;
  for (; bytes.size() >= 40 && blocks.size() < 64; bytes = bytes.subspan(40)) {
    const BlockIndex index{static_cast<std::int8_t>(bytes[0]), static_cast<std::int8_t>(bytes[1]), bytes[2]};
    blocks[index] = {index, number(8), number(8) & number(16)};
    coarse[index] = bytes[4] % 4 == 0;
    if (coarse[index]) blocks[index] = in_large_voxels(blocks[index]);
    if (bytes[3] % 4 != 0) bases[index] = {index, number(24), number(24) & number(32)};
  }
  std::vector<CoarseBlock> sorted;
  for (const auto& [index, block] : blocks) sorted.push_back(block);
  const FindBase base = [&](const BlockIndex& index) {
    const auto found = bases.find(index);
    return found != bases.end() ? std::optional(found->second) : std::nullopt;
  };
  RangeEncoder encoder;
  BlockSet written = block_set(sorted);
  for (const auto& [index, is_coarse] : coarse) written.coarse.push_back(is_coarse);
  write_blocks(encoder, written, base);
  const auto coded = encoder.finish();
  RangeDecoder decoder(coded);
  const auto set = read_blocks(decoder, 2, base);
  if (!set || coarse_blocks(*set) != sorted) std::abort();
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (written.coarse[i] != (!set->coarse.empty() && set->coarse[i])) std::abort();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::uint8_t> bytes(data + 1, size - 1);
  if (data[0] % 5 == 0) {
    (void)decode(bytes);
  } else if (data[0] % 5 == 1) {
    (void)decode_poses(bytes);
  } else if (data[0] % 5 == 2) {
    change(bytes);
  } else {  // Behind the checksum.
    RangeDecoder decoder(bytes);
    const auto set = read_blocks(decoder);
    if (set && set->indices.size() > kMaxSetBlocks) std::abort();
  }
  return 0;
}
