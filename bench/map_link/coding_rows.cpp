// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "bench/map_link/coding.hpp"
#include "bench/map_link/drives.hpp"
#include "bench/map_link/rows.hpp"
#include "perception/stream/block_set.hpp"
#include "robot_agent/perception/block_source.hpp"

namespace adit::bench {
namespace {

using perception::FineBlock;

constexpr double kBoxOfBuilding = 43.8 * 18.2;                ///< geb079, by OctoMap's paper, m2.
constexpr std::array<double, 4> kGoal{0.0, 3.0, 12.0, 60.0};  ///< Bytes a m2 at each level.
constexpr double kMissionGoal = 3.0;  ///< Bytes of a mission by those of the final .bt.
constexpr std::array<const char*, 4> kVoxel{"0.8", "0.4", "0.2", "0.1"};

/// Worlds whose kinds or seeds the tables were not made of.
struct HeldOut {
  const char* kind;
  std::uint64_t seed;
};
constexpr std::array<HeldOut, 6> kHeldOut{
    {{"car_park", 7}, {"dead_ends", 7}, {"tunnel", 7}, {"cave", 207}, {"rubble", 207}, {"blocks", 207}}};

void print_rows(const char* name, const std::vector<FineBlock>& blocks, double area, std::size_t max_bytes) {
  for (int level = 3; level >= 1; --level) {
    const Coded ours = code(blocks, level, max_bytes);
    const std::size_t tree = octree_bytes(blocks, level);
    const auto a_m2 = [area](std::size_t bytes) { return static_cast<double>(bytes) / area; };
    const std::string former =
        level == 2 ? fmt::format("{:.1f}", a_m2(compress_blocks(blocks, max_bytes).bytes)) : std::string("-");
    fmt::print("| {} | {} | {:.0f} | {} | {:.2f} | {:.2f} | {} | {:.1f} | {:.2f} | {:.1f} / {:.1f} |\n", name,
               kVoxel[static_cast<std::size_t>(level)], area, ours.pieces, a_m2(ours.bytes),
               a_m2(ours.on_air()), former, a_m2(tree),
               static_cast<double>(ours.bytes) / static_cast<double>(tree), ours.encode_us, ours.decode_us);
    std::fflush(stdout);
  }
}

/// What a robot sends of a drive, to a station that hears all of it: 0.2 m.
struct SentPieces {
  std::size_t bytes{}, pieces{};
};
SentPieces send_all_of(const MapDrive& drive) {
  agent::BlockSource source({.robot = "wheeled_1", .start = 0x0123456789abcdefu});
  const transfer::PeerId station{1};
  source.join(station);
  SentPieces out;
  Time now{};
  const auto send_all = [&] {
    while (const auto content = source.next(std::span(&station, 1), 1200, now)) {
      out.bytes += content->data.size();
      ++out.pieces;
      source.acknowledged(station, content->token);
      source.settled(content->token);
    }
  };
  for (const BlockBatch& batch : drive.batches) {
    for (const perception::CoarseBlock& block :
         perception::coarse_blocks(perception::coarser(perception::block_set(batch))))
      source.update(0, block);
    now += 3s;
    send_all();
  }
  for (int wait = 0; wait < 60; ++wait) {
    now += 3s;
    send_all();
  }
  return out;
}

}  // namespace

Result<void> print_coding(double length, bool mission) {
  const auto building = building_map();
  if (!building) return building.error();
  const std::vector<FineBlock> building_blocks = fine_blocks(*building);
  const auto bounds = building->bounds();
  const int middle = (bounds->low.x + bounds->high.x) / 2 / 8;
  std::vector<FineBlock> east;
  for (const FineBlock& block : building_blocks)
    if (block.index.x >= middle) east.push_back(block);

  fmt::print(
      "| map | voxel, m | m2 | pieces | B/m2 | with headers | before | .bt, zstd -19 | ratio | encode / "
      "decode, us a "
      "block |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  print_rows("geb079, 1200 B", building_blocks, kBoxOfBuilding, 1200);
  print_rows("geb079, 500 B", building_blocks, kBoxOfBuilding, 500);
  print_rows("geb079, held-out half", east, seen_area(east), 1200);
  std::vector<MapDrive> drives;
  for (const HeldOut& world : kHeldOut) {
    auto drive = drive_through(world.kind, world.seed, length);
    if (!drive) return drive.error();
    const std::vector<FineBlock> blocks = fine_blocks(drive->grid);
    if (blocks.empty()) continue;
    print_rows(drive->world.c_str(), blocks, seen_area(blocks), 1200);
    drives.push_back(std::move(*drive));
  }
  for (int level = 3; level >= 1; --level) {
    const double bytes = static_cast<double>(code(building_blocks, level, 1200).bytes) / kBoxOfBuilding;
    const double goal = kGoal[static_cast<std::size_t>(level)];
    fmt::print("{}geb079 at {} m: {:.2f} B/m2, goal {:.0f}: {}\n", level == 3 ? "\n" : "",
               kVoxel[static_cast<std::size_t>(level)], bytes, goal, bytes <= goal ? "holds" : "missed");
  }
  if (!mission) return {};
  fmt::print(
      "\n| drive | pieces | bytes | with headers | final .bt at 0.2 m, zstd -19 | ratio | |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n");
  auto in_building = drive_through("geb079", 7, length);
  if (in_building) drives.push_back(std::move(*in_building));
  for (const MapDrive& drive : drives) {
    const SentPieces sent = send_all_of(drive);
    const std::size_t tree = octree_bytes(fine_blocks(drive.grid), 2);
    const std::size_t air = sent.bytes + sent.pieces * kHeaders;
    const double ratio = static_cast<double>(air) / static_cast<double>(on_air(tree));
    fmt::print("| {} | {} | {} | {} | {} | {:.2f} | {} |\n", drive.world, sent.pieces, sent.bytes, air, tree,
               ratio, ratio <= kMissionGoal ? "holds" : "missed");
    std::fflush(stdout);
  }
  return {};
}

}  // namespace adit::bench
