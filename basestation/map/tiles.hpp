// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "basestation/map/merged_map.hpp"
#include "basestation/map/top_view.hpp"
#include "basestation/model/map_tiles.hpp"

namespace adit::station {

/// The tiles of an image in which anything is known, without revisions.
std::vector<MapTile> tiles_of(const perception::VoxelImage& image);

/// The time of the tiles (MapUpdate::clock) from that of blocks (ChunkStore::clock).
constexpr std::uint32_t tile_clock(std::uint32_t tenths) { return tenths == 0 ? 0 : tenths / 10 + 1; }
/// Writes into tiles when the newest part of each region was received.
void add_received(std::vector<MapTile>& tiles, const std::vector<MapPart>& parts, double resolution);

/// The map seen from above as front ends receive it: in tiles, each with the revision of its last change.
class Tiles {
 public:
  static constexpr std::size_t kMaxTiles = 4096;  ///< 64 MB and what is occupied; further tiles are left out.

  /// Takes a newer view. A tile that the view does not have any more becomes unknown.
  void show(double resolution, std::vector<MapTile> tiles);
  /// The oldest changes after that revision, at most `most` tiles. `MapUpdate::run` is left 0.
  MapUpdate since(std::uint64_t revision, std::size_t most) const;
  std::uint64_t revision() const { return revision_; }

 private:
  double resolution_{0.2};
  std::uint64_t revision_{};
  std::map<std::pair<int, int>, MapTile> tiles_{};
};

}  // namespace adit::station
