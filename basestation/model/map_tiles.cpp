// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/map_tiles.hpp"

#include <cmath>

namespace adit::station {

bool valid(const LookedAt& place) {
  return std::isfinite(place.x) && std::isfinite(place.y) && place.radius > 0.0 &&
         place.radius <= LookedAt::kMaxRadius;
}

TileMap updated(const TileMap& map, MapUpdate update) {
  TileMap out = map;
  out.resolution = update.resolution;
  out.revision = update.revision;
  for (MapTile& tile : update.tiles) {
    const std::pair key{tile.x, tile.y};
    out.tiles[key] = std::make_shared<const MapTile>(std::move(tile));
  }
  return out;
}

}  // namespace adit::station
