// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>

#include "core/config/platform.hpp"
#include "core/config/traversability.hpp"
#include "nav/route/surface_map.hpp"

namespace adit::nav {

/// Makes a tile's part of the graph: what each cell costs, the openings in its sides, and how far they are
/// from each other within it (Botea, Müller, Schaeffer: *Near optimal hierarchical path-finding*, 2004, with
/// openings of its own for each tile, so that one tile can be made anew alone).
class TileBuilder {
 public:
  /// `doubting`: see RouteGraph.
  TileBuilder(const Platform& platform, const RouteParams& params, bool doubting = false);

  /// Whether something stands in a cell.
  bool solid(const GroundCell& cell) const { return cell.blocked && (certain(cell) || cell.top > kTall); }
  /// From one of two neighbouring cells to the other: what is higher is a step, m.
  float most_rise(const GroundCell& a, const GroundCell& b) const {
    if (!said(a) || !said(b)) return kSheetReach;
    return certain(a) && certain(b) ? rise_ : doubtful_rise_;
  }

  /// From the map's evidence: cells and openings; the ways between these are measured when they are asked
  /// for.
  void build(SurfaceMap& map, int index);
  /// The tile, made anew first when it is not up to date.
  const Tile& current(SurfaceMap& map, int index) {
    if (map.tile(index).dirty) build(map, index);
    return map.tile(index);
  }
  /// Measures all of a tile's ways between openings.
  void connect(SurfaceMap& map, int index);
  /// From one node of a tile to all of its nodes, within it, m.
  std::span<const float, kTileNodes> distances(SurfaceMap& map, int index, int node);
  /// Ways from a cell to all others of its tile, m; see distance() and trace().
  /// `to_nodes`: only as far as the tile's nodes.
  void spread(const Tile& tile, int cell, bool to_nodes = false);
  float distance(int cell) const { return distance_[static_cast<std::size_t>(cell)]; }
  /// The cell before that one on the way from where spread() began; -1 at its beginning.
  int before(int cell) const { return before_[static_cast<std::size_t>(cell)]; }
  /// What a cell in the open costs (unknown: in unknown space), m per m.
  float unknown_cost() const { return unknown_cost_; }

 private:
  TileBuilder(const Platform& platform, const RouteParams& params, const Traversability& limits,
              bool doubting);
  static constexpr std::uint8_t kTall = 18;  ///< kTopUnit each: higher is a wall or an edge, also from afar
  bool certain(const GroundCell& cell) const { return !doubting_ || cell.sure; }
  /// What was only drawn, from afar, says nothing.
  bool said(const GroundCell& cell) const { return cell.known && (certain(cell) || cell.measured); }
  static constexpr int kWindow = kTileSide + 2 * kTileHalo;
  static std::size_t in_window(int x, int y) { return static_cast<std::size_t>(y * kWindow + x); }
  void gather(const SurfaceMap& map, const Tile& tile);
  void gather_tile(const Tile& from, float z, int ox, int oy);
  bool is_foot(std::size_t cell) const;
  void find_steps();
  void find_steep(std::size_t from, std::size_t stride, int cells);
  void measure(Tile& tile);
  std::uint8_t cost_at(double distance) const;
  double exact_clearance(int x, int y) const;
  void open_sides(Tile& tile);
  void add_node(Tile& tile, int side, int first, int last);
  void connect(Tile& tile, int node);
  /// A distance and a cell as one number, which sorts as they do.
  static std::uint64_t entry(float distance, int cell);

  double hard_, comfort_, narrow_cost_;  // clearance that is needed and that is liked, m
  float rise_, doubtful_rise_, unknown_cost_;
  double step_, slope_;
  bool climbs_stairs_, doubting_, through_unknown_;
  std::array<std::uint8_t, kTileHalo * kTileHalo + 2> cost_of_{};  // by squared clearance in cells
  std::array<float, kWindow * kWindow> height_{};                  // NaN: unknown
  std::array<bool, kWindow * kWindow> known_{}, sure_{}, stands_{}, solid_{};
  std::array<std::array<std::int8_t, 2>, kWindow * kWindow> aside_{};  // of what is solid, kAsideUnit
  std::array<float, kTileArea> distance_{};
  std::array<int, kTileArea> before_{};
  std::vector<std::uint64_t> heap_{};  // of entries
};

}  // namespace adit::nav
