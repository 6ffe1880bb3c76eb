// SPDX-License-Identifier: Apache-2.0
#include "sim/world/voxel_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "sim/world/noise.hpp"

namespace adit::sim {
namespace {

VoxelGrid random_grid(Random& random, bool open_sides, double density,
                      std::vector<double> levels = {0.0, 0.3, 0.4, 1.0, 1.7}) {
  VoxelGrid grid({-1.0, 2.0}, 0.1, 40, 30, std::move(levels), open_sides);
  for (int k = 0; k < grid.layers(); ++k)
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) grid.set(i, j, k, random.uniform() < density);
  grid.build();
  return grid;
}

/// Small steps along the ray: slow, and wrong by less than a step.
double march(const VoxelGrid& grid, const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
             double range) {
  constexpr double step = 0.0005;
  for (double t = 0.0; t < range; t += step) {
    const Eigen::Vector3d p = start + t * direction;
    if (p.z() < grid.levels().front() || p.z() >= grid.levels().back()) return t;
    const int i = grid.column_x(p.x()), j = grid.column_y(p.y());
    if (!grid.inside(i, j)) {
      if (grid.open_sides()) continue;
      return t;
    }
    if (grid.solid(i, j, grid.locate(p).k)) return t;
  }
  return VoxelGrid::kNoHit;
}

TEST(VoxelGrid, cast_agrees_with_marching) {
  Random random(7);
  int hits = 0;
  for (int round = 0; round < 600; ++round) {
    const bool open_sides = round % 2 == 0;
    const VoxelGrid grid = random_grid(random, open_sides, round % 3 == 0 ? 0.1 : 0.01);
    const Eigen::Vector3d start(-2.0 + 6.0 * random.uniform(), 1.0 + 5.0 * random.uniform(),
                                1.7 * random.uniform());
    Eigen::Vector3d direction(gaussian(random), gaussian(random), 0.3 * gaussian(random));
    if (round % 5 == 0) direction[round % 2] = 0.0;
    direction.normalize();
    const double expected = march(grid, start, direction, 4.0);
    const double range = grid.cast(grid.locate(start), direction, 4.0);
    // A ray that grazes a corner may hit in one method and slip by in the other within a step.
    if (std::isinf(expected) != std::isinf(range) ||
        (!std::isinf(range) && std::abs(range - expected) > 0.002)) {
      const double nearer = std::min(range, expected);
      const Eigen::Vector3d p = start + nearer * direction;
      const double fx = (p.x() + 1.0) / 0.1, fy = (p.y() - 2.0) / 0.1;
      EXPECT_TRUE(std::abs(fx - std::round(fx)) < 0.02 || std::abs(fy - std::round(fy)) < 0.02)
          << "round " << round << ": " << range << " expected " << expected;
    }
    hits += !std::isinf(range);
  }
  EXPECT_GT(hits, 300);
}

TEST(VoxelGrid, rays_cast_together_have_the_ranges_of_rays_cast_one_by_one) {
  Random random(11);
  std::vector<double> even;
  for (int n = 0; n <= 17; ++n) even.push_back(0.1 * n);
  for (int round = 0; round < 300; ++round) {
    const double density = round % 3 == 0 ? 0.1 : 0.002;
    const VoxelGrid grid = round % 4 < 2 ? random_grid(random, round % 2 == 0, density)
                                         : random_grid(random, round % 2 == 0, density, even);
    const Eigen::Vector3d start(-2.0 + 6.0 * random.uniform(), 1.0 + 5.0 * random.uniform(),
                                -0.1 + 1.9 * random.uniform());
    // A column of a lidar; in some rounds tilted, so that its rays do not all head the same way.
    const double azimuth = round % 7 == 0 ? M_PI / 2 * (round % 4) : 2 * M_PI * random.uniform();
    const double tilt = round % 5 == 0 ? 0.3 : 0.0;
    std::vector<Eigen::Vector3d> directions(1 + random.below(40));
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const double rise = -1.0 + 0.05 * static_cast<double>(n), aside = tilt * rise;
      directions[n] = Eigen::Vector3d(std::cos(azimuth) - aside * std::sin(azimuth),
                                      std::sin(azimuth) + aside * std::cos(azimuth), rise)
                          .normalized();
    }
    std::vector<double> together(directions.size(), -1.0), each(directions.size(), -2.0);
    grid.cast(grid.locate(start), directions, 4.0, together);
    grid.cast_each(grid.locate(start), directions, 4.0, each);
    ASSERT_EQ(together, each) << "round " << round;
  }
}

TEST(VoxelGrid, range_to_a_wall_is_exact) {
  VoxelGrid grid({0.0, 0.0}, 0.05, 100, 100, {0.0, 3.0}, true);
  for (int j = 0; j < 100; ++j)
    for (int i = 0; i < 100; ++i) grid.set(i, j, 0, i == 60);
  grid.build();
  const auto start = grid.locate({1.0, 2.5, 1.0});
  EXPECT_NEAR(grid.cast(start, {1, 0, 0}, 30.0), 2.0, 1e-9);
  const double s = std::sqrt(0.5);
  EXPECT_NEAR(grid.cast(start, {s, s, 0}, 30.0), 2.0 / s, 1e-9);
  EXPECT_EQ(grid.cast(start, {-1, 0, 0}, 30.0), VoxelGrid::kNoHit);
  EXPECT_EQ(grid.cast(start, {1, 0, 0}, 1.9), VoxelGrid::kNoHit);
  EXPECT_NEAR(grid.cast(start, {0, 0, -1}, 30.0), 1.0, 1e-9);
  EXPECT_NEAR(grid.cast(start, {-0.8, 0, -0.6}, 30.0), 1.0 / 0.6, 1e-9) << "the floor beside the grid";
}

TEST(VoxelGrid, a_start_in_the_solid_or_below_the_floor_hits_at_once) {
  VoxelGrid grid({0.0, 0.0}, 1.0, 3, 3, {0.0, 1.0}, false);
  grid.set(1, 1, 0, false);
  grid.build();
  EXPECT_EQ(grid.cast(grid.locate({0.5, 0.5, 0.5}), {1, 0, 0}, 9.0), 0.0);
  EXPECT_EQ(grid.cast(grid.locate({1.5, 1.5, -0.5}), {1, 0, 0}, 9.0), 0.0);
  EXPECT_EQ(grid.cast(grid.locate({-5.0, 1.5, 0.5}), {1, 0, 0}, 9.0), 0.0) << "beside a closed grid";
  EXPECT_NEAR(grid.cast(grid.locate({1.5, 1.5, 0.5}), {1, 0, 0}, 9.0), 0.5, 1e-12);
}

}  // namespace
}  // namespace adit::sim
