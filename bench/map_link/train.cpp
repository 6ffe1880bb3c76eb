// SPDX-License-Identifier: Apache-2.0
// map_train: makes the tables of the coder of map blocks (perception/stream/block_tables.cpp).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>

#include "bench/map_link/drives.hpp"
#include "bench/map_link/ground.hpp"
#include "bench/map_link/recording.hpp"
#include "bench/map_link/samples.hpp"
#include "bench/map_link/sent_sets.hpp"
#include "bench/map_link/tree_growth.hpp"

namespace {

using namespace adit;
using namespace adit::bench;

constexpr std::array<std::size_t, 4> kBlocksInSet{512, 512, 320,
                                                  48};  ///< At each level, about what a piece holds.

/// A real map counts more than its size, as generated worlds are many and smooth.
constexpr std::uint32_t kWeightOfBuilding = 8;

void add(SampleCollector& to, const std::vector<perception::FineBlock>& blocks, std::uint32_t weight) {
  for (int level = 1; level <= 3; ++level)
    for (const auto& set : sets_of(blocks, level, kBlocksInSet[static_cast<std::size_t>(level)]))
      to.add(set, weight);
}

/// The sets of blocks that robots send while they drive, to a station that has what they sent before.
Result<void> add_missions(SampleCollector& to, const std::vector<std::string>& kinds, Duration length) {
  constexpr std::size_t kPieceBytes = 1056;
  for (const std::string& kind : kinds) {
    const auto ground = make_ground(kind, 101);
    if (!ground) return ground.error();
    std::size_t pieces = 0, blocks = 0, changes = 0;
    for (const MapRecording& robot : record_team(*ground, 101, 1, length))
      visit_sent(robot, kPieceBytes, [&](const perception::MapPiece& piece, const auto& find_stored) {
        std::vector<perception::CoarseBlock> masks;
        for (const perception::BlockUpdate& update : piece.blocks) masks.push_back(update.block);
        to.add(perception::block_set(std::span<const perception::CoarseBlock>(masks)), 1,
               [&](const perception::BlockIndex& index) -> std::optional<perception::CoarseBlock> {
                 const auto base = find_stored(piece.key, index);
                 const auto now = std::lower_bound(
                     masks.begin(), masks.end(), index,
                     [](const auto& mask, const auto& wanted) { return mask.index < wanted; });
                 if (!base || (base->known & ~now->known) != 0) return std::nullopt;
                 ++changes;
                 return base;
               });
        ++pieces;
        blocks += masks.size();
      });
    fmt::print("{}: {} blocks in {} pieces, {} of them changes\n", kind, blocks, pieces, changes);
    std::fflush(stdout);
  }
  return {};
}

bool write_tables(const std::string& file, const std::string& text) {
  std::ofstream to(file);
  to << "// SPDX-License-Identifier: Apache-2.0\n// Written by map_train (bench/map_link/train.cpp); not for "
        "editing.\n"
        "#include \"perception/stream/block_tables.hpp\"\n\nnamespace adit::perception {\n\n// clang-format "
        "off\n"
        "const char* const kBlockTables =";
  for (std::size_t at = 0; at < text.size(); at += 112) to << "\n    \"" << text.substr(at, 112) << '"';
  to << ";\n// clang-format on\n"
     << fmt::format("const std::size_t kBlockTablesSize = {};\n", text.size())
     << "\n}  // namespace adit::perception\n";
  return to.good();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes the tables of the coder of map blocks from generated worlds and half of geb079.",
               "map_train"};
  std::string out = "perception/stream/block_tables.cpp";
  int seeds = 3;
  double length = 60.0, min_gain = 20.0;
  double mission = 90.0;
  std::size_t characters = 8000;
  std::vector<std::string> kinds{"corridor", "blocks", "cave", "stairs", "rubble", "rooms", "maze", "loop"};
  app.add_option("--out", out, "file to write")->capture_default_str();
  app.add_option("--kinds", kinds, "of worlds")->delimiter(',');
  app.add_option("--seeds", seeds, "worlds of each kind: seeds 101 and up")->capture_default_str();
  app.add_option("--length", length, "of a drive, m")->capture_default_str();
  app.add_option("--mission", mission, "duration of missions, s")->capture_default_str();
  app.add_option("--characters", characters, "of the tables")->capture_default_str();
  app.add_option("--min-gain", min_gain, "bits that a question must save")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  SampleCollector collector;
  const auto add_drive = [&](std::string_view kind, std::uint64_t seed) {
    const auto drive = drive_through(kind, seed, length);
    if (!drive) {
      fmt::print(stderr, "map_train: {}\n", drive.error().text);
      return false;
    }
    std::size_t blocks = 0;
    for (const BlockBatch& batch : drive->batches) {
      add(collector, batch, 1);
      blocks += batch.size();
    }
    fmt::print("{}: {} blocks in {} batches\n", drive->world, blocks, drive->batches.size());
    std::fflush(stdout);
    return true;
  };
  for (const std::string& kind : kinds)
    for (int seed = 0; seed < seeds; ++seed)
      if (!add_drive(kind, static_cast<std::uint64_t>(101 + seed))) return 2;
  if (const auto added = add_missions(collector, kinds, from_seconds(mission)); !added) {
    fmt::print(stderr, "map_train: {}\n", added.error().text);
    return 2;
  }
  const auto building = building_map();
  if (!building) {
    fmt::print(stderr, "map_train: {}\n", building.error().text);
    return 2;
  }
  // The western half of the building; the other one is for checking.
  std::vector<perception::FineBlock> west;
  const auto bounds = building->bounds();
  const int middle = (bounds->low.x + bounds->high.x) / 2 / 8;
  for (const auto& block : fine_blocks(*building))
    if (block.index.x < middle) west.push_back(block);
  add(collector, west, kWeightOfBuilding);

  std::array<std::vector<Sample>, perception::kDecisions> samples;
  std::size_t all = 0;
  for (int d = 0; d < perception::kDecisions; ++d) {
    samples[static_cast<std::size_t>(d)] = collector.samples(d);
    all += samples[static_cast<std::size_t>(d)].size();
  }
  const std::string text = grow_trees(samples, characters, min_gain);
  fmt::print("{} different samples, {} characters\n", all, text.size());
  return write_tables(out, text) ? 0 : 2;
}
