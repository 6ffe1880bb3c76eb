// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/tile_ages.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace adit::station {
namespace {

constexpr std::size_t kRegionsInTile = std::size_t{MapTile::kRegions} * MapTile::kRegions;

/// Quotient rounded down.
int tile_of_region(int region) {
  return region >= 0 ? region / MapTile::kRegions : -((-region + MapTile::kRegions - 1) / MapTile::kRegions);
}

}  // namespace

void add_received(std::vector<MapTile>& tiles, const std::vector<MapPart>& parts, double resolution) {
  std::map<std::pair<int, int>, MapTile*> by_place;
  for (MapTile& tile : tiles) by_place[{tile.x, tile.y}] = &tile;
  const double edge = MapTile::kRegion * resolution;
  const auto note = [&](const Eigen::Vector3d& at, std::uint32_t received) {
    const int x = static_cast<int>(std::floor(at.x() / edge)),
              y = static_cast<int>(std::floor(at.y() / edge));
    const auto found = by_place.find({tile_of_region(x), tile_of_region(y)});
    if (found == by_place.end()) return;
    MapTile& tile = *found->second;
    if (tile.received.empty()) tile.received.resize(kRegionsInTile);
    std::uint32_t& newest = tile.received[static_cast<std::size_t>(
        (y - tile.y * MapTile::kRegions) * MapTile::kRegions + x - tile.x * MapTile::kRegions)];
    newest = std::max(newest, tile_clock(received));
  };
  constexpr double kSize = perception::BlockIndex::kSize, kInside = 0.05;  // m
  for (const MapPart& part : parts)
    for (std::size_t i = 0; i < part.blocks.size() && i < part.received.size(); ++i) {
      if (part.received[i] == 0) continue;
      const perception::BlockIndex& index = part.blocks[i].index;
      for (const double x : {kInside, kSize - kInside})
        for (const double y : {kInside, kSize - kInside})
          note(part.T_map_submap *
                   Eigen::Vector3d(index.x * kSize + x, index.y * kSize + y, (index.z + 0.5) * kSize),
               part.received[i]);
    }
}

}  // namespace adit::station
