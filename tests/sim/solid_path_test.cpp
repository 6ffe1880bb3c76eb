// SPDX-License-Identifier: Apache-2.0
#include "sim/world/solid_path.hpp"

#include <gtest/gtest.h>

#include "core/time/random.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {
namespace {

constexpr double kAll = 1e9;

World room(std::vector<Box> boxes) { return *make_box_world(boxes, 0.0, 3.0); }

TEST(SolidPath, AWallCountsByItsThicknessOnTheWay) {
  const World world = room({{4, 4.5, -5, 5, 0, 3}, {8, 10, -5, 5, 0, 3}});
  EXPECT_NEAR(solid_between(world.grid(), {0, 0, 1}, {6, 0, 1}, kAll), 0.5, 1e-9);
  EXPECT_NEAR(solid_between(world.grid(), {6, 0, 1}, {0, 0, 1}, kAll), 0.5, 1e-9);
  EXPECT_NEAR(solid_between(world.grid(), {0, 0, 1}, {12, 0, 1}, kAll), 2.5, 1e-9);
  EXPECT_NEAR(solid_between(world.grid(), {0, 0, 1}, {6, 3, 1}, kAll), 0.5 * std::hypot(6, 3) / 6, 1e-9);
  EXPECT_NEAR(solid_between(world.grid(), {-50, 9, 1}, {50, 9, 1}, kAll), 0.0, 1e-9);  // past its end
  EXPECT_EQ(solid_between(world.grid(), {1, 1, 1}, {1, 1, 1}, kAll), 0.0);
}

TEST(SolidPath, IsFreeOverALowWall) {
  const World world = room({{4, 4.5, -5, 5, 0, 1}});
  EXPECT_NEAR(solid_between(world.grid(), {0, 0, 2}, {9, 0, 2}, kAll), 0.0, 1e-9);
  EXPECT_NEAR(solid_between(world.grid(), {0, 0, 0.5}, {9, 0, 0.5}, kAll), 0.5, 1e-9);
  EXPECT_GT(solid_between(world.grid(), {0, 0, 2}, {9, 0, -2}, kAll), 4.0);  // into the floor
  EXPECT_GT(solid_between(world.grid(), {0, 0, -2}, {9, 0, 2}, kAll), 4.0);
}

TEST(SolidPath, EndsEarlyBeyondEnough) {
  const World world = room({{4, 104, -5, 5, 0, 3}});
  const double some = solid_between(world.grid(), {0, 0, 1}, {200, 0, 1}, 10.0);
  EXPECT_GT(some, 10.0);
  EXPECT_LT(some, 11.0);
}

TEST(SolidPath, AgreesWithSmallStepsThroughAnyGrid) {
  Random random(5);
  for (int round = 0; round < 60; ++round) {
    VoxelGrid grid({-1.0, 2.0}, 0.1, 30, 20, {0.0, 0.3, 0.4, 1.0, 1.7}, round % 2 == 0);
    for (int k = 0; k < grid.layers(); ++k)
      for (int j = 0; j < grid.ny(); ++j)
        for (int i = 0; i < grid.nx(); ++i) grid.set(i, j, k, random.chance(0.3));
    grid.build();
    const auto place = [&] {
      return Eigen::Vector3d(random.uniform(-2, 3), random.uniform(1, 5), random.uniform(-0.3, 2.0));
    };
    const Eigen::Vector3d a = place(), b = place();
    const int steps = 20000;
    int solid = 0;
    for (int n = 0; n < steps; ++n) {
      const Eigen::Vector3d p = a + (n + 0.5) / steps * (b - a);
      const int i = grid.column_x(p.x()), j = grid.column_y(p.y()), k = grid.locate(p).k;
      solid += k < 0 || (grid.inside(i, j) ? grid.solid(i, j, k) : !grid.open_sides()) ? 1 : 0;
    }
    EXPECT_NEAR(solid_between(grid, a, b, kAll), solid * (b - a).norm() / steps, 0.01) << round;
  }
}

}  // namespace
}  // namespace adit::sim
