// SPDX-License-Identifier: Apache-2.0
#include "sim/navtool/world_route.hpp"

#include <algorithm>
#include <cmath>

namespace adit::sim {
namespace {

/// Heights of all floors of a column with so much open above them, m.
void floors_of(const VoxelGrid& grid, int i, int j, double headroom, std::vector<double>& floors) {
  floors.clear();
  if (!grid.inside(i, j)) return;
  const std::vector<double>& levels = grid.levels();
  for (int k = 0; k < grid.layers(); ++k) {
    if (grid.solid(i, j, k)) continue;
    const int bottom = k;
    while (k < grid.layers() && !grid.solid(i, j, k)) ++k;
    const double floor = levels[static_cast<std::size_t>(bottom)];
    if (levels[static_cast<std::size_t>(k)] - floor >= headroom - 1e-6) floors.push_back(floor);
  }
}

/// The middles of the planner's cells that a column covers, or its own when it is smaller than they.
template <class Use>
void for_each_cell(const VoxelGrid& grid, int i, int j, const Use& use) {
  const int parts = std::max(1, static_cast<int>(std::ceil(grid.resolution() / nav::kRouteCell)));
  const Eigen::Vector2d corner = grid.centre(i, j) - Eigen::Vector2d::Constant(grid.resolution() / 2);
  for (int v = 0; v < parts; ++v)
    for (int u = 0; u < parts; ++u)
      use(corner + grid.resolution() * Eigen::Vector2d(u + 0.5, v + 0.5) / parts);
}

}  // namespace

void add_world(const World& world, const Platform& platform, nav::RoutePlanner& planner) {
  const VoxelGrid& grid = world.grid();
  const double headroom = std::max(platform.height, platform.lidar_height);
  std::vector<double> here, there;
  for (const bool obstacles : {false, true})
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) {
        floors_of(grid, i, j, headroom, here);
        for (const double z : here) {
          if (!obstacles) {
            for_each_cell(grid, i, j, [&](const Eigen::Vector2d& p) {
              planner.set_ground({p.x(), p.y(), z});
            });
            continue;
          }
          for (int dj = -1; dj <= 1; ++dj)
            for (int di = -1; di <= 1; ++di) {
              if (!grid.inside(i + di, j + dj) && grid.open_sides()) continue;
              floors_of(grid, i + di, j + dj, headroom, there);
              const bool goes_on = std::any_of(there.begin(), there.end(), [&](double other) {
                return std::abs(other - z) <= platform.step + grid.resolution() / 2;
              });
              if (!goes_on)
                for_each_cell(grid, i + di, j + dj, [&](const Eigen::Vector2d& p) {
                  planner.set_obstacle({p.x(), p.y(), z}, headroom);
                });
            }
        }
      }
  planner.finish();
}

}  // namespace adit::sim
