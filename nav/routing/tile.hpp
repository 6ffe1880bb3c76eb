// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace adit::nav {

inline constexpr double kRouteCell = 0.1;  ///< m
inline constexpr float kRouteCellF = static_cast<float>(kRouteCell);
inline constexpr int kTileSide = 16;  ///< cells
inline constexpr int kTileArea = kTileSide * kTileSide;
inline constexpr int kTileHalo = 8;  ///< Clearance is computed up to this many cells.
/// Side of the window of cells that a tile's costs are computed from, cells.
inline constexpr int kTileWindow = kTileSide + 2 * kTileHalo;
inline constexpr int kTileNodes = 16;  ///< Maximum number; the widest openings of a side remain.
/// Height difference from which ground belongs to another floor, m.
inline constexpr float kFloorSeparation = 1.5f;
inline constexpr float kUnreached = std::numeric_limits<float>::infinity();

/// One cell of one floor.
struct GroundCell {
  float z{0};                       ///< Height of the ground, m.
  std::int8_t evidence{0};          ///< Of an obstacle; rises with each hit, falls with each ray through it.
  std::uint8_t obstacle_height{0};  ///< Height of the obstacle above the ground, kObstacleHeightUnit.
  bool known : 1 {false};
  bool measured : 1 {false};  ///< The height was measured; else interpolated between returns.
  bool blocked : 1 {false};
  bool sure : 1 {false};  ///< Height or obstacle was seen from near, which proves a step.
  /// The height is that of a known staircase: it goes with it, and no scan from near measured it.
  bool of_stairs : 1 {false};
  /// How exactly the height was measured: as by one scan from so far away, kRangeUnit; kNoRange: not at all.
  std::uint8_t range{kNoRange};
  /// Position of the obstacle relative to the cell's centre, kAsideUnit.
  std::int8_t aside_x{0}, aside_y{0};
  std::uint16_t scan{0};  ///< The last scan with a return from the obstacle.

  static constexpr std::uint8_t kNoRange = 255;
  /// The height is that of the ground before an obstacle, of which this cell had a return.
  bool guessed() const { return known && !of_stairs && range == kNoRange; }
};
inline constexpr float kObstacleHeightUnit = 0.02f;  ///< m
/// Obstacle height at the edge of missing ground, kObstacleHeightUnit; the depth is unknown.
inline constexpr std::uint8_t kHoleHeight = 1;
inline constexpr float kRangeUnit = 0.1f;                                  ///< m
inline constexpr float kAsideUnit = static_cast<float>(kRouteCell) / 250;  ///< m

/// The sides of a tile: +x, +y, -x, -y.
inline constexpr std::array<int, 4> kSideX{1, 0, -1, 0};
inline constexpr std::array<int, 4> kSideY{0, 1, 0, -1};
/// Index of the cell at position `i` along a side.
constexpr int side_cell(int side, int i) {
  constexpr int kLast = kTileSide - 1;
  constexpr std::array kFirst{kLast, kLast * kTileSide, 0, 0};
  return kFirst[side] + i * (side % 2 == 0 ? kTileSide : 1);
}

/// A node of the graph: a run of passable cells on a side of a tile.
struct TileNode {
  std::uint8_t side{0}, first{0}, last{0};
  std::uint8_t cell{0};    ///< The cell in its middle.
  float x{0}, y{0}, z{0};  ///< Position of that cell, m.
};

/// A square piece of one floor with its part of the graph. Several floors at one place are several tiles,
/// linked by `next`.
struct Tile {
  int tx{0}, ty{0};
  float z{0};    ///< Height of the ground when it was first seen, m.
  int next{-1};  ///< The tile of another floor at this place.
  std::array<int, 8> beside{-1, -1, -1, -1, -1, -1, -1, -1};  ///< First tiles of the neighbouring places.
  bool used{false}, dirty{false};
  bool built{false};       ///< Costs and nodes are computed.
  bool has_doubts{false};  ///< Heights that are not sure raised some of the costs.
  std::array<GroundCell, kTileArea> cells{};
  std::array<std::uint8_t, kTileArea> cost{};  ///< Of each cell, 1/16 per length; 0: impassable.
  int node_count{0};
  std::array<TileNode, kTileNodes> nodes{};
  std::uint16_t measured{0};  ///< Bit set of the nodes with known distances.
  /// Distances from each such node to the others within the tile, m.
  std::array<float, kTileNodes * kTileNodes> distance{};

  double cell_x(int c) const { return (tx * kTileSide + c % kTileSide + 0.5) * kRouteCell; }
  double cell_y(int c) const { return (ty * kTileSide + c / kTileSide + 0.5) * kRouteCell; }
  float cell_z(int c) const {
    const GroundCell& cell = cells[c];
    return cell.known ? cell.z : z;
  }
};

/// Packs two coordinates into one key, for a hash table.
constexpr std::uint64_t grid_key(int x, int y) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) | static_cast<std::uint32_t>(y);
}

/// Position of the obstacle in a blocked cell, m.
inline Eigen::Vector2d obstacle_place(int ix, int iy, const GroundCell& cell) {
  return {(ix + 0.5) * kRouteCell + cell.aside_x * double{kAsideUnit},
          (iy + 0.5) * kRouteCell + cell.aside_y * double{kAsideUnit}};
}

inline int route_cell(double v) { return static_cast<int>(std::floor(v / kRouteCell)); }
/// Coordinate of the tile that contains a cell, and the cell's index in its tile.
inline int tile_of(int cell) { return cell >> 4; }
inline int cell_in_tile(int ix, int iy) { return (iy & 15) * kTileSide + (ix & 15); }

}  // namespace adit::nav
