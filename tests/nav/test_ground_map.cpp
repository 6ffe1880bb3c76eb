#include "nav/ground_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace adit::nav {
namespace {

/// A ground map over heights given by a function, seen once, grown around (x, y).
GroundMap map_of(const std::function<float(float, float)>& height, float x = 0, float y = 0) {
  GroundMap map;
  map.begin_scan(0.0);
  for (float i = -5; i < 5; i += 0.07f)
    for (float j = -5; j < 5; j += 0.07f) map.add(x + i, y + j, height(x + i, y + j));
  map.grow(x, y, height(x, y));
  return map;
}

TEST(GroundMap, FollowsASlope) {
  const GroundMap map = map_of([](float x, float) { return 0.2f * x; });
  for (float x = -4; x <= 4; x += 0.5f) EXPECT_NEAR(map.at(x, 1.0f), 0.2f * x, 0.06f) << x;
}

TEST(GroundMap, AWallIsNotGround) {
  const GroundMap map = map_of([](float x, float) { return x > 2 ? 1.0f : 0.0f; });
  EXPECT_NEAR(map.at(1.5f, 0), 0.0f, 1e-6f);
  EXPECT_NEAR(map.at(3.0f, 0), 0.0f, 1e-6f);
}

TEST(GroundMap, ACliffIsNotGround) {
  const GroundMap map = map_of([](float x, float) { return x > 2 ? -1.0f : 0.0f; });
  EXPECT_NEAR(map.at(3.0f, 0), 0.0f, 1e-6f);
}

TEST(GroundMap, SmallRisesAddUp) {
  // 4 cm every 0.4 m, as of a floor in an OctoMap: each one is ground.
  const GroundMap map = map_of([](float x, float) { return 0.04f * std::floor(std::max(0.0f, x) / 0.4f); });
  EXPECT_NEAR(map.at(3.0f, 0), 0.28f, 0.05f);
}

TEST(GroundMap, GroundBetweenTheRingsIsInherited) {
  GroundMap map;
  map.begin_scan(0.0);
  map.grow(0, 0, 0.7);  // nothing seen: level with the robot's feet
  EXPECT_NEAR(map.at(3.0f, -2.0f), 0.7f, 1e-6f);
}

TEST(GroundMap, RollsAndForgetsWhatItWrapsOver) {
  GroundMap map;
  map.begin_scan(0.0);
  for (float j = -1; j < 1; j += 0.1f) map.add(0.9f, j, 0.05f);
  map.grow(0, 0, 0);
  EXPECT_NEAR(map.at(0.9f, 0), 0.05f, 1e-6f);
  // One torus further (64 cells of 20 cm) the same slots hold other places.
  map.begin_scan(1.0);
  map.grow(12.8, 0, 0);
  EXPECT_NEAR(map.at(13.7f, 0), 0.0f, 1e-6f);
}

TEST(GroundMap, ForgetsOldHeights) {
  GroundMap map(GroundMapParams{.memory = 5.0});
  map.begin_scan(0.0);
  map.add(0.5f, 0.1f, 0.05f);
  map.grow(0, 0, 0);
  EXPECT_NEAR(map.at(0.5f, 0.1f), 0.05f, 1e-6f);
  map.begin_scan(6.0);
  map.grow(0, 0, 0);
  EXPECT_NEAR(map.at(0.5f, 0.1f), 0.0f, 1e-6f);
}

TEST(FloorInt, RoundsDownOnBothSides) {
  EXPECT_EQ(floor_int(1.9f), 1);
  EXPECT_EQ(floor_int(-0.1f), -1);
  EXPECT_EQ(floor_int(-3.0f), -3);
  EXPECT_EQ(floor_int(0.0f), 0);
}

}  // namespace
}  // namespace adit::nav
