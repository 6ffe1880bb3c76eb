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
inline constexpr int kTileHalo = 8;         ///< clearance is known up to this many cells
inline constexpr int kTileNodes = 16;       ///< at most; the widest openings of a side are kept
inline constexpr float kSheetReach = 1.5f;  ///< ground higher or lower than this is of another floor, m
inline constexpr float kUnreached = std::numeric_limits<float>::infinity();

/// One column of one floor.
struct GroundCell {
  float z{0};               ///< of the ground, m
  std::int8_t evidence{0};  ///< of an obstacle; rises with each hit, falls with each ray through it
  std::uint8_t top{0};      ///< of the obstacle above the ground, kTopUnit
  bool known : 1 {false};
  bool measured : 1 {false};  ///< its height; else that was drawn between the returns around it
  bool blocked : 1 {false};
  bool sure : 1 {false};               ///< was seen from near
  std::int8_t aside_x{0}, aside_y{0};  ///< where in the cell the obstacle is: from its middle, kAsideUnit
  std::uint16_t scan{0};               ///< the last one that hit it
};
inline constexpr float kTopUnit = 0.02f;                                   ///< m
inline constexpr float kAsideUnit = static_cast<float>(kRouteCell) / 250;  ///< m

/// The sides of a tile: +x, +y, -x, -y.
inline constexpr std::array<int, 4> kSideX{1, 0, -1, 0};
inline constexpr std::array<int, 4> kSideY{0, 1, 0, -1};
/// Index of the cell at place `i` along a side.
inline constexpr int side_cell(int side, int i) {
  constexpr int last = kTileSide - 1;
  switch (side) {
    case 0:
      return i * kTileSide + last;
    case 1:
      return last * kTileSide + i;
    case 2:
      return i * kTileSide;
    default:
      return i;
  }
}

/// An opening in a side of a tile: a run of passable cells. A node of the graph.
struct TileNode {
  std::uint8_t side{0}, first{0}, last{0};
  std::uint8_t cell{0};    ///< the one in its middle
  float x{0}, y{0}, z{0};  ///< of that, m
};

/// A square piece of one floor, with the part of the graph that lies in it. Several floors at one place are
/// several tiles, linked by `next`.
struct Tile {
  int tx{0}, ty{0};
  float z{0};                                                 ///< of the ground when it was first seen, m
  int next{-1};                                               ///< the tile of another floor at this place
  std::array<int, 8> beside{-1, -1, -1, -1, -1, -1, -1, -1};  ///< first tiles of the places around
  bool used{false}, dirty{false};
  bool built{false};  ///< costs and nodes were worked out
  std::array<GroundCell, kTileArea> cells{};
  std::array<std::uint8_t, kTileArea> cost{};  ///< of a cell, 1/16 per length; 0: not passable
  int node_count{0};
  std::array<TileNode, kTileNodes> nodes{};
  std::uint16_t measured{0};  ///< the nodes, as bits, whose distances are known
  std::array<float, kTileNodes * kTileNodes>
      distance{};  ///< from such a node to the others, within the tile, m

  double cell_x(int c) const { return (tx * kTileSide + c % kTileSide + 0.5) * kRouteCell; }
  double cell_y(int c) const { return (ty * kTileSide + c / kTileSide + 0.5) * kRouteCell; }
  float cell_z(int c) const {
    const GroundCell& cell = cells[static_cast<std::size_t>(c)];
    return cell.known ? cell.z : z;
  }
};

/// Where the obstacle in a blocked cell stands, m.
inline Eigen::Vector2d obstacle_place(int ix, int iy, const GroundCell& cell) {
  return {(ix + 0.5) * kRouteCell + cell.aside_x * double{kAsideUnit},
          (iy + 0.5) * kRouteCell + cell.aside_y * double{kAsideUnit}};
}

inline int route_cell(double v) { return static_cast<int>(std::floor(v / kRouteCell)); }
/// Of a cell, the tile it is in and its index there.
inline int tile_of(int cell) { return cell >> 4; }
inline int cell_in_tile(int ix, int iy) { return (iy & 15) * kTileSide + (ix & 15); }

}  // namespace adit::nav
