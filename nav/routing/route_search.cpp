// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/route_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace adit::nav {
namespace {

constexpr double kTile = kTileSide * kRouteCell;  // m

int tile_at(double v) { return tile_of(route_cell(v)); }

bool contains(const SurfaceMap::Extent& box, int tx, int ty) {
  return tx >= box.x0 && tx <= box.x1 && ty >= box.y0 && ty <= box.y1;
}

int opposite(int side) { return (side + 2) % 4; }

Eigen::Vector3d cell_place(const Tile& tile, int cell) {
  return {tile.cell_x(cell), tile.cell_y(cell), tile.cell_z(cell)};
}

// Cost of the straight line between two cells of a tile, m; infinite if it is not passable. Samples the same
// places as RouteLine, and both neighbours where a sample lies between cells.
float straight_cost(const Tile& tile, int from, int to) {
  const int dx = to % kTileSide - from % kTileSide, dy = to / kTileSide - from / kTileSide;
  const double length = std::hypot(dx, dy);
  const int steps = std::max(1, static_cast<int>(std::ceil(length)));
  int sum = 0;
  for (int i = 1; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    int cost = 0;
    for (const auto& [ex, ey] : {std::pair{-1e-6, -1e-6}, {1e-6, -1e-6}, {-1e-6, 1e-6}, {1e-6, 1e-6}}) {
      const int x = static_cast<int>(from % kTileSide + 0.5 + t * dx + ex);
      const int y = static_cast<int>(from / kTileSide + 0.5 + t * dy + ey);
      cost = tile.cost[y * kTileSide + x];
      if (cost == 0) return kUnreached;
    }
    sum += cost;
  }
  return static_cast<float>(length * kRouteCell * sum / (16.0 * steps));
}

}  // namespace

RouteSearch::RouteSearch(SurfaceMap& map, TileBuilder& builder, const RouteParams& params)
    : map_(map), builder_(builder), params_(params) {}

std::size_t RouteSearch::memory() const {
  return states_.capacity() * sizeof(State) + open_.capacity() * sizeof(Open) + squares_.memory();
}

int RouteSearch::level_of(double z) const {
  return static_cast<int>(std::lround((z - origin_z_) / double{kFloorSeparation}));
}

bool RouteSearch::is_usable(int tx, int ty) const {
  return contains(usable_, tx, ty) && (map_.near_seen(tx, ty) || contains(between_, tx, ty));
}

RouteSearch::Id RouteSearch::virtual_id(const VirtualNode& g) {
  if (to_many_ || !params_.through_unknown) return kNone;
  const UnknownSquares::Square square{g.tx, g.ty, g.level};
  int index = squares_.find(square);
  if (index < 0) {
    if (!is_usable(g.tx, g.ty)) return kNone;
    index = squares_.add(square);
    if (index < 0) {
      exceeded_ = true;
      return kNone;
    }
    const std::size_t size = virtual_from_ + 4 * squares_.size();
    if (states_.size() < size) states_.resize(size);
  }
  return virtual_from_ + static_cast<Id>(index * 4 + g.side);
}

RouteSearch::VirtualNode RouteSearch::virtual_node_of(Id id) const {
  const Id i = id - virtual_from_;
  const UnknownSquares::Square& square = squares_[i / 4];
  return {square.tx, square.ty, square.level, static_cast<int>(i % 4)};
}

Eigen::Vector3d RouteSearch::place(Id id) const {
  if (id == start_id_) return start_.place;
  if (id == goal_id_) return goal_.place;
  if (is_virtual(id)) {
    const VirtualNode g = virtual_node_of(id);
    const auto side = static_cast<std::size_t>(g.side);
    return {(g.tx + 0.5 + kSideX[side] * 0.47) * kTile, (g.ty + 0.5 + kSideY[side] * 0.47) * kTile,
            level_z(g.level)};
  }
  const TileNode& node = map_.tile(static_cast<int>(id / kTileNodes)).nodes[id % kTileNodes];
  return {node.x, node.y, node.z};
}

// Computes the boxes of usable unknown space and the numbering of the nodes.
void RouteSearch::prepare(const RouteEnd& start, const RouteEnd& goal) {
  start_ = start;
  goal_ = goal;
  origin_z_ = start.place.z();
  goal_level_ = level_of(goal.place.z());
  const int margin = SurfaceMap::margin_tiles(params_);
  const auto widen = [margin](SurfaceMap::Extent& box) {
    box = {box.x0 - margin, box.x1 + margin, box.y0 - margin, box.y1 + margin};
  };
  between_ = {};
  for (const Eigen::Vector3d& end : {start.place, goal.place})
    between_.add(tile_at(end.x()), tile_at(end.y()));
  usable_ = between_;
  if (const auto& e = map_.extent(); !e.empty()) {
    usable_.add(e.x0, e.y0);
    usable_.add(e.x1, e.y1);
  }
  widen(between_);
  widen(usable_);
  start_id_ = static_cast<Id>(map_.size() * kTileNodes);
  goal_id_ = start_id_ + 1;
  virtual_from_ = goal_id_ + 1;
  if (states_.size() < virtual_from_) states_.resize(virtual_from_);
  squares_.clear();
  exceeded_ = false;
  if (++search_ == 0) {
    std::fill(states_.begin(), states_.end(), State{});
    search_ = 1;
  }
  open_.clear();
  expanded_ = 0;
}

void RouteSearch::reach(Id id, float cost, Id from) {
  if (is_virtual(id) && !map_.areas().empty() && !map_.areas().permits(place(id), 0.0)) return;
  if (map_.has_team()) cost += static_cast<float>(map_.team_cost(place(from), place(id)));
  State& s = states_[id];
  if (s.search == search_ && (s.closed || s.cost <= cost)) return;
  s = {cost, from, search_, false};
  const float rest = to_many_ ? 0.0f : static_cast<float>((place(id) - goal_.place).norm());
  open_.push_back({cost + rest, id});
  std::push_heap(open_.begin(), open_.end());
}

void RouteSearch::begin(const RouteEnd& start) {
  states_[start_id_] = {0, start_id_, search_, true};
  if (start.tile >= 0) {
    const Tile& tile = builder_.current(map_, start.tile);
    builder_.spread(tile, start.cell);
    for (int n = 0; n < tile.node_count; ++n)
      if (const float d = builder_.distance(tile.nodes[n].cell); d < kUnreached)
        reach(static_cast<Id>(start.tile * kTileNodes + n), d, start_id_);
    if (start.tile == goal_.tile)
      if (const float d = builder_.distance(goal_.cell); d < kUnreached) reach(goal_id_, d, start_id_);
    return;
  }
  const int tx = tile_at(start.place.x()), ty = tile_at(start.place.y());
  for (int side = 0; side < 4; ++side) {
    const Id id = virtual_id({tx, ty, 0, side});
    if (id == kNone) return;
    reach(id, static_cast<float>((place(id) - start.place).norm()) * builder_.unknown_cost(), start_id_);
  }
  if (goal_.tile < 0 && tx == tile_at(goal_.place.x()) && ty == tile_at(goal_.place.y()) &&
      (goal_.any_floor || level_of(goal_.place.z()) == 0))
    reach(goal_id_, static_cast<float>((goal_.place - start.place).norm()) * builder_.unknown_cost(),
          start_id_);
}

RouteStatus RouteSearch::search(const RouteEnd& start, const RouteEnd& goal,
                                std::vector<Eigen::Vector3d>& points) {
  points.clear();
  to_many_ = false;
  prepare(start, goal);
  to_goal_.fill(kUnreached);
  if (goal.tile >= 0) {
    const Tile& tile = builder_.current(map_, goal.tile);
    builder_.spread(tile, goal.cell);
    for (int n = 0; n < tile.node_count; ++n) to_goal_[n] = builder_.distance(tile.nodes[n].cell);
  }
  begin(start);
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end());
    const Id id = open_.back().id;
    open_.pop_back();
    State& s = states_[id];
    if (s.closed) continue;
    s.closed = true;
    if (id == goal_id_) {
      write(points);
      return RouteStatus::found;
    }
    ++expanded_;
    expand(id, s.cost);
  }
  return exceeded_ ? RouteStatus::too_far : RouteStatus::unreachable;
}

std::vector<RouteSearch::ManyGoal> RouteSearch::goals_by_tile(std::span<const RouteEnd> goals) {
  std::vector<ManyGoal> sorted;
  sorted.reserve(goals.size());
  for (std::size_t k = 0; k < goals.size(); ++k) {
    const Tile& tile = builder_.current(map_, goals[k].tile);
    ManyGoal& goal = sorted.emplace_back(ManyGoal{goals[k].tile, k, {}});
    goal.from_node.fill(kUnreached);
    builder_.spread(tile, goals[k].cell);
    for (std::size_t n = 0; n < static_cast<std::size_t>(tile.node_count); ++n)
      goal.from_node[n] = builder_.distance(tile.nodes[n].cell);
  }
  std::ranges::sort(sorted, {}, &ManyGoal::tile);
  return sorted;
}

void RouteSearch::costs(const RouteEnd& start, std::span<const RouteEnd> goals, std::span<float> costs) {
  std::fill(costs.begin(), costs.end(), kUnreached);
  if (goals.empty()) return;
  prepare(start, {start.place, -1, 0});
  to_many_ = true;
  const std::vector<ManyGoal> sorted = goals_by_tile(goals);
  begin(start);  // Leaves the distances in the start's tile in the builder.
  for (const ManyGoal& goal : sorted)
    if (goal.tile == start.tile) costs[goal.index] = builder_.distance(goals[goal.index].cell);
  const auto dearest = [&costs] { return *std::max_element(costs.begin(), costs.end()); };
  for (float certain = dearest(); !open_.empty();) {
    std::pop_heap(open_.begin(), open_.end());
    const Id id = open_.back().id;
    open_.pop_back();
    State& s = states_[id];
    if (s.closed) continue;
    if (s.cost >= certain) break;
    s.closed = true;
    ++expanded_;
    const int tile = static_cast<int>(id / kTileNodes);
    const auto first = std::ranges::lower_bound(sorted, tile, {}, &ManyGoal::tile);
    bool cheaper = false;
    for (auto goal = first; goal != sorted.end() && goal->tile == tile; ++goal) {
      const float cost = s.cost + goal->from_node[id % kTileNodes];
      if (cost >= costs[goal->index]) continue;
      costs[goal->index] = cost;
      cheaper = true;
    }
    if (cheaper) certain = dearest();
    expand(id, s.cost);
  }
}

void RouteSearch::expand(Id id, float cost) {
  if (is_virtual(id))
    expand_virtual(virtual_node_of(id), cost, id);
  else
    expand_tile(static_cast<int>(id / kTileNodes), static_cast<int>(id % kTileNodes), cost, id);
}

void RouteSearch::expand_tile(int index, int node, float cost, Id id) {
  const Tile& tile = map_.tile(index);
  const auto distances = builder_.distances(map_, index, node);
  for (int m = 0; m < tile.node_count; ++m) {
    const float d = distances[m];
    if (m != node && d < kUnreached) reach(static_cast<Id>(index * kTileNodes + m), cost + d, id);
  }
  if (index == goal_.tile)
    if (const float d = to_goal_[node]; d < kUnreached) reach(goal_id_, cost + d, id);
  cross(tile, tile.nodes[node], cost, id);
}

// The place along a side where both tiles are open and the ground continues without a step, nearest to both
// middles; -1: none.
int RouteSearch::meeting_place(const Tile& a, const TileNode& from, const Tile& b, const TileNode& to) const {
  const int first = std::max(from.first, to.first), last = std::min(from.last, to.last);
  const int middle = (from.first + from.last + to.first + to.last) / 4;
  int best = -1;
  for (int i = first; i <= last; ++i) {
    const GroundCell& p = a.cells[side_cell(from.side, i)];
    const GroundCell& q = b.cells[side_cell(to.side, i)];
    const float most = builder_.most_rise(p, q);
    const float pz = p.known ? p.z : a.z, qz = q.known ? q.z : b.z;
    if (std::abs(pz - qz) <= most && (best < 0 || std::abs(i - middle) < std::abs(best - middle))) best = i;
  }
  return best;
}

bool RouteSearch::borders(const Tile& tile, int side, int first, int last, float z) const {
  for (int i = first; i <= last; ++i)
    if (std::abs(tile.cell_z(side_cell(side, i)) - z) <= kFloorSeparation) return true;
  return false;
}

bool RouteSearch::meets(const Tile& a, const TileNode& from, const Tile& b, const TileNode& to) const {
  return to.side == opposite(from.side) && meeting_place(a, from, b, to) >= 0;
}

void RouteSearch::cross(const Tile& tile, const TileNode& node, float cost, Id id) {
  const Eigen::Vector3d here = cell_place(tile, node.cell);
  const float weight = static_cast<float>(tile.cost[node.cell]) / 16.0f;
  bool met = false;
  for (int i = tile.beside[node.side]; i >= 0; i = map_.tile(i).next) {
    const Tile& other = map_.tile(i);
    if (!borders(other, opposite(node.side), node.first, node.last, node.z)) continue;
    met = true;
    builder_.current(map_, i);
    for (int m = 0; m < other.node_count; ++m) {
      const TileNode& to = other.nodes[m];
      if (!meets(tile, node, other, to)) continue;
      const float length = static_cast<float>((cell_place(other, to.cell) - here).norm());
      reach(static_cast<Id>(i * kTileNodes + m),
            cost + length * (weight + static_cast<float>(other.cost[to.cell]) / 16.0f) / 2, id);
    }
  }
  if (met) return;
  const VirtualNode virtual_node{tile.tx + kSideX[node.side], tile.ty + kSideY[node.side], level_of(node.z),
                                 opposite(node.side)};
  const Id to = virtual_id(virtual_node);
  if (to == kNone) return;
  reach(to, cost + static_cast<float>((place(to) - here).head<2>().norm()) * builder_.unknown_cost(), id);
}

void RouteSearch::enter_from_virtual(const VirtualNode& g, float cost, Id id) {
  const auto side = static_cast<std::size_t>(g.side);
  const int tx = g.tx + kSideX[side], ty = g.ty + kSideY[side];
  const float z = level_z(g.level);
  const Eigen::Vector3d here = place(id);
  bool met = false;
  for (int i = map_.first(tx, ty); i >= 0; i = map_.tile(i).next) {
    const Tile& other = map_.tile(i);
    if (!borders(other, opposite(g.side), 0, kTileSide - 1, z)) continue;
    met = true;
    builder_.current(map_, i);
    for (int m = 0; m < other.node_count; ++m) {
      const TileNode& to = other.nodes[m];
      if (to.side != opposite(g.side) || std::abs(to.z - z) > kFloorSeparation) continue;
      reach(static_cast<Id>(i * kTileNodes + m),
            cost + static_cast<float>((cell_place(other, to.cell) - here).head<2>().norm()) *
                       builder_.unknown_cost(),
            id);
    }
  }
  if (met) return;
  const Id to = virtual_id({tx, ty, g.level, opposite(g.side)});
  if (to == kNone) return;
  reach(to, cost + static_cast<float>((place(to) - here).norm()) * builder_.unknown_cost(), id);
}

void RouteSearch::expand_virtual(const VirtualNode& g, float cost, Id id) {
  const Eigen::Vector3d here = place(id);
  for (int side = 0; side < 4; ++side) {
    if (side == g.side) continue;
    const Id to = id - static_cast<Id>(g.side) + static_cast<Id>(side);
    reach(to, cost + static_cast<float>((place(to) - here).norm()) * builder_.unknown_cost(), id);
  }
  if (goal_.tile < 0 && (goal_.any_floor || g.level == goal_level_) && g.tx == tile_at(goal_.place.x()) &&
      g.ty == tile_at(goal_.place.y())) {
    const Eigen::Vector2d way = (goal_.place - here).head<2>();
    const float total = cost + static_cast<float>(way.norm()) * builder_.unknown_cost();
    const State& s = states_[goal_id_];
    if (goal_.any_floor && !(s.search == search_ && s.cost <= total)) goal_.place.z() = here.z();
    reach(goal_id_, total, id);
  }
  // Ramps are unknown here: a change of level is possible anywhere at a cost, but only towards the goal's
  // level.
  if (g.level != goal_level_) {
    const int level = g.level + (goal_level_ > g.level ? 1 : -1);
    if (map_.at(g.tx, g.ty, level_z(level)) < 0)
      if (const Id to = virtual_id({g.tx, g.ty, level, g.side}); to != kNone)
        reach(to, cost + static_cast<float>(params_.level_cost), id);
  }
  enter_from_virtual(g, cost, id);
}

// Writes a straight line if it costs hardly more than the path that was found; else that path.
void RouteSearch::write_within(int index, int from, int to, float cost,
                               std::vector<Eigen::Vector3d>& points) {
  const Tile& tile = map_.tile(index);
  if (straight_cost(tile, from, to) <= 1.05f * cost + 0.05f) {
    points.push_back(cell_place(tile, to));
    return;
  }
  builder_.spread(tile, from);
  const auto begin = static_cast<std::ptrdiff_t>(points.size());
  for (int c = to; c >= 0 && c != from; c = builder_.before(c)) points.push_back(cell_place(tile, c));
  std::reverse(points.begin() + begin, points.end());
}

// Appends the points from one node to the next, the latter included.
void RouteSearch::write_leg(Id from, Id to, std::vector<Eigen::Vector3d>& points) {
  const auto tile_index = [this](Id id) {
    return id == start_id_  ? start_.tile
           : id == goal_id_ ? goal_.tile
           : is_virtual(id) ? -1
                            : static_cast<int>(id / kTileNodes);
  };
  const auto cell = [this](Id id) {
    return id == start_id_  ? start_.cell
           : id == goal_id_ ? goal_.cell
                            : map_.tile(static_cast<int>(id / kTileNodes)).nodes[id % kTileNodes].cell;
  };
  const int a = tile_index(from), b = tile_index(to);
  if (a >= 0 && a == b) {
    write_within(a, cell(from), cell(to), states_[to].cost - states_[from].cost, points);
  } else if (a >= 0 && b >= 0) {
    const Tile& p = map_.tile(a);
    const Tile& q = map_.tile(b);
    const TileNode& out = p.nodes[from % kTileNodes];
    const TileNode& in = q.nodes[to % kTileNodes];
    const int i = meeting_place(p, out, q, in);
    points.push_back(cell_place(p, side_cell(out.side, i)));
    points.push_back(cell_place(q, side_cell(in.side, i)));
    points.push_back(cell_place(q, in.cell));
  } else {
    // Crosses the tile's side at a right angle: its opening may be only one cell wide.
    const auto beyond = [this](Id id) {
      const TileNode& node = map_.tile(static_cast<int>(id / kTileNodes)).nodes[id % kTileNodes];
      return Eigen::Vector3d(node.x + kSideX[node.side] * kRouteCell, node.y + kSideY[node.side] * kRouteCell,
                             node.z);
    };
    if (is_virtual(to) && a >= 0 && from != start_id_) points.push_back(beyond(from));
    if (is_virtual(from) && b >= 0 && to != goal_id_) points.push_back(beyond(to));
    points.push_back(place(to));
  }
}

void RouteSearch::write(std::vector<Eigen::Vector3d>& points) {
  std::vector<Id> ids;
  for (Id id = goal_id_; id != start_id_; id = states_[id].from) ids.push_back(id);
  ids.push_back(start_id_);
  std::reverse(ids.begin(), ids.end());
  points.push_back(start_.place);
  for (std::size_t i = 0; i + 1 < ids.size(); ++i) write_leg(ids[i], ids[i + 1], points);
  points.back() = goal_.place;
}

}  // namespace adit::nav
