// SPDX-License-Identifier: Apache-2.0
#include "nav/local_map/local_map_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace adit::nav {
namespace {

/// What is so near to the surface of a mover belongs to it: as far as a person walks while three scans pass,
/// after which its traces are seen to be free, m.
constexpr float kBesideMover = 0.35f;

constexpr float kLargestRobot = 2.0f;  ///< Radius, m: what other robots claim is bounded.
/// Errors of the poses of both robots, and the trace of one that drives until it is seen to be free, m.
constexpr float kPeerErrors = 0.3f;

/// Height of the terrain map's datum above the odometry frame, m. The map is level where the odometry is
/// tilted about the robot.
struct Datum {
  Datum(const TerrainMap& terrain, const Pose3& body)
      : height(static_cast<float>(terrain.height_correction())),
        rise(terrain.tilt_error()),
        from(body.position.head<2>().cast<float>()) {}
  float at(const Eigen::Vector2f& place) const { return height + rise.dot(place - from); }

  float height;
  Eigen::Vector2f rise, from;
};

std::uint8_t cost_of(float cost) {
  if (cost >= 1.0f) return LocalCell::kImpassable;
  return static_cast<std::uint8_t>(std::clamp(std::ceil(cost * 254.0f), 0.0f, 254.0f));
}

std::int8_t aside_of(float metres) {
  return static_cast<std::int8_t>(std::lround(std::clamp(metres / LocalCell::kAsideUnit, -127.0f, 127.0f)));
}

}  // namespace

std::shared_ptr<LocalMap> LocalMapBuilder::begin(const LocalMapScan& scan) {
  constexpr std::size_t kMaxMaps = 8;
  std::shared_ptr<LocalMap> map;
  if (const auto unused = std::ranges::find(made_, 1, &std::shared_ptr<LocalMap>::use_count);
      unused != made_.end()) {
    map = *unused;
    // Returning a share synchronises with the thread that returned the last one.
    std::shared_ptr<LocalMap>(map).reset();
  } else {
    map = std::make_shared<LocalMap>();
    if (made_.size() < kMaxMaps) made_.push_back(map);
  }
  map->scan_ = scan;
  if (map->is_placed()) {
    map->x0_ = LocalMap::cell(static_cast<float>(scan.body.position.x())) - LocalMap::kSide / 2;
    map->y0_ = LocalMap::cell(static_cast<float>(scan.body.position.y())) - LocalMap::kSide / 2;
  } else {
    map->x0_ = map->y0_ = LocalMap::kNowhere;
  }
  map->cells_.resize(std::size_t{LocalMap::kSide} * LocalMap::kSide);
  map->places_.clear();
  return map;
}

std::shared_ptr<const LocalMap> LocalMapBuilder::make(const TerrainMap& terrain, const LocalMapScan& scan,
                                                      const LocalMapOthers& others) {
  auto map = begin(scan);
  write_places(terrain, map->places_);
  if (!map->is_placed() || !terrain.ground().grown()) clear(*map);
  if (map->is_placed()) {
    if (terrain.ground().grown()) write_ground(terrain, *map);
    write_obstacles(terrain, *map);
    mark(others, *map);
  }
  return map;
}

std::shared_ptr<const LocalMap> LocalMapBuilder::make(const AirMap& air, const LocalMapScan& scan,
                                                      const LocalMapOthers& others) {
  auto map = begin(scan);
  clear(*map);
  map->places_.reserve(AirMap::kMax);
  for (const Eigen::Vector2f& place : air.cells()) {
    map->places_.push_back({.x = place.x(), .y = place.y(), .kind = CellClass::obstacle});
    if (!LocalMap::is_place(place.x(), place.y())) continue;
    const int ix = LocalMap::cell(place.x()), iy = LocalMap::cell(place.y());
    if (!map->inside(ix, iy)) continue;
    LocalCell& cell = map->cells_[LocalMap::index(ix, iy)];
    cell.kind = CellClass::obstacle;
    cell.cost = LocalCell::kImpassable;
  }
  if (map->is_placed()) mark(others, *map);
  return map;
}

void LocalMapBuilder::write_places(const TerrainMap& terrain, std::vector<LocalPlace>& places) {
  const GroundGrid& ground = terrain.ground();
  const int side = ground.side(), cells = static_cast<int>(ground.cells());
  kinds_.assign(ground.cells(), CellClass::unknown);
  costs_.assign(ground.cells(), 0);
  places.reserve(terrain.max_places());
  if (!ground.grown()) return;
  for (int k = 0; k < cells; ++k)
    if (ground.measured(k)) kinds_[k] = CellClass::ground;
  for (const ObstacleCells::Entry& entry : terrain.obstacles().entries())
    if (entry.again)
      places.push_back({entry.mean_x, entry.mean_y, 1.0f, terrain.age(entry), CellClass::obstacle});
  const auto write = [&](int index, const Eigen::Vector2f& at, float cost, CellClass kind) {
    places.push_back({at.x(), at.y(), cost, 0.0f, kind});
    // These have a place for each of their cells; the others have one for every second cell.
    const bool single = kind == CellClass::drop || (kind == CellClass::step && cost >= 1);
    for (const int k : {index, index + 1, index + side, index + side + 1}) {
      if (k == index || (k < cells && ground.measured(k))) {
        costs_[k] = std::max(costs_[k], cost_of(cost));
        const bool sure = single && cost >= 1;
        if (sure ? kinds_[k] != CellClass::drop : kinds_[k] == CellClass::ground && !single) kinds_[k] = kind;
      }
      if (single) break;
    }
  };
  const auto write_drop = [&](int index) {
    const Eigen::Vector2f at = ground.middle(index);
    if (kinds_[index] != CellClass::drop && !terrain.is_on_stairs(at))
      write(index, at, 1.0f, CellClass::drop);
  };
  for (const Drops::Cell& cell : terrain.drops().cells()) {
    const int index = static_cast<int>(cell.index), i = index / side, j = index % side;
    const Eigen::Vector2f at = ground.middle(index);
    if (terrain.is_on_stairs(at)) continue;
    if (cell.probability < Drops::kBlocks) {
      write(index, at, cell.probability, CellClass::drop);
      continue;
    }
    write_drop(index);
    if (i == 0 || j == 0 || i == side - 1 || j == side - 1) continue;
    // The last cell of the ground before a drop belongs to it, because it may begin anywhere in it.
    for (const int beside : {index - side, index - 1, index + 1, index + side})
      if (ground.measured(beside)) write_drop(beside);
  }
  for (const Surface::Place& place : terrain.surface().places()) {
    const auto index = static_cast<int>(place.index);
    write(index, ground.middle(index), place.cost, place.kind);
  }
}

void LocalMapBuilder::clear(LocalMap& map) { std::ranges::fill(map.cells_, LocalCell{}); }

// A cell of the terrain's ground is as wide as two of the map, whose rows lie along x and the ground's along
// y. A few rows of the map at a time, so that those of both stay in the processor's cache.
void LocalMapBuilder::write_ground(const TerrainMap& terrain, LocalMap& map) {
  static_assert(GroundGrid::kCell == 2 * LocalMap::kCell);
  constexpr int kTogether = 4;
  const GroundGrid& ground = terrain.ground();
  const int side = ground.side();
  const Datum datum(terrain, map.scan_.body);
  const Eigen::Vector2f first = ground.middle(0);
  const int ix0 = LocalMap::cell(first.x() - LocalMap::kCell / 2),
            iy0 = LocalMap::cell(first.y() - LocalMap::kCell / 2);
  const auto row_at = [&map](int iy) {
    return map.inside(map.x0_, iy) ? &map.cells_[LocalMap::index(0, iy)] : nullptr;
  };
  const auto clear_row = [](LocalCell* row) { std::fill_n(row, LocalMap::kSide, LocalCell{}); };
  for (int iy = map.y0_; iy < map.y0_ + LocalMap::kSide; ++iy)
    if (iy < iy0 || iy >= iy0 + 2 * side) clear_row(row_at(iy));
  for (int begin = 0; begin < side; begin += kTogether) {
    const int count = std::min(kTogether, side - begin);
    std::array<LocalCell*, kTogether> rows{}, copies{};
    for (int n = 0; n < count; ++n) {
      rows[n] = row_at(iy0 + 2 * (begin + n));
      copies[n] = row_at(iy0 + 2 * (begin + n) + 1);
      if (!rows[n]) std::swap(rows[n], copies[n]);
      if (rows[n]) clear_row(rows[n]);
    }
    for (int i = 0; i < side; ++i) {
      const int ix = ix0 + 2 * i;
      for (int n = 0; n < count; ++n) {
        if (!rows[n]) continue;
        const int j = begin + n, k = i * side + j;
        LocalCell cell;
        cell.low = ground.height(k) - datum.at(ground.middle(i, j));
        cell.measured = ground.measured(k);
        cell.fresh = ground.fresh(k);
        cell.kind = kinds_[k];
        cell.cost = costs_[k];
        for (const int dx : {0, 1})
          if (map.inside(ix + dx, map.y0_)) rows[n][LocalMap::index(ix + dx, 0)] = cell;
      }
    }
    for (int n = 0; n < count; ++n)
      if (copies[n]) std::copy_n(rows[n], LocalMap::kSide, copies[n]);
  }
}

void LocalMapBuilder::write_obstacles(const TerrainMap& terrain, LocalMap& map) {
  const Datum datum(terrain, map.scan_.body);
  for (const ObstacleCells::Entry& entry : terrain.obstacles().entries()) {
    if (!entry.again || !map.inside(entry.ix, entry.iy)) continue;
    LocalCell& cell = map.cells_[LocalMap::index(entry.ix, entry.iy)];
    cell.high = entry.z_high - datum.at({entry.x(), entry.y()});
    cell.aside_x = aside_of(entry.mean_x - entry.x());
    cell.aside_y = aside_of(entry.mean_y - entry.y());
    cell.cost = LocalCell::kImpassable;
    if (cell.kind != CellClass::drop) cell.kind = CellClass::obstacle;
  }
}

template <class Change>
void LocalMapBuilder::visit_disc(LocalMap& map, const Eigen::Vector2f& at, float radius, Change&& change) {
  constexpr double kFarthest = 20.0;  // No place farther away touches the map, m.
  const Eigen::Vector2d from = map.scan_.body.position.head<2>();
  if (!((at.cast<double>() - from).norm() < kFarthest)) return;  // Also where it is no number.
  for (int iy = LocalMap::cell(at.y() - radius); iy <= LocalMap::cell(at.y() + radius); ++iy)
    for (int ix = LocalMap::cell(at.x() - radius); ix <= LocalMap::cell(at.x() + radius); ++ix) {
      const float dx = LocalMap::centre(ix) - at.x(), dy = LocalMap::centre(iy) - at.y();
      if (map.inside(ix, iy) && dx * dx + dy * dy <= radius * radius)
        change(map.cells_[LocalMap::index(ix, iy)]);
    }
}

void LocalMapBuilder::mark(const LocalMapOthers& others, LocalMap& map) {
  for (const Eigen::Vector2f& place : others.moving)
    visit_disc(map, place, kBesideMover, [](LocalCell& cell) {
      if (cell.kind == CellClass::obstacle) cell.kind = CellClass::mover;
    });
  for (LocalPlace& place : map.places_)
    if (place.kind == CellClass::obstacle)
      if (const LocalCell* cell = map.find(place.x, place.y); cell && cell->kind == CellClass::mover)
        place.kind = CellClass::mover;
  for (const Eigen::Vector3f& peer : others.peers)
    if (peer.z() > 0.0f)
      visit_disc(map, peer.head<2>(), std::min(peer.z(), kLargestRobot) + kPeerErrors,
                 [](LocalCell& cell) { cell.peer = true; });
}

}  // namespace adit::nav
