// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/voxel_scene.hpp"

#include <algorithm>
#include <cmath>

namespace adit::gui {
namespace {

using station::MapTile;
using Brick = VoxelScene::Brick;
using Voxel = VoxelScene::Voxel;

constexpr int kPerTile = MapTile::kSide / VoxelScene::kSide;

/// Half of it, rounded down.
std::int16_t half(int z) { return static_cast<std::int16_t>(z >= 0 ? z / 2 : -((1 - z) / 2)); }

Voxel voxel_at(int x, int y, int z) {
  Voxel out;
  out.x = static_cast<unsigned>(x) % VoxelScene::kSide;
  out.y = static_cast<unsigned>(y) % VoxelScene::kSide;
  out.z = static_cast<std::int16_t>(z);
  return out;
}

std::vector<Voxel> coarser(const std::vector<Voxel>& fine) {
  std::vector<Voxel> out;
  out.reserve(fine.size());
  for (const Voxel& voxel : fine) out.push_back(voxel_at(voxel.x / 2, voxel.y / 2, half(voxel.z)));
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  out.shrink_to_fit();
  return out;
}

/// Which voxels of one level of a tile stand in the open, in a grid with an empty rim. A tile that is too
/// tall for it keeps all of its sides.
void find_sides(std::vector<Brick>& bricks, const MapTile& tile, int level, double edge) {
  constexpr int kTallest = 1000;  // Voxels.
  int low = INT16_MAX, high = INT16_MIN;
  for (const Brick& brick : bricks)
    for (const Voxel& voxel : brick.levels[static_cast<std::size_t>(level)]) {
      low = std::min<int>(low, voxel.z);
      high = std::max<int>(high, voxel.z);
    }
  const int side = VoxelScene::kSide >> level;
  const std::ptrdiff_t row = (MapTile::kSide >> level) + 2, layer = row * row;
  std::vector<std::uint8_t> filled;
  if (high - low < kTallest) filled.resize(static_cast<std::size_t>(std::max(high - low + 3, 0) * layer));
  const auto each = [&](auto&& act) {
    for (Brick& brick : bricks) {
      const auto column_of = [&](double corner, int index) {
        const double from_tile = corner / edge - static_cast<double>(index) * MapTile::kSide;
        return static_cast<int>(std::lround(from_tile)) / VoxelScene::kSide * side;
      };
      const std::ptrdiff_t first =
          (1 - low) * layer + (column_of(brick.y, tile.y) + 1) * row + column_of(brick.x, tile.x) + 1;
      for (Voxel& voxel : brick.levels[static_cast<std::size_t>(level)])
        act(voxel, first + voxel.z * layer + voxel.y * row + voxel.x);
    }
  };
  if (filled.empty()) return each([](Voxel& voxel, std::ptrdiff_t) { voxel.sides = VoxelScene::all; });
  each([&](Voxel&, std::ptrdiff_t at) { filled[static_cast<std::size_t>(at)] = 1; });
  const std::array<std::ptrdiff_t, 6> beside{-1, 1, -row, row, -layer, layer};
  each([&](Voxel& voxel, std::ptrdiff_t at) {
    unsigned sides = 0;
    for (std::size_t i = 0; i < beside.size(); ++i)
      sides |= filled[static_cast<std::size_t>(at + beside[i])] ? 0U : 1U << i;
    voxel.sides = sides & VoxelScene::all;
  });
}

std::vector<Brick> bricks_of(const MapTile& tile, double edge) {
  std::array<Brick, static_cast<std::size_t>(kPerTile) * kPerTile> parts{};
  for (const station::VoxelRun& run : tile.runs) {
    const int column = run.cell % MapTile::kSide, row = run.cell / MapTile::kSide;
    Brick& brick =
        parts[static_cast<std::size_t>(row / VoxelScene::kSide * kPerTile + column / VoxelScene::kSide)];
    for (int z = run.z; z < run.z + run.length && z <= INT16_MAX; ++z)
      brick.levels[0].push_back(voxel_at(column, row, z));
  }
  std::vector<Brick> out;
  for (int i = 0; i < kPerTile * kPerTile; ++i) {
    Brick& brick = parts[static_cast<std::size_t>(i)];
    if (brick.levels[0].empty()) continue;
    brick.x = (static_cast<double>(tile.x) * MapTile::kSide + i % kPerTile * VoxelScene::kSide) * edge;
    brick.y = (static_cast<double>(tile.y) * MapTile::kSide + i / kPerTile * VoxelScene::kSide) * edge;
    brick.first = {VoxelScene::kSide, VoxelScene::kSide};
    for (const Voxel& voxel : brick.levels[0]) {
      brick.first = {std::min<int>(brick.first[0], voxel.x), std::min<int>(brick.first[1], voxel.y)};
      brick.last = {std::max<int>(brick.last[0], voxel.x), std::max<int>(brick.last[1], voxel.y)};
      ++brick.heights[voxel.z];
    }
    brick.low = brick.heights.begin()->first * edge;
    brick.high = (brick.heights.rbegin()->first + 1) * edge;
    for (std::size_t level = 1; level < VoxelScene::kLevels; ++level)
      brick.levels[level] = coarser(brick.levels[level - 1]);
    out.push_back(std::move(brick));
  }
  for (int level = 0; level < VoxelScene::kLevels; ++level) find_sides(out, tile, level, edge);
  return out;
}

}  // namespace

void VoxelScene::show(const station::TileMap& map) {
  if (map.resolution != edge_) tiles_.clear();
  edge_ = map.resolution;
  bool changed = std::erase_if(tiles_, [&](const auto& tile) { return !map.tiles.contains(tile.first); }) > 0;
  for (const auto& [place, tile] : map.tiles) {
    Tile& known = tiles_[place];
    if (known.tile == tile) continue;
    known = {tile, bricks_of(*tile, edge_)};
    changed = true;
  }
  if (changed || tiles_.empty()) measure();
}

void VoxelScene::measure() {
  voxels_ = 0;
  low_ = {1e9, 1e9, 1e9};
  high_ = {-1e9, -1e9, -1e9};
  heights_.clear();
  for (const Brick* brick : bricks()) {
    voxels_ += brick->levels[0].size();
    for (const auto& [z, count] : brick->heights) heights_[z] += count;
  }
  for (const Point3& corner : corners(-1e9, 1e9)) {
    low_ = {std::min(low_.x, corner.x), std::min(low_.y, corner.y), std::min(low_.z, corner.z)};
    high_ = {std::max(high_.x, corner.x), std::max(high_.y, corner.y), std::max(high_.z, corner.z)};
  }
}

std::vector<Point3> VoxelScene::corners(double from, double to) const {
  std::vector<Point3> out;
  for (const Brick* brick : bricks()) {
    if (brick->low >= to || brick->high <= from) continue;
    for (const int x : {brick->first[0], brick->last[0] + 1})
      for (const int y : {brick->first[1], brick->last[1] + 1})
        for (const double z : {std::max(brick->low, from), std::min(brick->high, to)})
          out.push_back({brick->x + x * edge_, brick->y + y * edge_, z});
  }
  return out;
}

std::vector<const Brick*> VoxelScene::bricks() const {
  std::vector<const Brick*> out;
  for (const auto& [place, tile] : tiles_)
    for (const Brick& brick : tile.bricks) out.push_back(&brick);
  return out;
}

}  // namespace adit::gui
