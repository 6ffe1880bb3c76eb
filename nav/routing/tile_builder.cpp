// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/tile_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "nav/routing/forbidden_ground.hpp"
#include "nav/routing/known_stairs.hpp"

namespace adit::nav {
namespace {

constexpr float kUnit = 16.0f;  // Of a cell's cost.
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kAsideOfGap = 0.03;  // m
constexpr int kSteep = 5;             // Maximum number of cells over which a step is searched.
constexpr int kLongSteep = 13;        // The same for heights seen from afar.
constexpr double kSureNoise = 0.025;  // m: of the difference of two heights measured from near.
constexpr double kNoise = 0.05;  // m: of the difference of two heights; also a kerb with a ramp behind it.

std::uint8_t in_units(double cost) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(double{kUnit} * cost, double{kUnit} + 1.0, 255.0)));
}

}  // namespace

// The required clearance is less than the body needs, because the nearest cell's centre lies beside the
// middle of a gap. The local planner is exact and reports when the robot does not fit.
TileBuilder::TileBuilder(const Platform& platform, const RouteParams& params)
    : platform_(platform),
      limits_(Traversability::of(platform)),
      hard_(std::max(platform.width / 2 - kAsideOfGap, kRouteCell)),
      comfort_(
          std::min(std::hypot(platform.length, platform.width) / 2 + params.comfort, kTileHalo * kRouteCell)),
      narrow_cost_(params.narrow_cost),
      rise_(static_cast<float>(std::max(limits_.step, limits_.slope * kRouteCell) + limits_.obstacle -
                               limits_.step + (platform.stairs ? Traversability::kRiser : 0.0))),
      doubtful_rise_(std::max(rise_, kTall * kObstacleHeightUnit)),
      unknown_cost_(static_cast<float>(params.unknown_cost)),
      through_unknown_(params.through_unknown),
      doubtful_cost_(in_units(params.doubtful_cost)),
      hole_cost_(in_units(params.doubtful_hole_cost)) {
  for (std::size_t d2 = 0; d2 < cost_of_.size(); ++d2)
    cost_of_[d2] = cost_at(std::sqrt(static_cast<double>(d2)) * kRouteCell);
}

std::uint8_t TileBuilder::cost_at(double distance) const {
  if (distance < hard_ - 1e-9) return 0;
  const double lack =
      comfort_ > hard_ ? std::clamp((comfort_ - distance) / (comfort_ - hard_), 0.0, 1.0) : 0.0;
  return static_cast<std::uint8_t>(
      std::lround(std::min(255.0, double{kUnit} * (1.0 + narrow_cost_ * lack * lack))));
}

void TileBuilder::gather_tile(const Tile& from, float z, int ox, int oy) {
  const int x0 = std::max(0, ox), x1 = std::min(kWindow, ox + kTileSide);
  const int y0 = std::max(0, oy), y1 = std::min(kWindow, oy + kTileSide);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const GroundCell& cell = from.cells[(y - oy) * kTileSide + (x - ox)];
      if (!cell.known || std::abs(cell.z - z) > 2 * kFloorSeparation) continue;
      // The height of the ground under an obstacle is a guess and makes no step.
      const std::size_t at = in_window(x, y);
      known_[at] = true;
      seen_height_[at] = cell.blocked || cell.guessed() ? kNan : cell.z;
      height_[at] = said(cell) ? seen_height_[at] : kNan;
      sure_[at] = cell.sure;
      all_sure_ = all_sure_ && cell.sure;
      solid_[at] = solid(cell);
      tall_[at] = cell.blocked && cell.obstacle_height > kTall;
      has_obstacle_[at] = solid_[at];
      if (cell.blocked && !solid_[at]) doubtful_[at] = price_of(cell);
      if (solid_[at]) aside_[at] = {cell.aside_x, cell.aside_y};
    }
}

void TileBuilder::gather(const SurfaceMap& map, const Tile& tile) {
  height_.fill(kNan);
  seen_height_.fill(kNan);
  known_.fill(false);
  sure_.fill(false);
  all_sure_ = true;
  solid_.fill(false);
  tall_.fill(false);
  doubtful_.fill(0);
  has_obstacle_.fill(false);
  aside_.fill({0, 0});
  gather_tile(tile, tile.z, kTileHalo, kTileHalo);
  // Ground of another floor less than a storey higher or lower is an edge of this floor, and its obstacles
  // block this floor too.
  for (int i = map.first(tile.tx, tile.ty); i >= 0; i = map.tile(i).next) {
    const Tile& other = map.tile(i);
    if (&other == &tile) continue;
    for (int c = 0; c < kTileArea; ++c) {
      const auto k = static_cast<std::size_t>(c);
      const GroundCell& cell = other.cells[k];
      const float off = std::abs(cell.z - tile.z);
      if (tile.cells[k].known || !cell.known || off > kFloorSeparation) continue;
      const std::size_t at = in_window(c % kTileSide + kTileHalo, c / kTileSide + kTileHalo);
      const bool edge = said(cell) && (cell.sure || off >= doubtful_rise_);
      if (edge || solid(cell))
        solid_[at] = true;
      else
        doubtful_[at] = price_of(cell);
      all_sure_ = all_sure_ && cell.sure;
    }
  }
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const int other = map.beside(tile, dx, dy);
      if (other >= 0)
        gather_tile(map.tile(other), tile.z, kTileHalo + dx * kTileSide, kTileHalo + dy * kTileSide);
    }
  for (const Staircase& stairs : map.stairs()) lay_stairs(stairs, tile);
  for (const BlockedPlace& p : map.blocked_places()) {
    if (!p.active || std::abs(p.z - tile.z) > kFloorSeparation) continue;
    const double cx = p.x / kRouteCell - (tile.tx * kTileSide - kTileHalo);
    const double cy = p.y / kRouteCell - (tile.ty * kTileSide - kTileHalo);
    const double r = p.radius / kRouteCell;
    for (int y = std::max(0, static_cast<int>(cy - r)); y < std::min<double>(kWindow, cy + r); ++y)
      for (int x = std::max(0, static_cast<int>(cx - r)); x < std::min<double>(kWindow, cx + r); ++x)
        if (std::hypot(x + 0.5 - cx, y + 0.5 - cy) <= r) solid_[in_window(x, y)] = true;
  }
  if (!map.areas().empty()) forbid(map.areas(), tile, 0, 0, kWindow);
}

void TileBuilder::lay_stairs(const Staircase& stairs, const Tile& tile) {
  constexpr float kSame = 0.5f;  // m: ground at other heights is above or below the staircase.
  const bool climbable = climbs(platform_, stairs);
  visit_cells(stairs, climbable ? kRouteCell : 0.0, [&](int ix, int iy, const OnStairs& place) {
    const int x = ix - (tile.tx * kTileSide - kTileHalo), y = iy - (tile.ty * kTileSide - kTileHalo);
    if (x < 0 || y < 0 || x >= kWindow || y >= kWindow) return;
    const std::size_t at = in_window(x, y);
    const auto z = static_cast<float>(tread_height(stairs, place.along));
    if (std::abs(z - tile.z) > 2 * kFloorSeparation || std::abs(z - seen_height_[at]) > kSame) return;
    if (!climbable) {
      solid_[at] = true;
    } else if (!tall_[at]) {
      known_[at] = sure_[at] = true;
      height_[at] = seen_height_[at] = z;
      solid_[at] = has_obstacle_[at] = false;
      doubtful_[at] = 0;
    }
  });
}

// On a staircase and before its ends a place costs the more the farther it is from the axis.
void TileBuilder::price_aside(const Staircase& stairs, Tile& tile) const {
  constexpr double kAtSide = 6.0;  // Of a metre along a side, beside its length.
  if (!climbs(platform_, stairs)) return;
  visit_cells(stairs, kStairsApproach, [&](int ix, int iy, const OnStairs& place) {
    if (tile_of(ix) != tile.tx || tile_of(iy) != tile.ty) return;
    const auto c = static_cast<std::size_t>(cell_in_tile(ix, iy));
    const double z = tread_height(stairs, place.along), part = 2 * place.across / stairs.width;
    if (tile.cost[c] == 0 || std::abs(double{tile.cell_z(static_cast<int>(c))} - z) > kRouteCell * 5) return;
    tile.cost[c] = static_cast<std::uint8_t>(std::min(255.0, tile.cost[c] * (1.0 + kAtSide * part * part)));
  });
}

// Forbidden ground, and what is nearer to it than robots may come, is an obstacle. Squares with a border in
// them are divided, so that few cells need a look of their own.
void TileBuilder::forbid(const AreaSet& areas, const Tile& tile, int x0, int y0, int side) {
  const Eigen::Vector3d middle((tile.tx * kTileSide - kTileHalo + x0 + side / 2.0) * kRouteCell,
                               (tile.ty * kTileSide - kTileHalo + y0 + side / 2.0) * kRouteCell, tile.z);
  const ForbiddenPart part =
      side == 1 ? areas.permits(middle, kForbiddenReach) ? ForbiddenPart::none : ForbiddenPart::all
                : forbidden_part(areas, middle, side);
  if (part == ForbiddenPart::all)
    for (int y = y0; y < y0 + side; ++y)
      std::fill_n(solid_.begin() + static_cast<std::ptrdiff_t>(in_window(x0, y)), side, true);
  if (part != ForbiddenPart::some) return;
  const int half = side / 2;
  for (const int y : {y0, y0 + half})
    for (const int x : {x0, x0 + half}) forbid(areas, tile, x, y, half);
}

// Whether a step is the foot of an obstacle: beside an obstacle, a return of its foot passes for higher
// ground. Such a step would keep robots farther away than the obstacle itself, and close gaps.
bool TileBuilder::is_foot(std::size_t cell) const {
  const int x = static_cast<int>(cell % kWindow), y = static_cast<int>(cell / kWindow);
  for (int v = std::max(0, y - 1); v <= std::min(kWindow - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(kWindow - 1, x + 1); ++u)
      if (has_obstacle_[in_window(u, v)]) return true;
  return false;
}

// Ground that is too steep between two cells is an edge, for both the lower and the upper cell.
void TileBuilder::find_steps() {
  float lowest = std::numeric_limits<float>::max(), highest = std::numeric_limits<float>::lowest();
  const auto compare = [this](std::size_t a, std::size_t b) {
    const float seen = std::abs(seen_height_[a] - seen_height_[b]);
    if (!(seen > rise_) || is_foot(seen_height_[a] > seen_height_[b] ? a : b)) return;  // Returns for NaN.
    const float most = sure_[a] && sure_[b] ? rise_ : doubtful_rise_;
    if (std::abs(height_[a] - height_[b]) > most)
      solid_[a] = solid_[b] = true;
    else
      doubtful_[a] = doubtful_[b] = std::max({doubtful_[a], doubtful_[b], doubtful_cost_});
  };
  for (int y = 0; y < kWindow; ++y)
    for (int x = 0; x < kWindow; ++x) {
      if (x + 1 < kWindow) compare(in_window(x, y), in_window(x + 1, y));
      if (y + 1 < kWindow) compare(in_window(x, y), in_window(x, y + 1));
      const float height = seen_height_[in_window(x, y)];
      if (height < lowest) lowest = height;  // False for NaN.
      if (height > highest) highest = height;
    }
  if (platform_.stairs || highest - lowest <= rise_) return;
  const bool high = highest - lowest > kTall * kObstacleHeightUnit;
  for (int cells = 2; cells < (all_sure_ || !high ? kSteep : kLongSteep); ++cells)
    for (int i = 0; i < kWindow; ++i)
      for (int j = 0; j + cells < kWindow; ++j) {
        find_steep(in_window(j, i), 1, cells);
        find_steep(in_window(i, j), kWindow, cells);
      }
}

// The returns of a riser, or drift, spread a step over cells that each rise little. From afar, where stairs
// and ramps look alike, the limit is what is too steep for either. A steep piece that a shorter one explains
// is left to that one.
void TileBuilder::find_steep(std::size_t from, std::size_t stride, int cells) {
  const std::size_t to = from + stride * static_cast<std::size_t>(cells);
  if (cells < kSteep && seems_steep(from, stride, cells))
    for (std::size_t i = from + stride; i < to; i += stride) doubtful_[i] = doubtful_cost_;
  const float rise = std::abs(height_[from] - height_[to]);
  if (!(rise > rise_)) return;
  bool sure = cells < kSteep;
  for (std::size_t i = from; i <= to; i += stride) {
    if (solid_[i]) return;
    sure = sure && sure_[i] && !std::isnan(height_[i]);
  }
  const double run = kRouteCell * cells;
  const double most =
      sure ? std::max(limits_.obstacle, limits_.slope * run + kSureNoise)
           : std::max(kTall * double{kObstacleHeightUnit}, limits_.obstacle + limits_.slope * run + kNoise);
  if (rise <= most || is_foot(height_[from] > height_[to] ? from : to)) return;
  for (std::size_t i = from + stride; i < to; i += stride)
    solid_[i] = cells < kSteep || known_[i];  // The ground below a stage is unknown.
}

bool TileBuilder::seems_steep(std::size_t from, std::size_t stride, int cells) const {
  const std::size_t to = from + stride * static_cast<std::size_t>(cells);
  const double rise = std::abs(seen_height_[from] - seen_height_[to]);
  if (!(rise > std::max(limits_.obstacle, limits_.slope * kRouteCell * cells + kSureNoise))) return false;
  for (std::size_t i = from; i <= to; i += stride)
    if (solid_[i] || doubtful_[i] > 0) return false;
  return !is_foot(seen_height_[from] > seen_height_[to] ? from : to);
}

// Distance from the centre of a cell of the window to the nearest obstacle, with its position in its cell, m.
double TileBuilder::exact_clearance(int x, int y) const {
  const int reach = static_cast<int>(hard_ / kRouteCell) + 2;
  double least = kTileHalo * kRouteCell * kTileHalo * kRouteCell;  // Squared.
  for (int v = std::max(0, y - reach); v <= std::min(kWindow - 1, y + reach); ++v)
    for (int u = std::max(0, x - reach); u <= std::min(kWindow - 1, x + reach); ++u) {
      if (!solid_[in_window(u, v)]) continue;
      const auto& aside = aside_[in_window(u, v)];
      const double dx = (u - x) * kRouteCell + aside[0] * double{kAsideUnit};
      const double dy = (v - y) * kRouteCell + aside[1] * double{kAsideUnit};
      least = std::min(least, dx * dx + dy * dy);
    }
  return std::sqrt(least);
}

// Squared distance to the nearest obstacle, exact within the halo: along columns first, then across.
void TileBuilder::measure(Tile& tile) {
  constexpr int kFar = kTileHalo + 1;
  std::array<std::uint8_t, kWindow * kWindow> up{};
  for (int x = 0; x < kWindow; ++x) {
    int d = kFar;
    for (int y = 0; y < kWindow; ++y) {
      d = solid_[in_window(x, y)] ? 0 : std::min(d + 1, kFar);
      up[in_window(x, y)] = static_cast<std::uint8_t>(d);
    }
    d = kFar;
    for (int y = kWindow - 1; y >= 0; --y) {
      d = solid_[in_window(x, y)] ? 0 : std::min(d + 1, kFar);
      up[in_window(x, y)] = static_cast<std::uint8_t>(std::min<int>(up[in_window(x, y)], d));
    }
  }
  for (int y = 0; y < kTileSide; ++y)
    for (int x = 0; x < kTileSide; ++x) {
      int least = kTileHalo * kTileHalo + 1;
      for (int dx = -kTileHalo; dx <= kTileHalo; ++dx) {
        const int d = up[in_window(x + kTileHalo + dx, y + kTileHalo)];
        if (d <= kTileHalo) least = std::min(least, dx * dx + d * d);
      }
      const auto c = static_cast<std::size_t>(y * kTileSide + x);
      // Where one cell decides, uses the exact position of the obstacle.
      const double about = std::sqrt(static_cast<double>(least)) * kRouteCell;
      float cost = std::abs(about - hard_) < kRouteCell
                       ? cost_at(exact_clearance(x + kTileHalo, y + kTileHalo))
                       : cost_of_[least];
      if (!tile.cells[c].known) cost = through_unknown_ ? std::min(255.0f, cost * unknown_cost_) : 0.0f;
      tile.cost[c] = static_cast<std::uint8_t>(cost);
    }
  tile.has_doubts = false;
  if (!all_sure_) price_doubts(tile);
}

std::uint8_t TileBuilder::price_of(const GroundCell& cell) const {
  return cell.obstacle_height <= kHoleHeight ? hole_cost_ : doubtful_cost_;
}

void TileBuilder::price_doubts(Tile& tile) const {
  const int reach = std::min(kTileHalo, static_cast<int>(std::ceil(hard_ / kRouteCell)));
  const double radius2 = hard_ * hard_ / (kRouteCell * kRouteCell);
  std::array<std::uint8_t, kTileArea> price{};
  for (int y = 0; y < kWindow; ++y)
    for (int x = 0; x < kWindow; ++x) {
      const std::uint8_t own = doubtful_[in_window(x, y)];
      if (own == 0) continue;
      tile.has_doubts = true;
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
          const int u = x + dx - kTileHalo, v = y + dy - kTileHalo;
          if (u < 0 || v < 0 || u >= kTileSide || v >= kTileSide || dx * dx + dy * dy > radius2) continue;
          std::uint8_t& most = price[v * kTileSide + u];
          most = std::max(most, own);
        }
    }
  if (!tile.has_doubts) return;
  for (std::size_t c = 0; c < price.size(); ++c)
    if (tile.cost[c] > 0 && price[c] > 0)
      tile.cost[c] =
          static_cast<std::uint8_t>(std::min(255, tile.cost[c] + price[c] - static_cast<int>(kUnit)));
}

void TileBuilder::add_node(Tile& tile, int side, int first, int last) {
  int place = tile.node_count;
  if (place < kTileNodes) {
    ++tile.node_count;
  } else {  // Drops the narrowest, which may be this one.
    const auto narrowest =
        std::ranges::min_element(tile.nodes, {}, [](const TileNode& n) { return n.last - n.first; });
    if (narrowest->last - narrowest->first >= last - first) return;
    place = static_cast<int>(narrowest - tile.nodes.begin());
  }
  const int cell = side_cell(side, (first + last) / 2);
  tile.nodes[place] = {static_cast<std::uint8_t>(side),
                       static_cast<std::uint8_t>(first),
                       static_cast<std::uint8_t>(last),
                       static_cast<std::uint8_t>(cell),
                       static_cast<float>(tile.cell_x(cell)),
                       static_cast<float>(tile.cell_y(cell)),
                       tile.cell_z(cell)};
}

void TileBuilder::open_sides(Tile& tile) {
  tile.node_count = 0;
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < kTileSide;) {
      if (tile.cost[side_cell(side, i)] == 0) {
        ++i;
        continue;
      }
      int last = i;
      while (last + 1 < kTileSide && tile.cost[side_cell(side, last + 1)] > 0) ++last;
      add_node(tile, side, i, last);
      i = last + 1;
    }
}

// Distances are not negative, so their bits sort in the same order.
std::uint64_t TileBuilder::entry(float distance, int cell) {
  return (std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32) | static_cast<std::uint32_t>(cell);
}

void TileBuilder::spread(const Tile& tile, int cell, bool to_nodes) {
  std::array<bool, kTileArea> wanted{};
  int left = 0;
  for (int n = 0; to_nodes && n < tile.node_count; ++n) {
    bool& node = wanted[tile.nodes[n].cell];
    left += !node;
    node = true;
  }
  // A border around the tile saves the range checks.
  constexpr int kWide = kTileSide + 2;
  std::array<std::uint8_t, kWide * kWide> costs{};
  for (int y = 0; y < kTileSide; ++y)
    std::copy_n(tile.cost.begin() + y * kTileSide, kTileSide, costs.begin() + (y + 1) * kWide + 1);
  const auto cost_of = [&costs](int at) { return int{costs[at]}; };
  distance_.fill(kUnreached);
  before_.fill(-1);
  heap_.clear();
  distance_[cell] = 0;
  heap_.push_back(entry(0, cell));
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    const auto at = static_cast<std::uint32_t>(heap_.back());  // The lower half holds the cell.
    const auto so_far = std::bit_cast<float>(static_cast<std::uint32_t>(heap_.back() >> 32));
    heap_.pop_back();
    if (so_far > distance_[at]) continue;
    if (wanted[at] && --left == 0) return;
    const int here = static_cast<int>((at / kTileSide + 1) * kWide + at % kTileSide + 1);
    const int own = cost_of(here);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const int cost = cost_of(here + dy * kWide + dx);
        if (cost == 0) continue;
        // Not diagonally past a corner: a straight line would touch it.
        const bool across = dx != 0 && dy != 0;
        if (across && (cost_of(here + dx) == 0 || cost_of(here + dy * kWide) == 0)) continue;
        const int next = static_cast<int>(at) + dy * kTileSide + dx;
        const float step = kRouteCellF * (across ? 1.41421356f : 1.0f);
        const float d = so_far + step * static_cast<float>(cost + own) / (2 * kUnit);
        if (d >= distance_[next]) continue;
        distance_[next] = d;
        before_[next] = static_cast<int>(at);
        heap_.push_back(entry(d, next));
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
      }
  }
}

void TileBuilder::connect(Tile& tile, int node) {
  // In a tile of uniform cost paths are straight.
  const bool even = std::ranges::all_of(tile.cost, [&](auto c) { return c == tile.cost[0] && c > 0; });
  const TileNode& from = tile.nodes[node];
  if (!even) spread(tile, from.cell, true);
  for (int b = 0; b < tile.node_count; ++b) {
    const TileNode& to = tile.nodes[b];
    tile.distance[node * kTileNodes + b] =
        even ? std::hypot(to.x - from.x, to.y - from.y) * static_cast<float>(tile.cost[0]) / kUnit
             : distance(to.cell);
  }
  tile.measured = static_cast<std::uint16_t>(tile.measured | 1u << node);
}

void TileBuilder::connect(SurfaceMap& map, int index) {
  Tile& tile = map.tile(index);
  for (int node = 0; node < tile.node_count; ++node)
    if (!(tile.measured >> node & 1u)) connect(tile, node);
}

std::span<const float, kTileNodes> TileBuilder::distances(SurfaceMap& map, int index, int node) {
  Tile& tile = map.tile(index);
  if (!(tile.measured >> node & 1u)) connect(tile, node);
  return std::span<const float, kTileNodes>(tile.distance.data() + node * kTileNodes, kTileNodes);
}

void TileBuilder::build(SurfaceMap& map, int index) {
  Tile& tile = map.tile(index);
  tile.dirty = false;
  gather(map, tile);
  find_steps();
  const std::array<std::uint8_t, kTileArea> before = tile.cost;
  measure(tile);
  for (const Staircase& stairs : map.stairs()) price_aside(stairs, tile);
  // Most updates of a tile change no cost: its distances stay valid, except for heights.
  const bool same = tile.built && before == tile.cost;
  open_sides(tile);
  if (same) return;
  tile.built = true;
  tile.measured = 0;
}

}  // namespace adit::nav
