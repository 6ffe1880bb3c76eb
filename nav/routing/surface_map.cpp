// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/surface_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nav/routing/forbidden_ground.hpp"
#include "nav/routing/known_stairs.hpp"

namespace adit::nav {
namespace {

constexpr int kHit = 3;           // Evidence of a return.
constexpr int kBlocked = 5;       // Threshold: two returns.
constexpr int kRay = 2;           // Evidence of a scan that saw through.
constexpr int kMaxEvidence = 12;  // Upper limit: half as many scans free the cell again.
constexpr int kFree = 0;
constexpr int kMinEvidence = -4;
// m: from farther away the side of a ramp and a step look alike, and half a degree moves the ground by 3.5
// cm, less than half a step.
constexpr float kSureRange = 4.0f;
constexpr std::size_t kPlaces = 32;
constexpr double kSamePlace = 0.6;  // m
constexpr int kMaxTimes = 4;
constexpr double kLanding = 0.3;           // m: a floor is before the foot of stairs and behind their top.
constexpr std::uint8_t kRangeOnFoot = 10;  // kRangeUnit: as of ground that the robot stood on.
constexpr std::array<int, 8> kAroundX{1, 0, -1, 0, 1, -1, -1, 1};
constexpr std::array<int, 8> kAroundY{0, 1, 0, -1, 1, 1, -1, -1};
constexpr std::array<std::size_t, 8> kOpposite{2, 3, 0, 1, 6, 7, 4, 5};

// The smallest height difference to the known cells around; -1 if there are none.
float step_around(const Tile& tile, int x, int y, float z) {
  float least = -1;
  for (int v = std::max(0, y - 2); v <= std::min(kTileSide - 1, y + 2); ++v)
    for (int u = std::max(0, x - 2); u <= std::min(kTileSide - 1, x + 2); ++u) {
      const GroundCell& cell = tile.cells[v * kTileSide + u];
      if (!cell.known) continue;
      const float d = std::abs(cell.z - z);
      if (least < 0 || d < least) least = d;
    }
  return least;
}

}  // namespace

void SurfaceMap::clear() {
  tiles_.clear();
  free_.clear();
  heads_.clear();
  queue_.clear();
  places_.clear();
  team_.clear();
  stairs_.clear();
  extent_ = {};
  blocks_.clear();
  used_ = 0;
  last_ = -1;
}

void SurfaceMap::raise(float by) {
  for (int i = 0; i < size(); ++i) {
    Tile& t = tile(i);
    if (!t.used) continue;
    t.z += by;
    for (GroundCell& cell : t.cells)
      if (cell.known) cell.z += by;
    for (int n = 0; n < t.node_count; ++n) t.nodes[n].z += by;
    if (!areas_.empty()) mark_dirty(i);
  }
  for (BlockedPlace& place : places_) place.z += double{by};
  for (TeamPlace& robot : team_) robot.place.z() += double{by};
  for (Staircase& stairs : stairs_) stairs.foot.z() += double{by};
}

void SurfaceMap::set_areas(const AreaSet& areas) {
  const AreaSet before = std::exchange(areas_, areas);  // So that a copy of `areas` is quickly the same.
  if (before == areas_) return;
  const AreaChange change(before, areas_);
  for (int i = 0; i < size(); ++i)
    if (tile(i).used && change.concerns(tile(i))) mark_dirty(i);
}

void SurfaceMap::mark_stairs(const Staircase& stairs) {
  const Eigen::Vector2d middle = (stairs.foot + stairs.top()).head<2>() / 2;
  const double reach = (length_of(stairs) + stairs.width) / 2 + kStairsApproach;
  const int cells = route_cell(reach) + 1 + kTileHalo, ix = route_cell(middle.x()),
            iy = route_cell(middle.y());
  for (int ty = tile_of(iy - cells); ty <= tile_of(iy + cells); ++ty)
    for (int tx = tile_of(ix - cells); tx <= tile_of(ix + cells); ++tx)
      for (int i = first(tx, ty); i >= 0; i = tile(i).next) mark_dirty(i);
}

void SurfaceMap::lay_stairs(const Staircase& stairs) {
  visit_cells(stairs, kLanding, [&](int ix, int iy, const OnStairs& place) {
    const auto z = static_cast<float>(tread_height(stairs, place.along));
    const int index = surface_layer(ix, iy, z);
    GroundCell& cell = tile(index).cells[cell_in_tile(ix, iy)];
    if (cell.known && (cell.blocked || (cell.sure && !cell.guessed()))) return;
    cell.z = z;
    cell.known = cell.measured = cell.sure = cell.of_stairs = true;
    cell.range = kRangeOnFoot;
  });
  mark_stairs(stairs);
}

// What scans showed of a step from afar went with it: it was no better than the staircase.
void SurfaceMap::remove_stairs(const Staircase& stairs) {
  visit_cells(stairs, kLanding, [&](int ix, int iy, const OnStairs& place) {
    constexpr float kRounding = 1e-3f;  // m
    const auto z = static_cast<float>(tread_height(stairs, place.along));
    for (int i = first(tile_of(ix), tile_of(iy)); i >= 0; i = tile(i).next) {
      GroundCell& cell = tile(i).cells[cell_in_tile(ix, iy)];
      if (!cell.of_stairs || std::abs(cell.z - z) > kRounding) continue;
      if (cell.evidence > 0) {  // Of an obstacle, which is there without the staircase as well.
        cell.measured = cell.sure = cell.of_stairs = false;
        cell.range = GroundCell{}.range;
      } else {
        cell = {};
      }
    }
  });
  mark_stairs(stairs);
}

void SurfaceMap::set_stairs(std::span<const Staircase> stairs) {
  stairs = stairs.first(std::min(stairs.size(), kMaxStairs));
  const std::vector<Staircase> before = std::move(stairs_);
  stairs_.clear();
  for (const Staircase& each : stairs) {
    const auto same =
        std::ranges::find_if(before, [&](const Staircase& b) { return leads_the_same(b, each); });
    stairs_.push_back(same == before.end() ? each : *same);
  }
  const auto lacks = [](const std::vector<Staircase>& all, const Staircase& one) {
    return std::ranges::find(all, one) == all.end();
  };
  bool removed = false;
  for (const Staircase& old : before)
    if (lacks(stairs_, old)) remove_stairs(old), removed = true;
  // Where two staircases meet, the ground of the one that stays was that of the other as well.
  for (const Staircase& each : stairs_)
    if (removed || lacks(before, each)) lay_stairs(each);
}

int SurfaceMap::first(int tx, int ty) const {
  const auto found = heads_.find(grid_key(tx, ty));
  return found == heads_.end() ? -1 : found->second;
}

int SurfaceMap::at(int tx, int ty, double z) const {
  int best = -1;
  double least = kFloorSeparation;
  for (int i = first(tx, ty); i >= 0; i = tile(i).next)
    if (const double d = std::abs(tile(i).z - z); d <= least) {
      least = d;
      best = i;
    }
  return best;
}

int SurfaceMap::at_cell(int ix, int iy, double z) const {
  const auto c = static_cast<std::size_t>(cell_in_tile(ix, iy));
  int best = -1, beyond = -1;
  double least = kFloorSeparation, near = kFloorSeparation;
  for (int i = first(tile_of(ix), tile_of(iy)); i >= 0; i = tile(i).next) {
    const GroundCell& cell = tile(i).cells[c];
    if (const double d = std::abs(cell.z - z); cell.known && d <= least) {
      least = d;
      best = i;
    }
    if (const double d = std::abs(tile(i).z - z); !cell.known && d <= near) {
      near = d;
      beyond = i;
    }
  }
  return best >= 0 ? best : beyond;
}

// Selects the floor by the heights along the common side; for a corner, or where these are unknown, by the
// heights of the tiles.
int SurfaceMap::beside(const Tile& t, int dx, int dy) const {
  const int only = first(t.tx + dx, t.ty + dy);
  if (only < 0) return -1;
  constexpr int last = kTileSide - 1;
  int best = -1;
  float least = kFloorSeparation;
  for (int i = only; i >= 0; i = tile(i).next) {
    const Tile& other = tile(i);
    float sum = 0;
    int count = 0;
    for (int k = 0; k < kTileSide && (dx == 0 || dy == 0); ++k) {
      const int x = dx == 0 ? k : dx > 0 ? last : 0, y = dy == 0 ? k : dy > 0 ? last : 0;
      const int u = dx == 0 ? k : last - x, v = dy == 0 ? k : last - y;
      const GroundCell& p = t.cells[y * kTileSide + x];
      const GroundCell& q = other.cells[v * kTileSide + u];
      if (!p.known || !q.known) continue;
      sum += std::abs(p.z - q.z);
      ++count;
    }
    const float d = count > 0 ? sum / static_cast<float>(count) : std::abs(other.z - t.z);
    if (d <= least) {
      least = d;
      best = i;
    }
  }
  return best;
}

// Finds the floor that a height belongs to: the one whose cell there has that height, else one with
// continuous neighbouring cells, else the nearest one without neighbouring cells.
int SurfaceMap::surface_layer(int ix, int iy, float z) {
  const int tx = tile_of(ix), ty = tile_of(iy);
  const auto c = static_cast<std::size_t>(cell_in_tile(ix, iy));
  const auto same = [&](const Tile& t) { return t.cells[c].known && std::abs(t.cells[c].z - z) <= same_; };
  const bool again = last_ >= 0 && tile(last_).tx == tx && tile(last_).ty == ty;
  if (again && same(tile(last_))) return last_;
  if (!again) last_first_ = first(tx, ty);
  int best = -1;
  float least = kFloorSeparation;
  for (int i = last_first_; i >= 0; i = tile(i).next) {
    const Tile& t = tile(i);
    if (same(t)) return last_ = i;
    if (t.cells[c].known && (t.cells[c].blocked || !t.cells[c].guessed())) continue;
    const float step = step_around(t, ix & 15, iy & 15, z);
    if (step > same_) continue;
    // A continuous neighbour wins over any floor that is merely near.
    const float d = step >= 0 ? step - 2 * same_ : std::abs(t.z - z);
    if (d <= least) {
      least = d;
      best = i;
    }
  }
  return last_ = best >= 0 ? best : create(tx, ty, z);
}

int SurfaceMap::create(int tx, int ty, float z) {
  if (used_ >= params_.tiles) evict();
  int index;
  if (free_.empty()) {
    index = size();
    tiles_.push_back(std::make_unique<Tile>());
  } else {
    index = free_.back();
    free_.pop_back();
    tile(index) = Tile{};
  }
  ++used_;
  Tile& t = tile(index);
  t.tx = tx;
  t.ty = ty;
  t.z = z;
  t.used = true;
  if (const int head = first(tx, ty); head >= 0) {
    int i = head;
    while (tile(i).next >= 0) i = tile(i).next;
    tile(i).next = index;
    t.beside = tile(head).beside;
  } else {
    heads_[grid_key(tx, ty)] = last_first_ = index;
    blocks_.add(tx, ty);
    link(index);
  }
  extent_.add(tx, ty);
  mark_dirty(index);
  return index;
}

void SurfaceMap::link(int index) {
  Tile& t = tile(index);
  for (std::size_t k = 0; k < 8; ++k) {
    const int other = first(t.tx + kAroundX[k], t.ty + kAroundY[k]);
    t.beside[k] = other;
    for (int i = other; i >= 0; i = tile(i).next) tile(i).beside[kOpposite[k]] = index;
  }
}

// Removes all floors of the farthest places: several at once, because each look for them visits all tiles.
void SurfaceMap::evict() {
  constexpr int kShare = 256;  // One of so many tiles.
  struct Place {
    double range;
    int head;
  };
  std::vector<Place> places;
  places.reserve(heads_.size());
  for (int i = 0; i < size(); ++i) {
    const Tile& t = tile(i);
    if (!t.used || first(t.tx, t.ty) != i) continue;
    const double x = (t.tx + 0.5) * kTileSide * kRouteCell, y = (t.ty + 0.5) * kTileSide * kRouteCell;
    places.push_back({std::hypot(x - x_, y - y_), i});
  }
  const auto count = std::min<std::size_t>(places.size(), std::max(1, params_.tiles / kShare));
  const auto last = places.begin() + static_cast<std::ptrdiff_t>(count);
  std::ranges::partial_sort(places, last, [](const Place& a, const Place& b) {
    return a.range > b.range || (a.range == b.range && a.head < b.head);
  });
  for (auto place = places.begin(); place != last; ++place) remove_place(place->head);
  extent_ = {};
  for (auto place = last; place != places.end(); ++place)
    extent_.add(tile(place->head).tx, tile(place->head).ty);
  std::erase_if(queue_, [this](int i) { return !tile(i).used; });
  last_ = -1;
}

void SurfaceMap::remove_place(int head) {
  for (std::size_t k = 0; k < 8; ++k)
    for (int i = tile(head).beside[k]; i >= 0; i = tile(i).next) tile(i).beside[kOpposite[k]] = -1;
  heads_.erase(grid_key(tile(head).tx, tile(head).ty));
  blocks_.remove(tile(head).tx, tile(head).ty);
  for (int i = head; i >= 0;) {
    Tile& t = tile(i);
    t.used = t.dirty = false;
    free_.push_back(i);
    --used_;
    i = t.next;
  }
}

void SurfaceMap::begin_scan(double x, double y) {
  if (++scan_ == 0) scan_ = 1;  // 0: no scan has hit a cell yet.
  x_ = x;
  y_ = y;
}

void SurfaceMap::mark_dirty(int index) {
  if (tile(index).dirty) return;
  tile(index).dirty = true;
  queue_.push_back(index);
}

// An obstacle also reduces the clearance in the neighbouring tiles.
void SurfaceMap::mark_around(const Tile& t, int ix, int iy, bool doubtful_only) {
  const int lx = ix & 15, ly = iy & 15;
  const int dx = lx < kTileHalo ? -1 : lx >= kTileSide - kTileHalo ? 1 : 0;
  const int dy = ly < kTileHalo ? -1 : ly >= kTileSide - kTileHalo ? 1 : 0;
  // Ground of another floor is an edge of this one.
  for (int i = first(t.tx, t.ty); i >= 0; i = tile(i).next)
    if (tile(i).has_doubts) mark_dirty(i);
  for (std::size_t k = 0; k < 8; ++k) {
    const bool near_x = kAroundX[k] == 0 || kAroundX[k] == dx, near_y = kAroundY[k] == 0 || kAroundY[k] == dy;
    if (!near_x || !near_y) continue;
    for (int i = t.beside[k]; i >= 0; i = tile(i).next)
      if ((!doubtful_only || tile(i).has_doubts) && std::abs(tile(i).z - t.z) <= 2 * kFloorSeparation)
        mark_dirty(i);
  }
}

double SurfaceMap::range_of(int ix, int iy) const {
  return std::hypot((ix + 0.5) * kRouteCell - x_, (iy + 0.5) * kRouteCell - y_);
}

bool SurfaceMap::is_near(int ix, int iy) const { return range_of(ix, iy) < double{kSureRange}; }

// The error of a height is that of the attitude times the range: a Kalman filter with the range in place of
// the standard deviation. The range of the estimate has a lower limit, so that the height follows the
// odometry's. Scans from one place share their errors, so only a scan from near makes a height sure.
bool SurfaceMap::update_height(GroundCell& cell, float z, float range, bool measured) {
  constexpr float kMinRange = 1.0f;  // m
  const bool was_measured = cell.measured, was_sure = cell.sure;
  const float before = static_cast<float>(cell.range) * kRangeUnit;
  float combined = std::max(range, kMinRange);
  if (!cell.known) {
    cell.z = z;
  } else if (measured && !cell.measured) {
    // One measurement from afar is no better than the mean of many heights that were interpolated.
    if (before <= kSureRange && range > kSureRange) return false;
    cell.z = z;
  } else if (measured == cell.measured) {
    cell.z += before * before / (before * before + combined * combined) * (z - cell.z);
    combined = std::max(kMinRange, before * combined / std::hypot(before, combined));
  } else {
    // An interpolated height does not change a measured one: from afar stairs look like a ramp.
    return false;
  }
  cell.known = true;
  cell.measured = measured;
  cell.range =
      static_cast<std::uint8_t>(std::min(GroundCell::kNoRange - 1.0f, std::ceil(combined / kRangeUnit)));
  cell.sure = cell.sure || range <= kSureRange;
  return cell.sure != was_sure || cell.measured != was_measured;
}

void SurfaceMap::see_free(int ix, int iy, float z, float height, Seen seen) {
  const bool certain = seen == Seen::stood_on, measured = seen != Seen::between;
  const float range = seen >= Seen::given ? 0.0f : static_cast<float>(range_of(ix, iy));
  const int index = surface_layer(ix, iy, z);
  Tile& t = tile(index);
  GroundCell& cell = t.cells[cell_in_tile(ix, iy)];
  // From near, scans show the ground themselves.
  const bool shows_step = cell.of_stairs && measured && range <= kSureRange && cell.evidence <= 0;
  if (!cell.known || shows_step) {
    cell = {};
    (void)update_height(cell, z, range, measured);
    mark_dirty(index);
    // A step between two cells is known with the second one. TileBuilder searches it over four cells, and
    // farther among heights that are not sure.
    const int x = ix & 15, y = iy & 15;
    mark_around(t, ix, iy, x >= 4 && y >= 4 && x <= 11 && y <= 11);
    return;
  }
  const float before = cell.z;
  if (!cell.of_stairs && update_height(cell, z, range, measured)) mark_around(t, ix, iy, true);
  if (std::abs(cell.z - before) > 0.02f) mark_dirty(index);
  if (std::abs(cell.z - before) > 0.05f) mark_around(t, ix, iy);  // A step may have appeared or disappeared.
  if (certain) cell.evidence = std::min<std::int8_t>(cell.evidence, 1);
  if (cell.evidence <= kMinEvidence || (cell.scan == scan_ && !certain)) return;
  if (cell.blocked && height > static_cast<float>(cell.obstacle_height) * kObstacleHeightUnit + 0.05f) return;
  cell.evidence = static_cast<std::int8_t>(cell.evidence - kRay);
  if (!cell.blocked || cell.evidence > kFree) return;
  cell.blocked = false;
  if (!cell.of_stairs) {  // Its height was measured before the obstacle appeared.
    cell.known = cell.measured = cell.sure = false;
    (void)update_height(cell, z, range, measured);
  }
  cell.obstacle_height = 0;
  mark_dirty(index);
  mark_around(t, ix, iy);
}

void SurfaceMap::clear_obstacle(const Eigen::Vector3d& place) {
  const int ix = route_cell(place.x()), iy = route_cell(place.y());
  const int index = at_cell(ix, iy, place.z());
  if (index < 0) return;
  GroundCell& cell = tile(index).cells[cell_in_tile(ix, iy)];
  if (!cell.blocked) return;
  cell.blocked = false;
  cell.evidence = 0;
  cell.obstacle_height = 0;
  mark_dirty(index);
  mark_around(tile(index), ix, iy);
}

void SurfaceMap::see_obstacle(float x, float y, float z, float obstacle_height, bool sure) {
  const int ix = route_cell(x), iy = route_cell(y);
  const int index = surface_layer(ix, iy, z);
  Tile& t = tile(index);
  GroundCell& cell = t.cells[cell_in_tile(ix, iy)];
  if (!cell.known) {
    cell = {.z = z, .known = true};
    mark_dirty(index);
  }
  const bool was_sure = cell.sure;
  const std::uint8_t height_before = cell.obstacle_height;
  cell.sure = cell.sure || sure || is_near(ix, iy);
  cell.obstacle_height =
      std::max(cell.obstacle_height,
               static_cast<std::uint8_t>(std::clamp(obstacle_height / kObstacleHeightUnit, 0.0f, 255.0f)));
  // What was only doubtful may block now.
  if (cell.blocked && (cell.sure != was_sure || cell.obstacle_height != height_before))
    mark_around(t, ix, iy, true);
  if (cell.scan == scan_ && !sure) return;
  cell.scan = scan_;
  // Averages over the first scans; a certain obstacle keeps its position.
  if (cell.evidence < kMaxEvidence || sure) {
    const int before = sure ? 0 : std::max(0, int{cell.evidence}) / kHit;
    const auto mean = [&](std::int8_t& aside, double at, int i) {
      const double off = std::clamp((at - (i + 0.5) * kRouteCell) / double{kAsideUnit}, -125.0, 125.0);
      aside = static_cast<std::int8_t>(std::lround((before * aside + off) / (before + 1)));
    };
    mean(cell.aside_x, x, ix);
    mean(cell.aside_y, y, iy);
    if (cell.blocked) mark_dirty(index), mark_around(t, ix, iy);
  }
  cell.evidence =
      static_cast<std::int8_t>(sure ? kMaxEvidence : std::min(cell.evidence + kHit, kMaxEvidence));
  if (cell.blocked || cell.evidence < kBlocked) return;
  cell.blocked = true;
  mark_dirty(index);
  mark_around(t, ix, iy);
}

double SurfaceMap::team_cost(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  constexpr double kSameFloor = 1.0;  // m
  const Eigen::Vector2d way = (to - from).head<2>();
  const double length = way.norm();
  double cost = 0.0;
  for (const TeamPlace& robot : team_) {
    if (length < 1e-6 || std::fabs((from.z() + to.z()) / 2 - robot.place.z()) > kSameFloor) continue;
    const Eigen::Vector2d to_robot = (robot.place - from).head<2>();
    const double along = to_robot.dot(way) / length;
    const double half2 = robot.radius * robot.radius - to_robot.squaredNorm() + along * along;
    if (half2 <= 0.0) continue;
    const double half = std::sqrt(half2);
    const double chord = std::min(along + half, length) - std::max(along - half, 0.0);
    if (chord > 0.0) cost += robot.cost * chord / (2 * robot.radius);
  }
  return cost;
}

void SurfaceMap::mark_place(const BlockedPlace& place) {
  const int reach = route_cell(place.radius) + 1 + kTileHalo;
  const int ix = route_cell(place.x), iy = route_cell(place.y);
  for (int ty = tile_of(iy - reach); ty <= tile_of(iy + reach); ++ty)
    for (int tx = tile_of(ix - reach); tx <= tile_of(ix + reach); ++tx)
      for (int i = first(tx, ty); i >= 0; i = tile(i).next) mark_dirty(i);
}

void SurfaceMap::block(const Eigen::Vector3d& at, double now) {
  const auto same = std::ranges::find_if(places_, [&](const BlockedPlace& p) {
    return std::hypot(p.x - at.x(), p.y - at.y()) < kSamePlace && std::abs(p.z - at.z()) < kFloorSeparation;
  });
  BlockedPlace place{at.x(), at.y(), at.z(), params_.block_radius, 0, 1, true};
  if (same != places_.end()) {
    place.times = std::min(same->times + 1, kMaxTimes);
    places_.erase(same);
  } else if (places_.size() >= kPlaces) {
    mark_place(places_.front());
    places_.erase(places_.begin());
  }
  place.until = now + params_.block_time * std::exp2(place.times - 1);
  places_.push_back(place);
  mark_place(place);
}

bool SurfaceMap::has_blocked_places() const { return std::ranges::any_of(places_, &BlockedPlace::active); }

void SurfaceMap::unblock_last() {
  if (places_.empty()) return;
  BlockedPlace& place = places_.back();
  place.active = false;
  place.times = std::max(0, place.times - 1);
  mark_place(place);
}

void SurfaceMap::expire(double now) {
  for (BlockedPlace& place : places_)
    if (place.active && place.until <= now) {
      place.active = false;
      mark_place(place);
    }
}

int SurfaceMap::next_dirty() {
  while (!queue_.empty()) {
    const int index = queue_.front();
    queue_.pop_front();
    if (tile(index).dirty) return index;  // Otherwise it has been rebuilt already.
  }
  return -1;
}

}  // namespace adit::nav
