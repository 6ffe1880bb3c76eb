// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/ground_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "nav/terrain/surface.hpp"

namespace adit::nav {
namespace {

using Height = std::function<float(float, float)>;

void see(GroundGrid& grid, const Height& height, float x, float y, float now, float raised = 0) {
  grid.begin_scan(x, y, now);
  for (float i = -4.4f; i < 4.4f; i += 0.03f)
    for (float j = -4.4f; j < 4.4f; j += 0.03f) grid.add(x + i, y + j, height(x + i, y + j) + raised);
}

/// A grid over heights given by a function, seen once, grown around the origin.
GroundGrid grid_of(const Height& height, const GroundParams& params = {}) {
  GroundGrid grid(params);
  see(grid, height, 0, 0, 0);
  grid.grow({}, height(0, 0), {0, 0}, {0, 0, 0.5f}, 1.0f);
  return grid;
}

TEST(GroundGrid, FollowsASlope) {
  const GroundGrid grid = grid_of([](float x, float) { return 0.2f * x; });
  for (float x = -4; x <= 4; x += 0.5f) EXPECT_NEAR(grid.at(x, 1.0f), 0.2f * x, 0.03f) << x;
}

TEST(GroundGrid, AWallIsNotGround) {
  const GroundGrid grid = grid_of([](float x, float) { return x > 2 ? 1.0f : 0.0f; });
  EXPECT_NEAR(grid.at(1.5f, 0), 0.0f, 1e-4f);
  EXPECT_NEAR(grid.at(3.0f, 0), 0.0f, 1e-4f);
  EXPECT_TRUE(grid.measured(1.5f, 0));
  EXPECT_FALSE(grid.measured(3.0f, 0));
}

TEST(GroundGrid, ACliffIsNotGround) {
  const GroundGrid grid = grid_of([](float x, float) { return x > 2 ? -1.0f : 0.0f; });
  EXPECT_NEAR(grid.at(3.0f, 0), 0.0f, 1e-4f);
}

TEST(GroundGrid, SmallRisesAddUp) {
  // 4 cm every 0.4 m, as of a floor in an OctoMap: each one is ground.
  const GroundGrid grid =
      grid_of([](float x, float) { return 0.04f * std::floor(std::max(0.0f, x) / 0.4f); });
  EXPECT_NEAR(grid.at(3.05f, 0), 0.28f, 0.01f);
}

TEST(GroundGrid, StairsAreGroundForAClimbingPlatform) {
  const Height stairs = [](float x, float) { return x > 1 ? 0.17f * std::ceil((x - 1) / 0.3f) : 0.0f; };
  EXPECT_GT(grid_of(stairs, {.rise = 0.245f}).at(3.0f, 0), 1.0f);
  EXPECT_LT(grid_of(stairs).at(3.0f, 0), 0.01f);
}

TEST(GroundGrid, ARampSeenByFarRingsIsGround) {
  // A ring every half metre: between them nothing is measured.
  GroundGrid grid({.slope = 0.35f});
  grid.begin_scan(0, 0, 0);
  for (float x = 0.45f; x < 4; x += 0.5f)
    for (float y = -2; y < 2; y += 0.05f) grid.add(x, y, 0.25f * (x - 0.45f));
  grid.grow({}, 0, {0, 0}, {0, 0, 0.5f}, 1.0f);
  EXPECT_NEAR(grid.at(3.45f, 0), 0.75f, 0.01f);
}

TEST(GroundGrid, ReturnsOfALevelRingAreNoGround) {
  GroundGrid grid({.slope = 0.6f, .rise = 0.245f, .most = 0.45f});
  grid.begin_scan(0, 0, 0);
  for (float y = -2; y < 2; y += 0.05f) grid.add(2.0f, y, 0.65f);
  grid.grow({}, 0, {0, 0}, {0, 0, 0.5f}, 1.0f);
  EXPECT_NEAR(grid.at(2.0f, 0), 0.0f, 1e-6f);
}

TEST(GroundGrid, UnmeasuredGroundFollowsTheBodysAttitude) {
  GroundGrid grid;
  grid.begin_scan(0, 0, 0);
  grid.grow({}, 0.7f, {0.1f, 0}, {0, 0, 0.5f}, 1.0f);
  EXPECT_NEAR(grid.at(3.05f, -2.0f), 0.7f + 0.3f, 0.01f);
}

TEST(GroundGrid, ForgetsCellsThatTheRollingWindowOverwrites) {
  GroundGrid grid;
  grid.begin_scan(0, 0, 0);
  for (float j = -1; j < 1; j += 0.05f) grid.add(0.95f, j, 0.05f);
  grid.grow({}, 0, {0, 0}, {0, 0, 0.5f}, 1.0f);
  EXPECT_NEAR(grid.at(0.95f, 0), 0.05f, 1e-6f);
  // One torus further the same memory holds other places.
  for (float x = 0; x < 12.85f; x += 0.4f) grid.begin_scan(x, 0, 1);
  grid.begin_scan(12.8f, 0, 1);
  grid.grow({}, 0, {0, 0}, {0, 0, 0.5f}, 1.0f);
  EXPECT_NEAR(grid.at(13.75f, 0), 0.0f, 1e-6f);
}

TEST(GroundGrid, ForgetsOldHeights) {
  GroundGrid grid({.memory = 5.0f});
  grid.begin_scan(0, 0, 0);
  grid.add(0.5f, 0.1f, 0.05f);
  grid.grow({}, 0, {0, 0}, {0, 0, 0.5f}, 1.0f);
  EXPECT_NEAR(grid.at(0.5f, 0.1f), 0.05f, 1e-6f);
  grid.begin_scan(0, 0, 6);
  grid.grow({}, 0, {0, 0}, {0, 0, 0.5f}, 1.0f);
  EXPECT_NEAR(grid.at(0.5f, 0.1f), 0.0f, 1e-6f);
}

TEST(GroundGrid, MeasuresTheHeightOffsetOfAScanFromTheMap) {
  const Height waves = [](float x, float y) { return 0.05f * std::sin(x) * std::cos(y); };
  GroundGrid grid = grid_of(waves);
  see(grid, waves, 0.1f, 0, 0.1f, -0.04f);  // an odometry that does not know of its robot's climb of 4 cm
  EXPECT_NEAR(grid.disagreement().height, 0.04f, 0.006f);
  see(grid, waves, 0.1f, 0, 0.2f, 0.002f);
  EXPECT_EQ(grid.disagreement().height, 0.0f);
}

TEST(RoundDown, RoundsDownOnBothSides) {
  EXPECT_EQ(round_down(1.9f), 1);
  EXPECT_EQ(round_down(-0.1f), -1);
  EXPECT_EQ(round_down(-3.0f), -3);
  EXPECT_EQ(round_down(0.0f), 0);
}

// The side of a ramp of low steps: passable at its foot, too high from x = 0.5 m on.
TEST(Surface, FindsTheCellWhereAStepBecomesTooHigh) {
  const GroundGrid grid = grid_of(
      [](float x, float y) { return x < 0 || y > 0.9f ? 0.0f
                                    : x < 0.5f        ? 0.06f
                                                      : 0.14f; }, {.rise = 0.2f});
  const std::vector<std::uint8_t> solid(grid.cells(), 0);
  Surface surface({.step = 0.08f, .blocking_step = 0.105f}, grid.side());
  surface.work_out(grid, solid);
  const auto blocked = [&](float x, float y) {
    const auto places = surface.places();
    return std::count_if(places.begin(), places.end(), [&](const Surface::Place& place) {
      return static_cast<int>(place.index) == grid.window(x, y) && place.kind == CellClass::step &&
             place.cost >= 1;
    });
  };
  for (float x = 0.55f; x < 2; x += 0.1f) {
    EXPECT_EQ(blocked(x, 0.85f), 1) << x << ": on its upper side, where who is below touches it";
    EXPECT_EQ(blocked(x, 0.65f) + blocked(x, 1.15f), 0) << x;
  }
  for (float x = -1; x < 0.4f; x += 0.1f) EXPECT_EQ(blocked(x, 0.85f) + blocked(x, 0.95f), 0) << x;
}

}  // namespace
}  // namespace adit::nav
