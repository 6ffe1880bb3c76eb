// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/area_ages.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

#include "basestation/map/ground_columns.hpp"

namespace adit::station {
namespace {

/// A column of the ground, and when its newest part was received, as ChunkStore::Block::received.
struct Column {
  std::int32_t x{}, y{};
  std::uint32_t received{};
};

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

AreaAges area_ages(const ChunkStore& chunks, Time now) {
  std::vector<Column> columns;
  std::size_t thinned = 0;
  for (const auto& [name, robot] : chunks.robots())
    for (const auto& [key, submap] : robot.submaps) {
      for_each_column(submap, [&columns](std::int32_t x, std::int32_t y, const ChunkStore::Block& block) {
        columns.push_back({x, y, block.received});
      });
      if (columns.size() < thinned + 1'000'000) continue;
      thin(columns);
      thinned = columns.size();
    }
  thin(columns);
  AreaAges out;
  if (columns.empty()) return out;
  const auto share = [&](Duration age) {
    const std::uint32_t clock = chunks.clock(now);
    return static_cast<double>(std::count_if(columns.begin(), columns.end(),
                                             [&](const Column& column) {
                                               return column.received != 0 &&
                                                      (clock - column.received) * 100ms < age;
                                             })) /
           static_cast<double>(columns.size());
  };
  out.within_10s = share(10s);
  out.within_1min = share(60s);
  out.within_10min = share(600s);
  out.unknown =
      static_cast<double>(std::count_if(columns.begin(), columns.end(),
                                        [](const Column& column) { return column.received == 0; })) /
      static_cast<double>(columns.size());
  return out;
}

}  // namespace adit::station
