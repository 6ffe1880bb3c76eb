// SPDX-License-Identifier: Apache-2.0
#include "perception/map/export/grid_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <optional>
#include <ostream>

namespace adit::perception {
namespace {

constexpr double kSpread = 2.0;             ///< m
constexpr std::size_t kMaxCells = 1 << 28;  ///< Of a plan.

std::uint8_t cell_at(const VoxelImage& image, int x, int y, int ground, int low, int high) {
  bool free = false;
  for (int z = ground + low; z <= ground + high; ++z) {
    const Voxel voxel = image.at(VoxelIndex{x, y, z});
    if (voxel == Voxel::occupied) return FloorPlan::kOccupied;
    free = free || voxel == Voxel::free;
  }
  return free ? FloorPlan::kFree : FloorPlan::kUnknown;
}

}  // namespace

Result<FloorPlan> floor_plan(const VoxelImage& image, std::size_t floor, const HeightBand& band) {
  const std::vector<Floor> floors = find_floors(image);
  if (floors.empty()) return {Reason::map_empty, "there is no ground in the map yet"};
  if (floor >= floors.size())
    return {Reason::out_of_range, "the map has " + std::to_string(floors.size()) + " floors, counted from 0"};
  const double r = image.resolution();
  const int margin = static_cast<int>(std::ceil(kSpread / r));
  const std::vector<VoxelIndex>& ground = floors[floor].ground;
  VoxelIndex low = ground.front(), high = ground.front();
  for (const VoxelIndex& v : ground) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), 0};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), 0};
  }
  FloorPlan plan;
  plan.resolution = r;
  plan.width = high.x - low.x + 1 + 2 * margin;
  plan.height = high.y - low.y + 1 + 2 * margin;
  plan.origin = {(low.x - margin) * r, (low.y - margin) * r};
  const std::size_t cells = static_cast<std::size_t>(plan.width) * static_cast<std::size_t>(plan.height);
  if (cells > kMaxCells)
    return {Reason::out_of_range, "the floor is too large for a picture: save it coarser"};
  plan.cells.assign(cells, FloorPlan::kUnknown);
  std::vector<std::optional<int>> height(cells);
  std::deque<std::pair<int, int>> open;  // Cell, rings from the ground.
  for (const VoxelIndex& v : ground) {
    const int cell = v.x - low.x + margin + plan.width * (v.y - low.y + margin);
    height[static_cast<std::size_t>(cell)] = v.z;
    open.push_back({cell, 0});
  }
  const int first = std::max(1, static_cast<int>(std::ceil(band.low / r + 1e-6)));
  const int last = std::max(first, static_cast<int>(std::floor(band.high / r + 1e-6)));
  while (!open.empty()) {
    const auto [cell, rings] = open.front();
    open.pop_front();
    const int x = cell % plan.width, y = cell / plan.width;
    const int z = *height[static_cast<std::size_t>(cell)];
    plan.cells[static_cast<std::size_t>(cell)] =
        cell_at(image, x + low.x - margin, y + low.y - margin, z, first, last);
    if (rings >= margin) continue;
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{-1, 0}, std::pair{0, 1}, std::pair{0, -1}}) {
      if (x + dx < 0 || x + dx >= plan.width || y + dy < 0 || y + dy >= plan.height) continue;
      const int next = cell + dx + plan.width * dy;
      if (height[static_cast<std::size_t>(next)]) continue;
      height[static_cast<std::size_t>(next)] = z;
      open.push_back({next, rings + 1});
    }
  }
  return plan;
}

Result<void> write_pgm(const FloorPlan& plan, std::ostream& to) {
  if (plan.cells.empty()) return {Reason::map_empty, "there is no map yet"};
  to << "P5\n" << plan.width << ' ' << plan.height << "\n255\n";
  for (int y = plan.height - 1; y >= 0; --y)
    to.write(reinterpret_cast<const char*>(plan.cells.data()) + static_cast<std::ptrdiff_t>(y) * plan.width,
             plan.width);
  if (!to) return {Reason::cannot_write, "the plan cannot be written"};
  return {};
}

Result<void> write_map_yaml(const FloorPlan& plan, const std::string& image, std::ostream& to) {
  std::string quoted;
  for (const char c : image) {
    if (c == '"' || c == '\\') quoted.push_back('\\');
    quoted.push_back(c);
  }
  to << "image: \"" << quoted << "\"\nmode: trinary\nresolution: " << plan.resolution << "\norigin: ["
     << plan.origin.x() << ", " << plan.origin.y()
     << ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  if (!to) return {Reason::cannot_write, "the plan cannot be written"};
  return {};
}

}  // namespace adit::perception
