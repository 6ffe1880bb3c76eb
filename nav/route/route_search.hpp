// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "nav/route/route.hpp"
#include "nav/route/surface_map.hpp"
#include "nav/route/tile_builder.hpp"

namespace adit::nav {

/// A start or goal on the map.
struct RouteEnd {
  Eigen::Vector3d place{0, 0, 0};  ///< m
  int tile{-1};                    ///< -1: in unknown space without a tile
  int cell{0};                     ///< of the tile, passable
  bool any_floor{false};           ///< of an unknown goal: whichever floor leads there first
};

/// A* over the openings of the tiles. Where there is no tile, unknown space is as if there were open ones:
/// on the heights of the start and, through unknown space too, of a goal on another floor.
class RouteSearch {
 public:
  RouteSearch(SurfaceMap& map, TileBuilder& builder, const RouteParams& params);

  /// The way as points of the ground, each leg passable. Tiles that it comes to are brought up to date.
  RouteStatus search(const RouteEnd& start, const RouteEnd& goal, std::vector<Eigen::Vector3d>& points);
  /// Costs from one place to many through known space, m; infinite where no route leads. One search from the
  /// start (Dijkstra), which ends when every goal's cost is certain. `start` and `goals` lie on tiles;
  /// `costs`: one for each goal. Returns false when the map is too large for the search's memory.
  bool costs(const RouteEnd& start, std::span<const RouteEnd> goals, std::span<float> costs);
  /// Nodes that the last search looked at.
  std::size_t expanded() const { return expanded_; }
  /// Of its buffers, bytes.
  std::size_t memory() const;

 private:
  using Id = std::uint32_t;
  struct State {
    float cost{0};
    Id from{0};
    std::uint32_t search{0};
    bool closed{false};
  };
  struct Open {
    float estimate;
    Id id;
    bool operator<(const Open& o) const {
      return estimate > o.estimate || (estimate == o.estimate && id > o.id);
    }
  };
  /// A node beside unknown space: place in tiles, height in levels from the start's, side.
  struct Ghost {
    int tx, ty, level, side;
  };

  /// One of many goals: its tile, its place in the list, and the costs from the tile's nodes, m.
  struct ManyGoal {
    int tile;
    std::size_t index;
    std::array<float, kTileNodes> from_node;
  };

  bool prepare(const RouteEnd& start, const RouteEnd& goal);
  std::vector<ManyGoal> goals_by_tile(std::span<const RouteEnd> goals);
  bool is_ghost(Id id) const { return id >= ghosts_from_; }
  Id ghost_id(const Ghost& g) const;
  Ghost ghost_of(Id id) const;
  bool in_box(int tx, int ty, int level) const;
  float level_z(int level) const { return static_cast<float>(origin_z_ + level * double{kSheetReach}); }
  int level_of(double z) const;
  Eigen::Vector3d place(Id id) const;
  void reach(Id id, float cost, Id from);
  void expand(Id id, float cost);
  void expand_tile(int index, int node, float cost, Id id);
  void expand_ghost(const Ghost& g, float cost, Id id);
  void cross(const Tile& tile, const TileNode& node, float cost, Id id);
  void enter_from_ghost(const Ghost& g, float cost, Id id);
  /// Whether one of a side's cells is of the floor at z.
  bool borders(const Tile& tile, int side, int first, int last, float z) const;
  bool meets(const Tile& a, const TileNode& from, const Tile& b, const TileNode& to) const;
  int meeting_place(const Tile& a, const TileNode& from, const Tile& b, const TileNode& to) const;
  void begin(const RouteEnd& start);
  void write(std::vector<Eigen::Vector3d>& points);
  void write_leg(Id from, Id to, std::vector<Eigen::Vector3d>& points);
  /// `cost`: of the way that was found, m.
  void write_within(int index, int from, int to, float cost, std::vector<Eigen::Vector3d>& points);

  SurfaceMap& map_;
  TileBuilder& builder_;
  RouteParams params_;
  RouteEnd start_{}, goal_{};
  double origin_z_{0};
  int x0_{0}, y0_{0}, level0_{0}, goal_level_{0}, width_{0}, depth_{0}, levels_{0};
  Id ghosts_from_{0}, start_id_{0}, goal_id_{0};
  std::vector<State> states_{};
  std::vector<Open> open_{};
  std::uint32_t search_{0};
  bool to_many_{false};  ///< No single goal: costs are not estimated, and unknown space is not used.
  std::array<float, kTileNodes> to_goal_{};  // from the nodes of the goal's tile
  std::size_t expanded_{0};
};

}  // namespace adit::nav
