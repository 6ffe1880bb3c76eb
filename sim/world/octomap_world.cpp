// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/world/octomap_file.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {
namespace {

enum State : std::uint8_t { unknown, known_free, occupied, opened };

/// What a map says of each cell of its bounding box.
struct Cells {
  int nx, ny, nz;
  std::vector<std::uint8_t> state;

  std::uint8_t& at(int i, int j, int k) { return state[(static_cast<std::size_t>(k) * ny + j) * nx + i]; }
  bool open(int i, int j, int k) {
    const std::uint8_t s = at(i, j, k);
    return s == known_free || s == opened;
  }
};

/// Opens unknown cells that have known free space within `reach` cells on opposite sides, along x or along y.
void open_gaps(Cells& cells, int reach) {
  // Distance to the last free cell behind, then ahead, along one line of cells.
  const auto line = [&](auto&& cell, int length) {
    std::vector<int> behind(length);
    int since = reach + 1;
    for (int n = 0; n < length; ++n) {
      since = cell(n) == known_free ? 0 : since + 1;
      behind[n] = since;
    }
    since = reach + 1;
    for (int n = length - 1; n >= 0; --n) {
      since = cell(n) == known_free ? 0 : since + 1;
      if (cell(n) == unknown && since <= reach && behind[n] <= reach) cell(n) = opened;
    }
  };
  for (int k = 0; k < cells.nz; ++k) {
    for (int j = 0; j < cells.ny; ++j)
      line([&](int n) -> std::uint8_t& { return cells.at(n, j, k); }, cells.nx);
    for (int i = 0; i < cells.nx; ++i)
      line([&](int n) -> std::uint8_t& { return cells.at(i, n, k); }, cells.ny);
  }
}

/// Puts the lowest open cell of a column onto a floor at layer `floor`.
void lay_floor(Cells& cells, int i, int j, int lowest, int floor) {
  for (int k = 0; k < std::min(floor, cells.nz); ++k)
    if (cells.open(i, j, k)) cells.at(i, j, k) = unknown;
  for (int k = lowest - 1; k >= floor && cells.at(i, j, k) == unknown; --k) cells.at(i, j, k) = opened;
}

/// A column whose lowest open cell has nothing occupied under it takes the lowest floor among its neighbours,
/// wave by wave from the floors that were seen.
void fill_floors(Cells& cells) {
  constexpr int none = -1;
  std::vector<int> floor(static_cast<std::size_t>(cells.nx) * cells.ny, none), lowest = floor;
  std::vector<std::pair<int, int>> missing;
  for (int j = 0; j < cells.ny; ++j)
    for (int i = 0; i < cells.nx; ++i) {
      int k = 0;
      while (k < cells.nz && !cells.open(i, j, k)) ++k;
      if (k == cells.nz) continue;
      lowest[j * cells.nx + i] = k;
      if (k > 0 && cells.at(i, j, k - 1) == occupied)
        floor[j * cells.nx + i] = k;
      else
        missing.emplace_back(i, j);
    }
  while (!missing.empty()) {
    std::vector<std::pair<int, int>> left;
    std::vector<std::array<int, 3>> found;
    for (const auto& [i, j] : missing) {
      int best = none;
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) {
          const int a = i + di, b = j + dj;
          if (a < 0 || b < 0 || a >= cells.nx || b >= cells.ny) continue;
          const int f = floor[b * cells.nx + a];
          if (f != none && (best == none || f < best)) best = f;
        }
      if (best == none)
        left.emplace_back(i, j);
      else
        found.push_back({i, j, best});
    }
    if (found.empty()) return;
    for (const auto& [i, j, f] : found) {
      floor[j * cells.nx + i] = f;
      lay_floor(cells, i, j, lowest[j * cells.nx + i], f);
    }
    missing = std::move(left);
  }
}

}  // namespace

Result<World> load_octomap(const std::filesystem::path& file) {
  const Result<OctomapFile> map = read_octomap_file(file);
  if (!map) return map.error();
  std::array<std::int64_t, 3> low{1 << 20, 1 << 20, 1 << 20}, high{-(1 << 20), -(1 << 20), -(1 << 20)};
  for (const OctreeLeaf& leaf : map->leaves) {
    const std::int64_t corner[3] = {leaf.x, leaf.y, leaf.z};
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], corner[axis]);
      high[axis] = std::max(high[axis], corner[axis] + leaf.size);
    }
  }
  const std::int64_t nx = high[0] - low[0], ny = high[1] - low[1], nz = high[2] - low[2];
  if (nx * ny * nz > VoxelGrid::kMaxCells)
    return {Reason::not_supported, fmt::format("{}: {} x {} x {} cells are too many (at most {})",
                                               file.string(), nx, ny, nz, VoxelGrid::kMaxCells)};
  Cells cells{static_cast<int>(nx), static_cast<int>(ny), static_cast<int>(nz),
              std::vector<std::uint8_t>(static_cast<std::size_t>(nx * ny * nz), unknown)};
  for (const OctreeLeaf& leaf : map->leaves)
    for (int z = leaf.z; z < leaf.z + leaf.size; ++z)
      for (int y = leaf.y; y < leaf.y + leaf.size; ++y)
        for (int x = leaf.x; x < leaf.x + leaf.size; ++x)
          cells.at(x - static_cast<int>(low[0]), y - static_cast<int>(low[1]), z - static_cast<int>(low[2])) =
              leaf.occupied ? occupied : known_free;
  open_gaps(cells, static_cast<int>(0.5 / map->resolution + 1e-6));
  fill_floors(cells);

  const double r = map->resolution;
  std::vector<double> levels;
  for (std::int64_t z = low[2]; z <= high[2]; ++z) levels.push_back(static_cast<double>(z) * r);
  VoxelGrid grid({static_cast<double>(low[0]) * r, static_cast<double>(low[1]) * r}, r, cells.nx, cells.ny,
                 std::move(levels), false);
  for (int k = 0; k < cells.nz; ++k)
    for (int j = 0; j < cells.ny; ++j)
      for (int i = 0; i < cells.nx; ++i) grid.set(i, j, k, !cells.open(i, j, k));
  grid.build();
  return World(file.filename().string(), std::move(grid));
}

}  // namespace adit::sim
