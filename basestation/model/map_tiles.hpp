// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace adit::station {

/// A square of the map seen from above.
struct MapTile {
  static constexpr int kSide = 128;  ///< Cells.
  /// Content of a cell; from kThing on the height of the tallest thing in its column: n - 1 voxels.
  static constexpr std::uint8_t kUnknown = 0, kGround = 1, kThing = 2;

  int x{}, y{};
  std::uint64_t revision{};
  std::vector<std::uint8_t> cells{};  ///< kSide x kSide, row by row from low y.
};

/// The map of all robots seen from above. Tile (x, y) covers [x kSide r, (x + 1) kSide r) along x of the map
/// frame, r: resolution; y alike.
struct TileMap {
  double resolution{0.2};    ///< Edge of a cell, m.
  std::uint64_t revision{};  ///< The highest of the tiles.
  std::map<std::pair<int, int>, std::shared_ptr<const MapTile>> tiles{};
};

/// What changed of the map after a revision.
struct MapUpdate {
  double resolution{0.2};
  std::uint64_t revision{};  ///< All changes up to this one are in.
  std::uint64_t run{};       ///< Changes when a station starts again: revisions of another run mean nothing.
  std::vector<MapTile> tiles{};
};

/// The map with an update put in; tiles that did not change are shared.
TileMap updated(const TileMap& map, MapUpdate update);

}  // namespace adit::station
