// SPDX-License-Identifier: Apache-2.0
#include "sim/world/flight_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adit::sim {

bool FlightSpace::solid(int i, int j, double low, double high) const {
  const VoxelGrid& grid = world_->grid();
  const auto& levels = grid.levels();
  if (low < levels.front() || high > levels.back()) return true;
  if (!grid.inside(i, j)) return !grid.open_sides();
  const auto above = std::upper_bound(levels.begin(), levels.end(), low);
  for (int k = static_cast<int>(above - levels.begin()) - 1; k < grid.layers(); ++k) {
    if (levels[static_cast<std::size_t>(k)] >= high) return false;
    if (grid.solid(i, j, k)) return true;
  }
  return false;
}

template <class Use>
void FlightSpace::each_column(const Rectangle& footprint, double reach, const Use& use) const {
  const VoxelGrid& grid = world_->grid();
  const double radius = footprint.radius() + reach;
  const Pose2& at = footprint.pose;
  for (int j = grid.column_y(at.y - radius); j <= grid.column_y(at.y + radius); ++j)
    for (int i = grid.column_x(at.x - radius); i <= grid.column_x(at.x + radius); ++i) {
      const Eigen::Vector2d middle = grid.centre(i, j);
      use(i, j, Rectangle{{middle.x(), middle.y(), 0.0}, grid.resolution(), grid.resolution()});
    }
}

bool FlightSpace::touches(const Rectangle& footprint, double low, double high) const {
  bool found = false;
  each_column(footprint, 0.0, [&](int i, int j, const Rectangle& cell) {
    found = found || (solid(i, j, low, high) && overlap(footprint, cell));
  });
  return found;
}

double FlightSpace::clearance(const Rectangle& footprint, double low, double high,
                              double max_distance) const {
  double nearest = max_distance;
  each_column(footprint, max_distance, [&](int i, int j, const Rectangle& cell) {
    const double away = (cell.pose.position() - footprint.pose.position()).norm();
    if (away - footprint.radius() - cell.radius() < nearest && solid(i, j, low, high))
      nearest = std::min(nearest, distance(footprint, cell));
  });
  return nearest;
}

double FlightSpace::ceiling(const Rectangle& footprint, double from) const {
  const VoxelGrid& grid = world_->grid();
  const auto& levels = grid.levels();
  double lowest = levels.back();
  const auto above = std::upper_bound(levels.begin(), levels.end(), from);
  const int first = std::max(0, static_cast<int>(above - levels.begin()) - 1);
  each_column(footprint, 0.0, [&](int i, int j, const Rectangle& cell) {
    if (!grid.inside(i, j) || !overlap(footprint, cell)) return;
    for (int k = first; k < grid.layers() && levels[static_cast<std::size_t>(k)] < lowest; ++k)
      if (grid.solid(i, j, k)) lowest = std::max(from, levels[static_cast<std::size_t>(k)]);
  });
  return lowest;
}

}  // namespace adit::sim
