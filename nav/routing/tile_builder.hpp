// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>

#include "core/config/platform.hpp"
#include "core/config/traversability.hpp"
#include "nav/routing/surface_map.hpp"

namespace adit::nav {

/// Builds a tile's part of the graph: the cost of each cell, the openings in its sides, and the distances
/// between them within the tile (Botea, Müller, Schaeffer: *Near optimal hierarchical path-finding*, 2004).
/// Unlike there, each tile has its own openings, so a single tile can be rebuilt.
///
/// From afar the error of the attitude makes steps where there are none: steps and low obstacles that were
/// only seen from there do not block, but cost RouteParams::doubtful_cost, until they are seen from near.
///
/// A staircase that is known (SurfaceMap::stairs()) is ground for a body that climbs it, as its steps are and
/// whatever its risers looked like, and cheapest along its axis. It is closed for other bodies.
class TileBuilder {
 public:
  TileBuilder(const Platform& platform, const RouteParams& params);

  /// Whether a cell holds an obstacle for certain.
  static bool solid(const GroundCell& cell) {
    return cell.blocked && (cell.sure || cell.obstacle_height > kTall);
  }
  /// Maximum height difference between two neighbouring cells, m: a larger one is a step.
  float most_rise(const GroundCell& a, const GroundCell& b) const {
    if (!said(a) || !said(b)) return kFloorSeparation;
    return a.sure && b.sure ? rise_ : doubtful_rise_;
  }

  /// Computes the cells' costs and the openings from the map. The distances between openings are computed on
  /// demand.
  void build(SurfaceMap& map, int index);
  /// The tile, rebuilt first if it is not up to date.
  const Tile& current(SurfaceMap& map, int index) {
    if (map.tile(index).dirty) build(map, index);
    return map.tile(index);
  }
  /// Computes all distances between a tile's openings.
  void connect(SurfaceMap& map, int index);
  /// Distances from one node of a tile to all of its nodes within the tile, m.
  std::span<const float, kTileNodes> distances(SurfaceMap& map, int index, int node);
  /// Computes the distances from a cell to all others of its tile, m; see distance() and before().
  /// `to_nodes`: stops when the tile's nodes are reached.
  void spread(const Tile& tile, int cell, bool to_nodes = false);
  float distance(int cell) const { return distance_[cell]; }
  /// The preceding cell on the path from the cell of spread(); -1 at that cell.
  int before(int cell) const { return before_[cell]; }
  /// Cost of unknown space far from obstacles, per metre.
  float unknown_cost() const { return unknown_cost_; }

 private:
  /// In kObstacleHeightUnit: higher obstacles are walls or edges, also when seen from afar.
  static constexpr std::uint8_t kTall = 18;
  /// Whether a height proves anything: interpolated heights seen from afar do not.
  static bool said(const GroundCell& cell) {
    return cell.known && !cell.guessed() && (cell.sure || cell.measured);
  }
  static constexpr int kWindow = kTileWindow;
  static std::size_t in_window(int x, int y) { return static_cast<std::size_t>(y * kWindow + x); }
  void gather(const SurfaceMap& map, const Tile& tile);
  void gather_tile(const Tile& from, float z, int ox, int oy);
  /// Marks the forbidden cells of a square of the window, whose side is a power of two.
  void forbid(const AreaSet& areas, const Tile& tile, int x0, int y0, int side);
  void lay_stairs(const Staircase& stairs, const Tile& tile);
  void price_aside(const Staircase& stairs, Tile& tile) const;
  bool is_foot(std::size_t cell) const;
  void find_steps();
  void find_steep(std::size_t from, std::size_t stride, int cells);
  /// Whether the ground between two cells is too steep if their heights are right.
  bool seems_steep(std::size_t from, std::size_t stride, int cells) const;
  void measure(Tile& tile);
  /// Cost of a cell that holds a doubtful obstacle.
  std::uint8_t price_of(const GroundCell& cell) const;
  /// Raises the costs of the cells that are near to what is only doubtful.
  void price_doubts(Tile& tile) const;
  std::uint8_t cost_at(double distance) const;
  double exact_clearance(int x, int y) const;
  void open_sides(Tile& tile);
  void add_node(Tile& tile, int side, int first, int last);
  void connect(Tile& tile, int node);
  /// Packs a distance and a cell into one number that sorts in the same order.
  static std::uint64_t entry(float distance, int cell);

  Platform platform_;
  Traversability limits_;
  double hard_, comfort_, narrow_cost_;  // Required and preferred clearance, m.
  float rise_, doubtful_rise_, unknown_cost_;
  bool through_unknown_;
  std::uint8_t doubtful_cost_, hole_cost_;                         // Per length, as Tile::cost.
  std::array<std::uint8_t, kTileHalo * kTileHalo + 2> cost_of_{};  // By squared clearance in cells.
  // NaN: unknown. `seen_height_` has those, too, that prove nothing.
  std::array<float, kWindow * kWindow> height_{}, seen_height_{};
  std::array<bool, kWindow * kWindow> known_{}, sure_{}, has_obstacle_{}, solid_{}, tall_{};
  std::array<std::uint8_t, kWindow * kWindow> doubtful_{};  // Cost of what only seems to block; 0: nothing.
  bool all_sure_{true};                                     // All known cells of the window are.
  std::array<std::array<std::int8_t, 2>, kWindow * kWindow> aside_{};  // Position of obstacles, kAsideUnit.
  std::array<float, kTileArea> distance_{};
  std::array<int, kTileArea> before_{};
  std::vector<std::uint64_t> heap_{};  // Of entries.
};

}  // namespace adit::nav
