// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace adit::station {
namespace {

constexpr int kMaxZ = 32000;  // Voxels.
constexpr std::size_t kCells = std::size_t{MapTile::kSide} * MapTile::kSide;

std::uint8_t code_of(const TopView::Cell& cell) {
  if (cell.kind == TopView::Kind::unknown) return MapTile::kUnknown;
  if (cell.kind == TopView::Kind::ground) return MapTile::kGround;
  return static_cast<std::uint8_t>(std::min(255, MapTile::kThing + std::max<int>(cell.height, 1) - 1));
}

/// Quotient rounded down.
int floor_div(int value, int divisor) {
  return value >= 0 ? value / divisor : -((-value + divisor - 1) / divisor);
}

int tile_of(int cell) { return floor_div(cell, MapTile::kSide); }

}  // namespace

std::vector<MapTile> tiles_of(const perception::VoxelImage& image) {
  const TopView view(image);
  std::map<std::pair<int, int>, MapTile> tiles;
  // Tiles lie on one grid over the map frame, however far the view reaches.
  const int x0 = static_cast<int>(std::lround(view.low().x() / view.resolution()));
  const int y0 = static_cast<int>(std::lround(view.low().y() / view.resolution()));
  for (int y = 0; y < view.ny(); ++y)
    for (int x = 0; x < view.nx(); ++x) {
      const std::uint8_t code = code_of(view.at(x, y));
      if (code == MapTile::kUnknown) continue;
      const int cell_x = x0 + x, cell_y = y0 + y;
      const std::pair key{tile_of(cell_x), tile_of(cell_y)};
      MapTile& tile = tiles[key];
      if (tile.cells.empty()) {
        tile.x = key.first;
        tile.y = key.second;
        tile.cells.resize(kCells);
      }
      tile.cells[static_cast<std::size_t>(cell_y - key.second * MapTile::kSide) * MapTile::kSide +
                 static_cast<std::size_t>(cell_x - key.first * MapTile::kSide)] = code;
    }
  // Voxels of one column follow each other from below; columns of one row of a tile do not.
  for (const perception::VoxelIndex& index : image.occupied()) {
    const std::pair key{tile_of(index.x), tile_of(index.y)};
    const auto tile = tiles.find(key);
    if (tile == tiles.end() || std::abs(index.z) > kMaxZ) continue;  // The view is too large, or it is.
    const int cell =
        (index.y - key.second * MapTile::kSide) * MapTile::kSide + index.x - key.first * MapTile::kSide;
    std::vector<VoxelRun>& runs = tile->second.runs;
    if (!runs.empty() && runs.back().cell == cell && runs.back().z + runs.back().length == index.z)
      ++runs.back().length;
    else
      runs.push_back({static_cast<std::uint16_t>(cell), static_cast<std::int16_t>(index.z), 1});
  }
  std::vector<MapTile> out;
  for (auto& [key, tile] : tiles) {
    std::ranges::sort(tile.runs, {}, [](const VoxelRun& run) { return std::pair(run.cell, run.z); });
    if (tile.runs.size() > MapTile::kMaxRuns) tile.runs.resize(MapTile::kMaxRuns);
    out.push_back(std::move(tile));
  }
  return out;
}

void add_received(std::vector<MapTile>& tiles, const std::vector<MapPart>& parts, double resolution) {
  std::map<std::pair<int, int>, MapTile*> by_place;
  for (MapTile& tile : tiles) by_place[{tile.x, tile.y}] = &tile;
  const double edge = MapTile::kRegion * resolution;
  const auto note = [&](const Eigen::Vector3d& at, std::uint32_t received) {
    const int x = static_cast<int>(std::floor(at.x() / edge)),
              y = static_cast<int>(std::floor(at.y() / edge));
    const auto found = by_place.find({floor_div(x, MapTile::kRegions), floor_div(y, MapTile::kRegions)});
    if (found == by_place.end()) return;
    MapTile& tile = *found->second;
    if (tile.received.empty()) tile.received.resize(std::size_t{MapTile::kRegions} * MapTile::kRegions);
    std::uint32_t& newest = tile.received[static_cast<std::size_t>(
        (y - tile.y * MapTile::kRegions) * MapTile::kRegions + x - tile.x * MapTile::kRegions)];
    newest = std::max(newest, tile_clock(received));
  };
  constexpr double kSize = perception::BlockIndex::kSize, kInside = 0.05;  // m
  for (const MapPart& part : parts)
    for (std::size_t i = 0; i < part.blocks.size() && i < part.received.size(); ++i) {
      if (part.received[i] == 0) continue;
      const perception::BlockIndex& index = part.blocks[i].index;
      for (const double x : {kInside, kSize - kInside})
        for (const double y : {kInside, kSize - kInside})
          note(part.T_map_submap *
                   Eigen::Vector3d(index.x * kSize + x, index.y * kSize + y, (index.z + 0.5) * kSize),
               part.received[i]);
    }
}

void Tiles::show(double resolution, std::vector<MapTile> tiles) {
  resolution_ = resolution;
  std::set<std::pair<int, int>> shown;
  for (MapTile& tile : tiles) {
    const std::pair key{tile.x, tile.y};
    const auto known = tiles_.find(key);
    if (known == tiles_.end() && tiles_.size() == kMaxTiles) continue;
    shown.insert(key);
    if (known != tiles_.end() && known->second.cells == tile.cells && known->second.runs == tile.runs &&
        known->second.received == tile.received)
      continue;
    tile.revision = ++revision_;
    tiles_[key] = std::move(tile);
  }
  for (auto& [key, tile] : tiles_) {
    if (shown.contains(key) || std::ranges::all_of(tile.cells, [](std::uint8_t c) { return c == 0; }))
      continue;
    std::ranges::fill(tile.cells, MapTile::kUnknown);
    tile.runs.clear();
    tile.received.clear();
    tile.revision = ++revision_;
  }
}

MapUpdate Tiles::since(std::uint64_t revision, std::size_t most) const {
  std::vector<const MapTile*> changed;
  for (const auto& [key, tile] : tiles_)
    if (tile.revision > revision) changed.push_back(&tile);
  std::ranges::sort(changed, {}, [](const MapTile* tile) { return tile->revision; });
  MapUpdate update{.resolution = resolution_, .revision = revision_};
  if (changed.size() > most) {
    changed.resize(most);
    update.revision = changed.back()->revision;
  }
  for (const MapTile* tile : changed) update.tiles.push_back(*tile);
  return update;
}

}  // namespace adit::station
