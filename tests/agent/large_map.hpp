// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "core/time/random.hpp"
#include "robot_agent/perception/map_disk.hpp"

namespace adit::agent {

/// Blocks of a floor with walls, some of them frayed as scans leave them. They fill a square of blocks from
/// (0, 0), in the order of their indices.
inline std::vector<perception::BlockUpdate> many_blocks(std::size_t first, std::size_t count) {
  constexpr std::size_t kSide = 440;
  std::vector<perception::BlockUpdate> blocks;
  Random random(first + 1);
  for (std::size_t i = first; i < first + count; ++i) {
    perception::BlockUpdate update{};
    update.block.index = {static_cast<std::int32_t>(i / kSide), static_cast<std::int32_t>(i % kSide), 0};
    const bool wall = i % 13 == 0 || i / kSide % 11 == 0;
    update.block.occupied = wall ? 0x1111111111111111ULL : 0xFFFFULL;
    update.block.known = random.below(4) == 0 ? ~(random.next() & random.next()) : ~0ULL;
    update.block.occupied &= update.block.known;
    update.revision = static_cast<std::uint32_t>(i + 1);
    blocks.push_back(update);
  }
  return blocks;
}

/// A disk with a stored map of so many blocks in several submaps.
inline std::shared_ptr<store::MemoryDisk> disk_with_map(const std::string& robot, std::size_t count) {
  constexpr std::size_t kInSubmap = 20'000;
  auto disk = std::make_shared<store::MemoryDisk>();
  VirtualScheduler scheduler{1};
  const auto machine = scheduler.machine("writer", {});
  const auto strand = machine->strand("command");
  MapDisk files({.robot = robot}, disk, *strand, nullptr, [](bool, const std::string&) {});
  (void)files.load();
  perception::StoredPlaces places;
  for (std::size_t first = 0; first < count; first += kInSubmap) {
    perception::StoredSubmap submap{};
    submap.key = {robot, std::uint64_t{1} << 48U, static_cast<std::uint32_t>(first / kInSubmap)};
    submap.placed = true;
    submap.pose_revision = 1;
    submap.blocks = many_blocks(first, std::min(kInSubmap, count - first));
    places.poses.push_back({submap.key, {}, 1});
    files.save(std::move(submap));
    scheduler.run_until(scheduler.elapsed() + std::chrono::seconds(1));
  }
  files.save(std::move(places));
  scheduler.run_until(scheduler.elapsed() + std::chrono::seconds(1));
  return disk;
}

}  // namespace adit::agent
