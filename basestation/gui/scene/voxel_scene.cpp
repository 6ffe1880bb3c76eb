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

std::vector<Voxel> coarser(const std::vector<Voxel>& fine) {
  std::vector<Voxel> out;
  out.reserve(fine.size());
  for (const Voxel& voxel : fine)
    out.push_back(
        {static_cast<std::uint8_t>(voxel.x / 2), static_cast<std::uint8_t>(voxel.y / 2), half(voxel.z)});
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  out.shrink_to_fit();
  return out;
}

std::vector<Brick> bricks_of(const MapTile& tile, double edge) {
  std::array<Brick, static_cast<std::size_t>(kPerTile) * kPerTile> parts{};
  for (const station::VoxelRun& run : tile.runs) {
    const int column = run.cell % MapTile::kSide, row = run.cell / MapTile::kSide;
    Brick& brick =
        parts[static_cast<std::size_t>(row / VoxelScene::kSide * kPerTile + column / VoxelScene::kSide)];
    for (int z = run.z; z < run.z + run.length && z <= INT16_MAX; ++z)
      brick.levels[0].push_back({static_cast<std::uint8_t>(column % VoxelScene::kSide),
                                 static_cast<std::uint8_t>(row % VoxelScene::kSide),
                                 static_cast<std::int16_t>(z)});
  }
  std::vector<Brick> out;
  for (int i = 0; i < kPerTile * kPerTile; ++i) {
    Brick& brick = parts[static_cast<std::size_t>(i)];
    if (brick.levels[0].empty()) continue;
    brick.x = (static_cast<double>(tile.x) * MapTile::kSide + i % kPerTile * VoxelScene::kSide) * edge;
    brick.y = (static_cast<double>(tile.y) * MapTile::kSide + i / kPerTile * VoxelScene::kSide) * edge;
    const auto [low, high] = std::ranges::minmax(brick.levels[0], {}, &Voxel::z);
    brick.low = low.z * edge;
    brick.high = (high.z + 1) * edge;
    for (std::size_t level = 1; level < VoxelScene::kLevels; ++level)
      brick.levels[level] = coarser(brick.levels[level - 1]);
    out.push_back(std::move(brick));
  }
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
  const double side = kSide * edge_;
  for (const Brick* brick : bricks()) {
    voxels_ += brick->levels[0].size();
    low_ = {std::min(low_.x, brick->x), std::min(low_.y, brick->y), std::min(low_.z, brick->low)};
    high_ = {std::max(high_.x, brick->x + side), std::max(high_.y, brick->y + side),
             std::max(high_.z, brick->high)};
  }
}

std::vector<const Brick*> VoxelScene::bricks() const {
  std::vector<const Brick*> out;
  for (const auto& [place, tile] : tiles_)
    for (const Brick& brick : tile.bricks) out.push_back(&brick);
  return out;
}

}  // namespace adit::gui
