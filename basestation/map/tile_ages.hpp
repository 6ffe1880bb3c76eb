// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "basestation/map/merged_map.hpp"
#include "basestation/model/map_tiles.hpp"

namespace adit::station {

/// The time of the tiles (MapUpdate::clock) from that of blocks (ChunkStore::clock).
constexpr std::uint32_t tile_clock(std::uint32_t tenths) { return tenths == 0 ? 0 : tenths / 10 + 1; }

/// Writes into tiles when the newest part of each region was received.
void add_received(std::vector<MapTile>& tiles, const std::vector<MapPart>& parts, double resolution);

}  // namespace adit::station
