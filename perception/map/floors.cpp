// SPDX-License-Identifier: Apache-2.0
#include "perception/map/floors.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>

namespace adit::perception {
namespace {

constexpr double kHeadroom = 0.4;  ///< Free space above ground, m.

/// Heights of ground of each column (x, y), in voxels, rising.
using Columns = std::map<std::pair<int, int>, std::vector<int>>;

Columns find_ground(const VoxelImage& image) {
  const int headroom = std::max(1, static_cast<int>(std::lround(kHeadroom / image.resolution())));
  Columns columns;
  image.for_each([&](const VoxelIndex& v, Voxel voxel) {
    if (voxel != Voxel::occupied) return;
    for (int up = 1; up <= headroom; ++up)
      if (image.at(VoxelIndex{v.x, v.y, v.z + up}) != Voxel::free) return;
    columns[{v.x, v.y}].push_back(v.z);
  });
  for (auto& [column, heights] : columns) std::sort(heights.begin(), heights.end());
  return columns;
}

/// The height at which most ground is that no floor has; the lowest of several. Nothing without ground.
std::optional<int> commonest_height(const Columns& left) {
  std::map<int, std::size_t> cells;
  for (const auto& [column, heights] : left)
    for (const int z : heights) ++cells[z];
  const auto most = std::max_element(cells.begin(), cells.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == cells.end()) return std::nullopt;
  return most->first;
}

/// Takes one floor out of the ground: from all ground at the height `z0` to its neighbours, the nearest in
/// height to z0 first.
std::vector<VoxelIndex> take_floor(Columns& left, int z0, int step) {
  using Candidate = std::tuple<int, int, int, int>;  // |z - z0|, x, y, z
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> open;
  std::map<std::pair<int, int>, int> floor;
  for (const auto& [column, heights] : left)
    if (std::binary_search(heights.begin(), heights.end(), z0))
      open.push({0, column.first, column.second, z0});
  while (!open.empty()) {
    const auto [rise, x, y, z] = open.top();
    open.pop();
    if (!floor.try_emplace({x, y}, z).second) continue;
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{-1, 0}, std::pair{0, 1}, std::pair{0, -1}}) {
      const auto next = left.find({x + dx, y + dy});
      if (next == left.end() || floor.contains(next->first)) continue;
      for (const int height : next->second)
        if (std::abs(height - z) <= step) open.push({std::abs(height - z0), x + dx, y + dy, height});
    }
  }
  std::vector<VoxelIndex> out;
  for (const auto& [column, z] : floor) {
    out.push_back({column.first, column.second, z});
    const auto at = left.find(column);
    std::erase(at->second, z);
    if (at->second.empty()) left.erase(at);
  }
  return out;
}

}  // namespace

std::vector<Floor> find_floors(const VoxelImage& image, double max_step, double min_area) {
  const double r = image.resolution();
  const int step = std::max(1, static_cast<int>(std::floor(max_step / r + 1e-6)));
  Columns left = find_ground(image);
  std::vector<Floor> floors;
  for (std::optional<int> z = commonest_height(left); z; z = commonest_height(left)) {
    std::vector<VoxelIndex> ground = take_floor(left, *z, step);
    if (static_cast<double>(ground.size()) * r * r < min_area) continue;
    floors.push_back({(*z + 1) * r, std::move(ground)});
  }
  std::stable_sort(floors.begin(), floors.end(),
                   [](const Floor& a, const Floor& b) { return a.height < b.height; });
  return floors;
}

}  // namespace adit::perception
