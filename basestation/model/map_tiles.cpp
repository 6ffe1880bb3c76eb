// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/map_tiles.hpp"

#include <cmath>

namespace adit::station {

bool valid(const LookedAt& place) {
  return std::isfinite(place.x) && std::isfinite(place.y) && place.radius > 0.0 &&
         place.radius <= LookedAt::kMaxRadius;
}

std::optional<double> age_at(const TileMap& map, const MapTile& tile, int column, int row) {
  const auto region =
      static_cast<std::size_t>(row / MapTile::kRegion * MapTile::kRegions + column / MapTile::kRegion);
  if (region >= tile.received.size() || tile.received[region] == 0 || tile.received[region] > map.clock)
    return std::nullopt;
  return static_cast<double>(map.clock - tile.received[region]);
}

TileMap updated(const TileMap& map, MapUpdate update) {
  TileMap out = map;
  out.resolution = update.resolution;
  out.revision = update.revision;
  out.clock = update.clock;
  for (MapTile& tile : update.tiles) {
    const std::pair key{tile.x, tile.y};
    out.tiles[key] = std::make_shared<const MapTile>(std::move(tile));
  }
  return out;
}

}  // namespace adit::station
