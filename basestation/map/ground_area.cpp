// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/ground_area.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace adit::station {
namespace {

constexpr double kCell = perception::CoarseBlock::kVoxel;

/// A column of the ground in cells of 0.2 m, and when its newest part was received, as
/// ChunkStore::Block::received.
struct Column {
  std::int32_t x{}, y{};
  std::uint32_t received{};
};

/// Adds the columns of which a submap's blocks know anything; submaps without a pose have none.
void add_columns(const ChunkStore::Submap& submap, std::vector<Column>& out) {
  if (!submap.T_map_submap) return;
  for (const auto& [index, block] : submap.blocks) {
    std::uint64_t columns = block.known;
    columns = (columns | columns >> 32 | columns >> 16 | columns >> 48) & 0xffff;
    for (int column = 0; column < 16; ++column) {
      if ((columns >> column & 1) == 0) continue;
      const Eigen::Vector3d centre((index.x * 4 + column % 4 + 0.5) * kCell,
                                   (index.y * 4 + column / 4 + 0.5) * kCell, (index.z * 4 + 2) * kCell);
      const Eigen::Vector3d at = *submap.T_map_submap * centre;
      out.push_back({static_cast<std::int32_t>(std::floor(at.x() / kCell)),
                     static_cast<std::int32_t>(std::floor(at.y() / kCell)), block.received});
    }
  }
}

/// Leaves the newest of equal columns.
void thin(std::vector<Column>& columns) {
  std::sort(columns.begin(), columns.end(), [](const Column& a, const Column& b) {
    return std::tuple(a.x, a.y, b.received) < std::tuple(b.x, b.y, a.received);
  });
  columns.erase(std::unique(columns.begin(), columns.end(),
                            [](const Column& a, const Column& b) { return a.x == b.x && a.y == b.y; }),
                columns.end());
}

}  // namespace

GroundArea ground_area(const ChunkStore& chunks, Time now, const std::string& robot) {
  std::vector<Column> columns;
  std::size_t thinned = 0;
  for (const auto& [name, from] : chunks.robots()) {
    if (!robot.empty() && name != robot) continue;
    for (const auto& [key, submap] : from.submaps) {
      add_columns(submap, columns);
      // Heights of one submap repeat its columns: what is known twice is dropped before it grows.
      if (columns.size() < thinned + 1'000'000) continue;
      thin(columns);
      thinned = columns.size();
    }
  }
  thin(columns);
  if (columns.empty()) return {};
  const auto count = static_cast<double>(columns.size());
  const auto share = [&](const auto& fits) {
    return static_cast<double>(std::ranges::count_if(columns, fits, &Column::received)) / count;
  };
  const auto within = [&, clock = chunks.clock(now)](Duration age) {
    return share([&](std::uint32_t received) { return received != 0 && (clock - received) * 100ms < age; });
  };
  return {.m2 = count * kCell * kCell,
          .within_10s = within(10s),
          .within_1min = within(60s),
          .within_10min = within(600s),
          .unknown = share([](std::uint32_t received) { return received == 0; })};
}

}  // namespace adit::station
