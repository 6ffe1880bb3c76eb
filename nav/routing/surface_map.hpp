// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/geometry/staircase.hpp"
#include "nav/areas/area_set.hpp"
#include "nav/routing/route_params.hpp"
#include "nav/routing/seen_blocks.hpp"
#include "nav/routing/tile.hpp"

namespace adit::nav {

/// A place that was found blocked although the map shows it as free, m.
struct BlockedPlace {
  double x, y, z;
  double radius;  ///< m
  double until;   ///< Expiry time, s.
  int times;      ///< Number of times it was found blocked.
  bool active;    ///< In effect; else only remembered.
};

/// Another robot of the team on the ground. It blocks no cell, because it may move away, but a route through
/// it costs more. Frame of the map, m.
struct TeamPlace {
  Eigen::Vector3d place{0.0, 0.0, 0.0};
  double radius{};  ///< Of the disc that a route may not cross free of charge.
  double cost{};    ///< Of a route across the middle of the disc, beside its length.
};

/// Map of the ground: tiles of 0.1 m cells with several floors at one place. It stores the evidence and a
/// queue of tiles whose part of the graph must be rebuilt. Its size is bounded.
class SurfaceMap {
 public:
  /// `same`: heights at one place that differ by at most this belong to one ground, m. It must exceed the
  /// height error at which a scan may take a return for ground, and be less than the height of a robot.
  SurfaceMap(const RouteParams& params, float same)
      : params_(params), same_(same), blocks_(margin_tiles(params)) {}

  /// Usable unknown space around the known space, tiles.
  static int margin_tiles(const RouteParams& params) {
    return std::max(1, static_cast<int>(params.margin / (kTileSide * kRouteCell)));
  }

  static constexpr std::size_t kMaxStairs = 32;

  /// Source of a ground height: interpolated between returns, measured by a return, given by a map, or the
  /// robot's own position.
  enum class Seen : std::uint8_t { between, measured, given, stood_on };
  /// Records a ray over the ground of a cell. `height`: of the ray above the ground, m; obstacles lower than
  /// the ray stay.
  void see_free(int ix, int iy, float z, float height, Seen seen = Seen::measured);
  /// Records a return at (x, y), `obstacle_height` metres above the ground at z. `sure`: a single one blocks
  /// the cell.
  void see_obstacle(float x, float y, float z, float obstacle_height, bool sure = false);
  /// Starts a scan at this position. If there are too many tiles, the farthest ones are dropped.
  void begin_scan(double x, double y);

  /// Blocks a place for RouteParams::block_time regardless of the scans, and longer if it was blocked before.
  void block(const Eigen::Vector3d& place, double now);
  /// Takes the last block back, as if it had not been.
  void unblock_last();
  /// Ends expired blocks.
  void expire(double now);
  /// Ends all blocks; a place that is blocked again is so for longer.
  void unblock() { expire(std::numeric_limits<double>::infinity()); }
  bool has_blocked_places() const;
  const std::vector<BlockedPlace>& blocked_places() const { return places_; }

  /// The other robots of the team; searches and lines charge for crossing them.
  void set_team(std::vector<TeamPlace> team) { team_ = std::move(team); }
  bool has_team() const { return !team_.empty(); }
  /// What a straight line costs for crossing them, beside its length, m.
  double team_cost(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
  /// Forgets the obstacles at a place: what was seen there was a robot.
  void clear_obstacle(const Eigen::Vector3d& place);
  /// Sets the areas that no route leaves or enters, in the frame of the poses. Only tiles whose forbidden
  /// ground may change are rebuilt, so equal areas cost nothing.
  void set_areas(const AreaSet& areas);
  const AreaSet& areas() const { return areas_; }
  /// Sets the staircases that are known, at most kMaxStairs, in the frame of the poses. Their steps become
  /// known ground where no scan from near shows any; TileBuilder decides who may cross them. The ground of
  /// one that moved or is not known any more is forgotten.
  void set_stairs(std::span<const Staircase> stairs);
  const std::vector<Staircase>& stairs() const { return stairs_; }

  /// First tile at tile coordinates, or -1; the other floors follow by Tile::next.
  int first(int tx, int ty) const;
  /// The tile of the floor nearest to z within reach, or -1.
  int at(int tx, int ty, double z) const;
  /// The tile of a cell whose ground is nearest to z within reach; if no tile knows the ground there, as
  /// at().
  int at_cell(int ix, int iy, double z) const;
  /// The ground cell in the tile of at_cell(); null if there is no tile.
  const GroundCell* cell(int ix, int iy, double z) const {
    const int index = at_cell(ix, iy, z);
    return index < 0 ? nullptr : &tile(index).cells[cell_in_tile(ix, iy)];
  }
  /// Calls `visit(place)` for each obstacle at the height of `at`, up to `reach` away along x and y, m.
  template <class Visit>
  void visit_obstacles(const Eigen::Vector3d& at, double reach, Visit&& visit) const {
    const int cells = static_cast<int>(reach / kRouteCell) + 1;
    const int cx = route_cell(at.x()), cy = route_cell(at.y());
    for (int iy = cy - cells; iy <= cy + cells; ++iy)
      for (int ix = cx - cells; ix <= cx + cells; ++ix)
        if (const GroundCell* found = cell(ix, iy, at.z()); found && found->blocked)
          visit(obstacle_place(ix, iy, *found));
  }
  /// The neighbouring tile at (dx, dy) that continues this tile's floor, or -1.
  int beside(const Tile& tile, int dx, int dy) const;
  const Tile& tile(int index) const { return *tiles_[index]; }
  Tile& tile(int index) { return *tiles_[index]; }
  int size() const { return static_cast<int>(tiles_.size()); }
  int used() const { return used_; }
  /// The next tile that needs a rebuild, or -1.
  int next_dirty();

  /// Bounding box of the tiles in use, in tiles.
  struct Extent {
    int x0{0}, x1{-1}, y0{0}, y1{-1};
    bool empty() const { return x1 < x0; }
    void add(int tx, int ty) {
      *this = empty() ? Extent{tx, tx, ty, ty}
                      : Extent{std::min(x0, tx), std::max(x1, tx), std::min(y0, ty), std::max(y1, ty)};
    }
  };
  const Extent& extent() const { return extent_; }
  /// Whether a place has a tile or is at most margin_tiles() from one, or up to 7 more.
  bool near_seen(int tx, int ty) const { return blocks_.near(tx, ty); }
  /// Raises everything by so much, m: the odometry drifted.
  void raise(float by);
  /// Forgets everything.
  void clear();

 private:
  int surface_layer(int ix, int iy, float z);
  int create(int tx, int ty, float z);
  void link(int index);
  void evict();
  void remove_place(int head);
  /// Horizontal distance of a cell from the robot, m.
  double range_of(int ix, int iy) const;
  bool is_near(int ix, int iy) const;
  /// Updates the height of a cell by one that was measured from `range`, m. Returns whether it became sure or
  /// measured.
  static bool update_height(GroundCell& cell, float z, float range, bool measured);
  void mark_dirty(int index);
  /// Marks the other tiles that a cell is near to, and its own if it has doubts. `doubtful_only`: only tiles
  /// with doubts.
  void mark_around(const Tile& tile, int ix, int iy, bool doubtful_only = false);
  void mark_place(const BlockedPlace& place);
  void mark_stairs(const Staircase& stairs);
  void lay_stairs(const Staircase& stairs);
  void remove_stairs(const Staircase& stairs);

  RouteParams params_;
  float same_;
  std::vector<std::unique_ptr<Tile>> tiles_{};
  std::vector<int> free_{};
  std::unordered_map<std::uint64_t, int> heads_{};  // Looked up only, never iterated.
  std::deque<int> queue_{};
  std::vector<BlockedPlace> places_{};
  std::vector<TeamPlace> team_{};
  AreaSet areas_{};
  std::vector<Staircase> stairs_{};
  Extent extent_{};
  SeenBlocks blocks_;
  int used_{0};
  std::uint16_t scan_{0};
  double x_{0}, y_{0};
  int last_{-1};        // The last tile that was written.
  int last_first_{-1};  // The first tile at its place.
};

}  // namespace adit::nav
