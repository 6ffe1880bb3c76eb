// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "nav/routing/route.hpp"
#include "nav/routing/surface_map.hpp"
#include "nav/routing/tile_builder.hpp"
#include "nav/routing/unknown_squares.hpp"

namespace adit::nav {

/// A start or goal on the map, m.
struct RouteEnd {
  Eigen::Vector3d place{0, 0, 0};
  int tile{-1};           ///< -1: in unknown space without a tile.
  int cell{0};            ///< Passable cell of the tile.
  bool any_floor{false};  ///< Goal of unknown height: any floor counts.
};

/// A* over the openings of the tiles. Unknown space without tiles has a virtual node on each side of each
/// tile place: on the heights of the start and, through unknown space, also of a goal on another floor. Those
/// nodes are made when the search reaches them, near to tiles and in the box of start and goal, and at most
/// UnknownSquares::kMax places of them: then the search goes on with those and through known space.
class RouteSearch {
 public:
  RouteSearch(SurfaceMap& map, TileBuilder& builder, const RouteParams& params);

  /// Searches a route as points on the ground, each leg passable. Updates the tiles that it reaches.
  RouteStatus search(const RouteEnd& start, const RouteEnd& goal, std::vector<Eigen::Vector3d>& points);
  /// Costs from one place to many through known space, m; infinite where there is no route. One search from
  /// the start (Dijkstra) ends when the cost of every goal is certain. `start` and `goals` lie on tiles;
  /// `costs`: one for each goal.
  void costs(const RouteEnd& start, std::span<const RouteEnd> goals, std::span<float> costs);
  /// Number of nodes that the last search expanded.
  std::size_t expanded() const { return expanded_; }
  /// Memory of its buffers, bytes.
  std::size_t memory() const;

 private:
  using Id = std::uint32_t;
  static constexpr Id kNone = std::numeric_limits<Id>::max();
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
  /// A virtual node beside unknown space: tile coordinates, height in levels from the start's, side.
  struct VirtualNode {
    int tx, ty, level, side;
  };

  /// One of many goals: its tile, its index in the list, and its costs from the tile's nodes, m.
  struct ManyGoal {
    int tile;
    std::size_t index;
    std::array<float, kTileNodes> from_node;
  };

  void prepare(const RouteEnd& start, const RouteEnd& goal);
  std::vector<ManyGoal> goals_by_tile(std::span<const RouteEnd> goals);
  bool is_virtual(Id id) const { return id >= virtual_from_; }
  /// The node's id; it is made if it may be and is new. kNone: no route may lead there.
  Id virtual_id(const VirtualNode& g);
  VirtualNode virtual_node_of(Id id) const;
  bool is_usable(int tx, int ty) const;
  float level_z(int level) const { return static_cast<float>(origin_z_ + level * double{kFloorSeparation}); }
  int level_of(double z) const;
  Eigen::Vector3d place(Id id) const;
  void reach(Id id, float cost, Id from);
  void expand(Id id, float cost);
  void expand_tile(int index, int node, float cost, Id id);
  void expand_virtual(const VirtualNode& g, float cost, Id id);
  void cross(const Tile& tile, const TileNode& node, float cost, Id id);
  void enter_from_virtual(const VirtualNode& g, float cost, Id id);
  /// Whether one of the side's cells belongs to the floor at z.
  bool borders(const Tile& tile, int side, int first, int last, float z) const;
  bool meets(const Tile& a, const TileNode& from, const Tile& b, const TileNode& to) const;
  int meeting_place(const Tile& a, const TileNode& from, const Tile& b, const TileNode& to) const;
  void begin(const RouteEnd& start);
  void write(std::vector<Eigen::Vector3d>& points);
  void write_leg(Id from, Id to, std::vector<Eigen::Vector3d>& points);
  /// `cost`: of the path found by the search, m.
  void write_within(int index, int from, int to, float cost, std::vector<Eigen::Vector3d>& points);

  SurfaceMap& map_;
  TileBuilder& builder_;
  RouteParams params_;
  RouteEnd start_{}, goal_{};
  double origin_z_{0};
  SurfaceMap::Extent usable_{}, between_{};  // Boxes of unknown space: all; around start and goal.
  int goal_level_{0};
  Id start_id_{0}, goal_id_{0}, virtual_from_{0};
  UnknownSquares squares_{};
  bool exceeded_{false};  ///< More squares were reached than there may be.
  std::vector<State> states_{};
  std::vector<Open> open_{};
  std::uint32_t search_{0};
  bool to_many_{false};                      ///< Search to many goals: no heuristic and no unknown space.
  std::array<float, kTileNodes> to_goal_{};  // From the nodes of the goal's tile, m.
  std::size_t expanded_{0};
};

}  // namespace adit::nav
