// SPDX-License-Identifier: Apache-2.0
// Pieces of a map as libFuzzer makes them up. Built by tools/fuzz.sh. The first byte chooses the reader.
#include <cstdlib>

#include "perception/stream/block_coder.hpp"
#include "perception/stream/piece.hpp"

using namespace adit::perception;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::uint8_t> bytes(data + 1, size - 1);
  if (data[0] % 4 == 0) {
    (void)decode(bytes);
  } else if (data[0] % 4 == 1) {
    (void)decode_poses(bytes);
  } else {  // Behind the checksum.
    RangeDecoder decoder(bytes);
    const auto set = read_blocks(decoder);
    if (set && set->indices.size() > kMaxSetBlocks) std::abort();
  }
  return 0;
}
