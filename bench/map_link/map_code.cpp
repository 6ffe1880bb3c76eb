// SPDX-License-Identifier: Apache-2.0
// bench_map_link: bytes that a map takes on the radio, by level, beside what others send, as a table.
#include <fmt/format.h>
#include <zstd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <set>
#include <sstream>

#include "bench/map_link/drives.hpp"
#include "bench/map_link/samples.hpp"
#include "bench/nav/calibration.hpp"
#include "perception/map/export/octree_file.hpp"
#include "perception/stream/block_coder.hpp"

namespace {

using namespace adit;
using namespace adit::bench;

std::size_t coded_bytes(const std::vector<perception::FineBlock>& blocks, int level, std::size_t max_bytes,
                        std::size_t head, std::size_t& pieces) {
  std::vector<perception::FineBlock> sorted = blocks;
  std::size_t total = 0;
  pieces = 0;
  std::size_t at = 0;
  while (at < sorted.size()) {
    std::size_t count = std::min<std::size_t>(perception::kMaxSetBlocks, sorted.size() - at);
    for (;;) {
      perception::BlockSet set = perception::block_set(std::span(sorted).subspan(at, count));
      while (set.level > level) set = perception::coarser(set);
      perception::RangeEncoder encoder;
      perception::write_blocks(encoder, set);
      const auto bytes = encoder.finish();
      if (bytes.size() + head > max_bytes && count > 1) {
        count = std::max<std::size_t>(1, std::min(count - 1, count * (max_bytes - head) / bytes.size()));
        continue;
      }
      perception::RangeDecoder decoder(bytes);
      const auto back = perception::read_blocks(decoder);
      if (!back)
        fmt::print("REFUSED level {} blocks {} bytes {}\n", level, set.indices.size(), bytes.size());
      else if (*back != set) {
        std::size_t i = 0;
        while (i < set.voxels.size() && back->voxels.size() > i && back->voxels[i] == set.voxels[i]) ++i;
        fmt::print("MISMATCH level {} blocks {} {} at {} indices {}\n", level, set.indices.size(),
                   back->indices.size(), i, back->indices == set.indices);
      }
      total += bytes.size() + head;
      ++pieces;
      break;
    }
    at += count;
  }
  return total;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"x", "bench_map_link"};
  std::size_t head = 24;
  CLI11_PARSE(app, argc, argv);
  const auto building = building_map();
  if (!building) return 2;
  const auto all = fine_blocks(*building);
  std::vector<perception::FineBlock> east;
  const auto bounds = building->bounds();
  const int middle = (bounds->low.x + bounds->high.x) / 2 / 8;
  for (const auto& block : all)
    if (block.index.x >= middle) east.push_back(block);
  fmt::print("{} blocks, {} x {}\n", all.size(), (bounds->high.x - bounds->low.x) * 0.1,
             (bounds->high.y - bounds->low.y) * 0.1);
  for (int level = 1; level <= 3; ++level)
    for (std::size_t max_bytes : {500, 1200}) {
      std::size_t pieces = 0, half = 0;
      const std::size_t bytes = coded_bytes(all, level, max_bytes, head, pieces);
      const std::size_t e = coded_bytes(east, level, max_bytes, head, half);
      fmt::print("level {} max {}: {} B in {} pieces, {:.2f} B/m2; east {} B {:.2f} B/m2; {:.2f} B/block\n",
                 level, max_bytes, bytes, pieces, bytes / (43.8 * 18.2), e, 2 * e / (43.8 * 18.2),
                 double(bytes) / all.size());
    }
  for (const char* kind : {"car_park", "dead_ends", "gaps", "rooms", "cave"}) {
    const auto drive = drive_through(kind, 7, 40.0);
    const auto blocks = fine_blocks(drive->grid);
    for (int level = 1; level <= 3; ++level) {
      std::size_t pieces = 0;
      const std::size_t bytes = coded_bytes(blocks, level, 1200, head, pieces);
      fmt::print("{} level {}: {} B, {:.2f} B/block\n", drive->world, level, bytes,
                 double(bytes) / blocks.size());
    }
  }
  return 0;
}
