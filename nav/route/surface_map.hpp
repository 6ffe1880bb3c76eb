// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <unordered_map>
#include <vector>

#include "nav/route/route_params.hpp"
#include "nav/route/tile.hpp"

namespace adit::nav {

/// A place that was found blocked though it looked free.
struct BlockedPlace {
  double x, y, z;  ///< m
  double radius;   ///< m
  double until;    ///< s
  int times;       ///< that it was found so
  bool active;     ///< counts; else only remembered
};

/// What is known of the ground: tiles of 0.1 m cells, several floors at one place. Keeps the evidence and a
/// queue of tiles whose part of the graph is to be made anew; of bounded size.
class SurfaceMap {
 public:
  /// `same`: heights at one place that differ by no more are one ground, m. It must be more than what a scan
  /// can take for ground too high by, and less than the height of a robot.
  SurfaceMap(const RouteParams& params, float same) : params_(params), same_(same) {}

  /// How the height of the ground is known: drawn between two returns, by a return, from a map, or by the
  /// robot's feet.
  enum class Seen : std::uint8_t { between, measured, told, stood_on };
  /// A ray passed over the ground of a cell. `height` of the ray above the ground, m: what is lower than it
  /// may still be there.
  void see_free(int ix, int iy, float z, float height, Seen seen = Seen::measured);
  /// A return at (x, y), `top` metres above the ground at z; `sure`: one is enough.
  void see_obstacle(float x, float y, float z, float top, bool sure = false);
  /// Begins a scan from there; the tiles farthest from it go when there are too many.
  void begin_scan(double x, double y);

  /// Counts as blocked for a while, and longer when it was found so before.
  void block(double x, double y, double z, double now);
  /// Ends what has counted long enough.
  void expire(double now);
  const std::vector<BlockedPlace>& blocked_places() const { return places_; }

  /// First tile at a place of tiles, or -1; others by Tile::next.
  int first(int tx, int ty) const;
  /// The tile of the floor nearest to z there, within reach; or -1.
  int at(int tx, int ty, double z) const;
  /// The same of a cell: the tile whose ground there is nearest to z, within reach; where none knows the
  /// ground, as at().
  int at_cell(int ix, int iy, double z) const;
  /// The ground of a cell by the tile of at_cell(); null where there is no tile.
  const GroundCell* cell(int ix, int iy, double z) const {
    const int index = at_cell(ix, iy, z);
    return index < 0 ? nullptr : &tile(index).cells[static_cast<std::size_t>(cell_in_tile(ix, iy))];
  }
  /// The tile beside one, (dx, dy) tiles away, that its ground goes on into; or -1.
  int beside(const Tile& tile, int dx, int dy) const;
  const Tile& tile(int index) const { return *tiles_[static_cast<std::size_t>(index)]; }
  Tile& tile(int index) { return *tiles_[static_cast<std::size_t>(index)]; }
  int size() const { return static_cast<int>(tiles_.size()); }
  int used() const { return used_; }
  /// Next tile to be made anew, or -1.
  int next_dirty();
  std::size_t dirty() const { return queue_.size(); }

  /// Corners of all that is known, in tiles.
  struct Extent {
    int x0{0}, x1{-1}, y0{0}, y1{-1};
    float z0{0}, z1{0};
    bool empty() const { return x1 < x0; }
  };
  const Extent& extent() const { return extent_; }
  /// Changes with every change of what is passable.
  void clear();
  /// Becomes a copy of another one's ground, all of it to be built anew.
  void copy(const SurfaceMap& other);

 private:
  static std::uint64_t key(int tx, int ty) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(tx)) << 32) |
           static_cast<std::uint32_t>(ty);
  }
  int sheet(int ix, int iy, float z);
  int create(int tx, int ty, float z);
  void link(int index);
  void evict();
  bool is_near(int ix, int iy) const;
  void mark_dirty(int index);
  void mark_around(const Tile& tile, int ix, int iy);
  void mark_place(const BlockedPlace& place);

  RouteParams params_;
  float same_;
  std::vector<std::unique_ptr<Tile>> tiles_{};
  std::vector<int> free_{};
  std::unordered_map<std::uint64_t, int> heads_{};  // looked up only
  std::deque<int> queue_{};
  std::vector<BlockedPlace> places_{};
  Extent extent_{};
  int used_{0};
  std::uint16_t scan_{0};
  double x_{0}, y_{0};
  int last_{-1};        // tile that was written last
  int last_first_{-1};  // first one at its place
};

}  // namespace adit::nav
