// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/floors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace adit::gui {
namespace {

using station::MapTile;
using station::VoxelRun;

constexpr std::size_t kCells = std::size_t{MapTile::kSide} * MapTile::kSide;
constexpr double kRobotArea = 10.0;  // A robot alone makes the height where it is a floor, m2.
constexpr double kTrailArea = 0.4;   // Of a point of a trail, m2.
constexpr double kMinShare = 0.5;    // Of the area within 1 m that lies within 0.3 m.
constexpr double kRounding = 1e-6;   // Voxels.
constexpr double kOverhang = 1.5;    // Above the ground, m.
constexpr int kNone = std::numeric_limits<int>::min();
constexpr double kBelow = 0.5;  // How far what stands on a floor may be below it, m.

/// Calls `act(begin, end)` for the runs of each column.
template <class Act>
void for_columns(const std::vector<VoxelRun>& runs, Act&& act) {
  for (std::size_t begin = 0, end = 0; begin < runs.size(); begin = end) {
    while (end < runs.size() && runs[end].cell == runs[begin].cell) ++end;
    act(begin, end);
  }
}

/// Index of the lowest voxel of the gap above a run.
int top_of(const VoxelRun& run) { return run.z + run.length; }

}  // namespace

int Floors::bin_of(double z) {
  return std::clamp(static_cast<int>(std::floor(z / kBin)) + kBins / 2, 0, kBins - 1);
}

Floors::Histogram Floors::ground_of(const MapTile& tile, double resolution) {
  Histogram out;
  const double area = resolution * resolution;
  for_columns(tile.runs, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i + 1 < end; ++i) {  // Nothing is above the last run.
      const double free = (tile.runs[i + 1].z - top_of(tile.runs[i])) * resolution;
      if (free >= kFree && free <= kCeiling) out[bin_of((top_of(tile.runs[i]) + 0.5) * resolution)] += area;
    }
  });
  return out;
}

void Floors::show(const station::TileMap& map) {
  if (map.resolution != resolution_) {
    tiles_.clear();
    std::ranges::fill(ground_, 0.0);
  }
  resolution_ = map.resolution;
  const auto take = [this](const Histogram& ground, double sign) {
    for (const auto& [bin, area] : ground) ground_[static_cast<std::size_t>(bin)] += sign * area;
  };
  std::erase_if(tiles_, [&](const auto& known) {
    if (map.tiles.contains(known.first)) return false;
    take(known.second.ground, -1.0);
    return true;
  });
  for (const auto& [place, tile] : map.tiles) {
    Tile& known = tiles_[place];
    if (known.tile == tile) continue;
    take(known.ground, -1.0);
    known = {tile, ground_of(*tile, resolution_)};
    take(known.ground, 1.0);
  }
}

void Floors::learn_reference(const station::World& world) {
  for (const station::StationSummary& station : world.stations)
    if (station.self && station.place && std::abs((*station.place)[2]) < 1e4F) {
      reference_ = (*station.place)[2];
      by_station_ = true;
      return;
    }
  if (reference_) return;
  for (const station::Robot& robot : world.robots)
    if (robot.located && std::abs(robot.z) < 1e4F) {
      reference_ = robot.z;  // Of the first one, where it was first: the names stay while it drives.
      return;
    }
}

bool Floors::show(const station::World& world, const Trails& trails) {
  learn_reference(world);
  std::vector<double> area = ground_;
  const auto add = [&area](double z, double by) {
    if (std::abs(z) < 1e4) area[static_cast<std::size_t>(bin_of(z))] += by;
  };
  for (const station::Robot& robot : world.robots) {
    if (!robot.located || robot.platform == "aerial") continue;
    add(robot.z, kRobotArea);
    if (const Trails::Trail* trail = trails.of(robot.name))
      for (const Trails::Stamped& point : trail->points) add(point.z, kTrailArea);
  }
  const auto sum = [&area](int bin, int reach) {
    double out = 0.0;
    for (int i = std::max(bin - reach, 0); i <= std::min(bin + reach, kBins - 1); ++i)
      out += area[static_cast<std::size_t>(i)];
    return out;
  };
  struct Peak {
    double area{};
    int bin{};
  };
  std::vector<Peak> peaks;
  for (int bin = 0; bin < kBins; ++bin) {
    if (area[static_cast<std::size_t>(bin)] <= 0.0) continue;
    const double near = sum(bin, 1);
    if (near >= kMinArea && near >= kMinShare * sum(bin, 5)) peaks.push_back({near, bin});
  }
  // The largest first; of equal ones the bin that itself has more.
  std::ranges::sort(peaks, [&](const Peak& a, const Peak& b) {
    return std::tuple(-a.area, -area[static_cast<std::size_t>(a.bin)], a.bin) <
           std::tuple(-b.area, -area[static_cast<std::size_t>(b.bin)], b.bin);
  });
  std::vector<Floor> floors;
  for (const Peak& peak : peaks) {
    // Its lower edge: ground is rounded up to whole voxels.
    const double z = (peak.bin - kBins / 2) * kBin;
    const bool apart = std::ranges::all_of(
        floors, [z](const Floor& floor) { return std::abs(floor.z - z) >= kApart - 1e-9; });
    if (apart && floors.size() < kMost) floors.push_back({.z = z});
  }
  std::ranges::sort(floors, {}, &Floor::z);
  std::size_t zero = 0;
  const double reference = reference_.value_or(0.0);
  for (std::size_t i = 0; i < floors.size(); ++i)
    if (std::abs(floors[i].z - reference) < std::abs(floors[zero].z - reference)) zero = i;
  for (std::size_t i = 0; i < floors.size(); ++i) {
    const int number = static_cast<int>(i) - static_cast<int>(zero);
    floors[i].name = (number > 0 ? "+" : "") + std::to_string(number);
  }
  return std::exchange(floors_, floors) != floors_;
}

std::optional<std::size_t> Floors::floor_at(double z) const {
  if (floors_.empty() || !(std::abs(z) < 1e5)) return std::nullopt;
  std::size_t out = 0;
  for (std::size_t i = 0; i < floors_.size(); ++i)
    if (floors_[i].z - kBelow <= z) out = i;
  return out;
}

void slice_cells(const MapTile& tile, double resolution, const Floor& floor,
                 std::vector<std::uint8_t>& cells) {
  cells.assign(kCells, MapTile::kUnknown);
  if (tile.cells.size() != kCells) return;
  for (std::size_t i = 0; i < kCells; ++i)
    if (tile.cells[i] != MapTile::kUnknown)
      cells[i] = static_cast<std::uint8_t>(kGhost + std::min<int>(tile.cells[i], 127));
  const Slice slice = slice_of(floor);
  const int low = static_cast<int>(std::floor(slice.low / resolution + kRounding)),
            high = static_cast<int>(std::ceil(slice.high / resolution - kRounding)),
            ground = static_cast<int>(std::lround(floor.z / resolution)),
            gap = static_cast<int>(std::ceil(Floors::kFree / resolution)),
            overhang = static_cast<int>(std::ceil(kOverhang / resolution)),
            step = static_cast<int>(std::lround(0.3 / resolution));
  for_columns(tile.runs, [&](std::size_t begin, std::size_t end) {
    int top = kNone;
    for (std::size_t i = begin; i < end; ++i) {
      const VoxelRun& run = tile.runs[i];
      if (top_of(run) <= low) continue;
      if (run.z >= high) break;
      // The underside of something high, and the ground below it was not seen.
      if (top == kNone && run.z - ground >= overhang) break;
      // What is higher above something than a robot is its ceiling.
      if (top != kNone && run.z - top >= gap) break;
      top = std::min(top_of(run), high);
    }
    const std::size_t cell = tile.runs[begin].cell;
    if (top == kNone || cell >= kCells) return;
    const int height = top - ground;
    cells[cell] = height <= step ? MapTile::kGround
                                 : static_cast<std::uint8_t>(MapTile::kThing + std::min(height, 120) - 1);
  });
}

double ground_at(const station::TileMap& map, const Floor& floor, const Point& place) {
  if (!drawable(place.x, place.y) || !(map.resolution > 0.0)) return floor.z;
  const int column = static_cast<int>(std::floor(place.x / map.resolution)),
            row = static_cast<int>(std::floor(place.y / map.resolution));
  const auto tile_of = [](int cell) {
    return static_cast<int>(std::floor(static_cast<double>(cell) / MapTile::kSide));
  };
  const auto tile = map.tiles.find({tile_of(column), tile_of(row)});
  if (tile == map.tiles.end()) return floor.z;
  const int cell =
      (row - tile_of(row) * MapTile::kSide) * MapTile::kSide + column - tile_of(column) * MapTile::kSide;
  const Slice slice = slice_of(floor);
  double ground = floor.z;
  for (const VoxelRun& run : tile->second->runs) {
    if (run.cell != cell) continue;
    const double top = top_of(run) * map.resolution;
    if (top < slice.low || top > slice.high) continue;
    ground = top;
    break;  // The lowest one.
  }
  return ground;
}

}  // namespace adit::gui
