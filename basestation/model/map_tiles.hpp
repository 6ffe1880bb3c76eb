// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace adit::station {

/// Occupied voxels on top of each other.
struct VoxelRun {
  std::uint16_t cell{};    ///< Of its tile: column + kSide x row.
  std::int16_t z{};        ///< Index of the lowest voxel: it begins at z r, r: resolution.
  std::uint16_t length{};  ///< Voxels, at least 1.
  bool operator==(const VoxelRun&) const = default;
};

/// A square of the map seen from above.
struct MapTile {
  static constexpr int kSide = 128;               ///< Cells.
  static constexpr std::size_t kMaxRuns = 32768;  ///< Two for each column.
  /// Content of a cell; from kThing on the height of the tallest thing in its column: n - 1 voxels.
  static constexpr std::uint8_t kUnknown = 0, kGround = 1, kThing = 2;
  static constexpr int kRegion = 8;                 ///< Cells along a region, of which one age is known.
  static constexpr int kRegions = kSide / kRegion;  ///< Regions along a tile.

  int x{}, y{};
  std::uint64_t revision{};
  std::vector<std::uint8_t> cells{};  ///< kSide x kSide, row by row from low y.
  std::vector<VoxelRun> runs{};       ///< All that is occupied, by rising cell and z; at most kMaxRuns.
  /// When the station received the newest part of each region, s of MapUpdate::clock, row by row from low y;
  /// 0: unknown, as it was on the disk. Empty: all are unknown.
  std::vector<std::uint32_t> received{};
};

/// The map of all robots seen from above. Tile (x, y) covers [x kSide r, (x + 1) kSide r) along x of the map
/// frame, r: resolution; y alike.
struct TileMap {
  double resolution{0.2};    ///< Edge of a cell, m.
  std::uint64_t revision{};  ///< The highest of the tiles.
  std::uint32_t clock{};     ///< As MapUpdate::clock, when the last update was made.
  std::map<std::pair<int, int>, std::shared_ptr<const MapTile>> tiles{};
};

/// A place that an operator looks at, map frame, m.
struct LookedAt {
  static constexpr double kMaxRadius = 100.0;
  double x{}, y{};
  double radius{};  ///< (0, kMaxRadius].
  bool operator==(const LookedAt&) const = default;
};
/// Whether all of it is finite and within its bounds.
bool valid(const LookedAt& place);

/// The tiles that changed after a revision.
struct MapUpdate {
  double resolution{0.2};
  std::uint64_t revision{};  ///< All changes up to this one are in.
  std::uint32_t clock{};     ///< The station's time, s, from 1; 0: unknown.
  std::uint64_t run{};       ///< Changes when a station starts again: revisions of another run mean nothing.
  std::vector<MapTile> tiles{};
};

/// Age of the map around a cell of a tile at the time of the last update, s; nothing: unknown.
std::optional<double> age_at(const TileMap& map, const MapTile& tile, int column, int row);

/// The map with an update put in; tiles that did not change are shared.
TileMap updated(const TileMap& map, MapUpdate update);

}  // namespace adit::station
