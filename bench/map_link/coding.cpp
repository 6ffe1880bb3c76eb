// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/coding.hpp"

#include <zstd.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "bench/nav/calibration.hpp"
#include "core/store/pack.hpp"
#include "perception/map/export/octree_file.hpp"
#include "perception/stream/block_coder.hpp"
#include "perception/stream/piece.hpp"

namespace adit::bench {
namespace {

using perception::BlockSet;
using perception::FineBlock;

BlockSet set_at(std::span<const FineBlock> blocks, int level) {
  BlockSet set = perception::block_set(blocks);
  while (set.level > level) set = perception::coarser(set);
  return set;
}

/// What a piece has before its blocks: version, kind, checksum, name of 9 characters, start, numbers.
constexpr std::size_t kPieceHeader = 6 + 10 + 8 + 5;

std::size_t compressed(std::span<const std::uint8_t> content, int level) {
  std::vector<std::uint8_t> out(ZSTD_compressBound(content.size()));
  return ZSTD_compress(out.data(), out.size(), content.data(), content.size(), level);
}

/// Content of a piece of the former format.
std::vector<std::uint8_t> former_content(std::span<const perception::CoarseBlock> blocks) {
  store::Packer head, shapes, known, occupied;
  perception::BlockIndex before{};
  const auto by_columns = [](std::uint64_t mask) {
    std::uint64_t out = 0;
    for (int i = 0; i < 64; ++i) out |= (mask >> i & 1) << ((i >> 4) | (i & 3) << 4 | (i >> 2 & 3) << 2);
    return out;
  };
  head.text<std::uint8_t>("wheeled_1").put(std::uint64_t{0x0123456789abcdefu}).varint(7);
  head.put(static_cast<std::uint8_t>(blocks.size()));
  for (const perception::CoarseBlock& b : blocks) {
    head.zigzag(b.index.x - before.x);
    head.zigzag(b.index.y - before.y);
    head.zigzag(b.index.z - before.z);
    head.zigzag(1);  // Revisions that rise by one.
    before = b.index;
    const bool full = b.known == ~std::uint64_t{0}, free = b.occupied == 0;
    shapes.put(static_cast<std::uint8_t>((full ? 1 : 0) | (free ? 2 : 0)));
    if (!full) known.put(by_columns(b.known));
    if (!free) occupied.put(by_columns(b.occupied));
  }
  std::vector<std::uint8_t> out = head.bytes();
  for (const auto* part : {&shapes, &known, &occupied})
    out.insert(out.end(), part->bytes().begin(), part->bytes().end());
  return out;
}

}  // namespace

std::size_t on_air(std::size_t bytes) {
  const std::size_t piece = perception::kMaxPieceBytes;
  return bytes + (bytes + piece - 1) / piece * kHeaders;
}

std::size_t Coded::on_air() const { return bytes + pieces * kHeaders; }

Coded code(std::span<const FineBlock> blocks, int level, std::size_t max_bytes) {
  Coded out;
  double encode = 0.0, decode = 0.0;
  for (std::size_t at = 0; at < blocks.size();) {
    std::size_t count = std::min(perception::kMaxSetBlocks, blocks.size() - at);
    std::vector<std::uint8_t> bytes;
    for (;;) {
      const BlockSet set = set_at(blocks.subspan(at, count), level);
      const double begin = thread_cpu_ms();
      perception::RangeEncoder encoder;
      perception::write_blocks(encoder, set);
      bytes = encoder.finish();
      encode += thread_cpu_ms() - begin;
      const std::size_t size = bytes.size() + kPieceHeader;
      if (size <= max_bytes || count == 1) break;
      count =
          std::max<std::size_t>(1, std::min(count - 1, count * (max_bytes - kPieceHeader) / bytes.size()));
      encode = encode - (thread_cpu_ms() - begin);
    }
    const double begin = thread_cpu_ms();
    perception::RangeDecoder decoder(bytes);
    static_cast<void>(perception::read_blocks(decoder));
    decode += thread_cpu_ms() - begin;
    out.bytes += bytes.size() + kPieceHeader;
    ++out.pieces;
    at += count;
  }
  out.encode_us = 1000.0 * encode / static_cast<double>(blocks.size());
  out.decode_us = 1000.0 * decode / static_cast<double>(blocks.size());
  return out;
}

Coded compress_blocks(std::span<const FineBlock> blocks, std::size_t max_bytes) {
  const std::vector<perception::CoarseBlock> masks = perception::coarse_blocks(set_at(blocks, 2));
  Coded out;
  for (std::size_t at = 0; at < masks.size();) {
    std::size_t count = std::min<std::size_t>(64, masks.size() - at), size = 0;
    for (;; --count) {
      // Version and kind before it, the checksum of four bytes behind it.
      size = 2 + compressed(former_content(std::span(masks).subspan(at, count)), 3) + 4;
      if (size <= max_bytes || count == 1) break;
    }
    out.bytes += size;
    ++out.pieces;
    at += count;
  }
  return out;
}

std::size_t octree_bytes(std::span<const FineBlock> blocks, int level) {
  const BlockSet set = set_at(blocks, level);
  const int edge = set.edge();
  perception::VoxelImage image(0.8 / edge);
  for (std::size_t i = 0; i < set.voxels.size(); ++i) {
    if (set.voxels[i] == perception::Voxel::unknown) continue;
    const perception::BlockIndex& b = set.indices[i / set.voxels_in_block()];
    const int v = static_cast<int>(i % set.voxels_in_block());
    image.set({b.x * edge + v % edge, b.y * edge + v / edge % edge, b.z * edge + v / edge / edge},
              set.voxels[i]);
  }
  std::ostringstream file;
  if (!perception::write_bt(image, file)) return 0;
  const std::string text = file.str();
  return compressed({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, 19);
}

double seen_area(std::span<const FineBlock> blocks) {
  std::set<std::pair<int, int>> columns;
  for (const perception::CoarseBlock& b : perception::coarse_blocks(set_at(blocks, 2)))
    for (int i = 0; i < 64; ++i)
      if ((b.known >> i & 1) != 0) columns.insert({4 * b.index.x + i % 4, 4 * b.index.y + i / 4 % 4});
  return 0.04 * static_cast<double>(columns.size());
}

}  // namespace adit::bench
