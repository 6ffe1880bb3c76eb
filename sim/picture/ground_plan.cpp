// SPDX-License-Identifier: Apache-2.0
#include "sim/picture/ground_plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace adit::sim {
namespace {

/// The level (rounded to 0.05 m) of most columns that have a floor.
double common_floor(const World& world, double headroom) {
  std::map<long, int> votes;
  for (int j = 0; j < world.grid().ny(); ++j)
    for (int i = 0; i < world.grid().nx(); ++i)
      if (const double z = world.column_floor(i, j, headroom); !std::isnan(z)) ++votes[std::lround(z / 0.05)];
  const auto most = std::max_element(votes.begin(), votes.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == votes.end() ? 0.0 : static_cast<double>(most->first) * 0.05;
}

/// Whether the column has an open cell between two heights.
bool open_between(const VoxelGrid& grid, int i, int j, double low, double high) {
  for (int k = 0; k < grid.layers(); ++k)
    if (grid.levels()[k + 1] > low && grid.levels()[k] < high && !grid.solid(i, j, k)) return true;
  return false;
}

/// Grows the shown part by every patch of floor of at least a square metre.
void frame(GroundPlan& plan, const VoxelGrid& grid) {
  const double r = grid.resolution();
  std::vector<std::uint8_t> seen(plan.kind.size(), 0);
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (std::size_t n = 0; n < plan.kind.size(); ++n) {
    if (seen[n] || plan.kind[n] != GroundPlan::floor) continue;
    std::vector<std::size_t> patch{n};
    seen[n] = 1;
    for (std::size_t next = 0; next < patch.size(); ++next) {
      const int i = static_cast<int>(patch[next] % plan.nx), j = static_cast<int>(patch[next] / plan.nx);
      for (const auto& [a, b] : {std::pair{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}}) {
        if (!grid.inside(a, b)) continue;
        const std::size_t m = static_cast<std::size_t>(b) * plan.nx + a;
        if (seen[m] || plan.kind[m] != GroundPlan::floor) continue;
        seen[m] = 1;
        patch.push_back(m);
      }
    }
    if (static_cast<double>(patch.size()) * r * r < 1.0) continue;
    for (const std::size_t m : patch) {
      const Eigen::Vector2d p = grid.centre(static_cast<int>(m % plan.nx), static_cast<int>(m / plan.nx));
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  const bool any = low.x() < high.x();
  plan.low = any ? Eigen::Vector2d(low - Eigen::Vector2d::Constant(0.5)) : grid.origin();
  plan.high = any ? Eigen::Vector2d(high + Eigen::Vector2d::Constant(0.5))
                  : Eigen::Vector2d(grid.origin() + r * Eigen::Vector2d(plan.nx, plan.ny));
}

}  // namespace

GroundPlan make_ground_plan(const World& world, double headroom) {
  const VoxelGrid& grid = world.grid();
  const double floor = common_floor(world, headroom);
  constexpr double tolerance = 0.3, overhead = 1.9;
  GroundPlan plan{
      grid.nx(),
      grid.ny(),
      std::vector<GroundPlan::Kind>(static_cast<std::size_t>(grid.nx()) * grid.ny(), GroundPlan::unknown),
      {},
      {}};
  const auto at = [&](int i, int j) -> GroundPlan::Kind& {
    return plan.kind[static_cast<std::size_t>(j) * plan.nx + i];
  };
  for (int j = 0; j < plan.ny; ++j)
    for (int i = 0; i < plan.nx; ++i)
      if (const double z = world.column_floor(i, j, headroom); std::abs(z - floor) <= tolerance)
        at(i, j) = GroundPlan::floor;
  const int reach = std::max(1, static_cast<int>(std::lround(0.16 / grid.resolution())));
  for (int j = 0; j < plan.ny; ++j)
    for (int i = 0; i < plan.nx; ++i) {
      if (at(i, j) == GroundPlan::floor) continue;
      bool beside = false;
      for (int b = std::max(0, j - reach); b <= std::min(plan.ny - 1, j + reach); ++b)
        for (int a = std::max(0, i - reach); a <= std::min(plan.nx - 1, i + reach); ++a)
          beside = beside || at(a, b) == GroundPlan::floor;
      const bool above = open_between(grid, i, j, floor + overhead, floor + overhead + 0.3);
      if (beside)
        at(i, j) = above ? GroundPlan::furniture : GroundPlan::wall;
      else if (above)
        at(i, j) = GroundPlan::glimpsed;
    }
  frame(plan, grid);
  return plan;
}

}  // namespace adit::sim
