// SPDX-License-Identifier: Apache-2.0
#include "sim/world/standing_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/time/random.hpp"
#include "sim/world/distance_transform.hpp"

namespace adit::sim {
namespace {

TEST(DistanceTransform, agrees_with_looking_everywhere) {
  Random random(11);
  for (int round = 0; round < 20; ++round) {
    const int w = 1 + static_cast<int>(random.below(30)), h = 1 + static_cast<int>(random.below(30));
    std::vector<std::uint8_t> targets(static_cast<std::size_t>(w) * h);
    for (auto& t : targets) t = random.chance(0.03);
    const std::vector<float> out = distance_transform(targets, w, h);
    for (int n = 0; n < w * h; ++n) {
      double best = 1e9;
      for (int m = 0; m < w * h; ++m)
        if (targets[m]) best = std::min(best, std::hypot(n % w - m % w, n / w - m / w));
      ASSERT_NEAR(out[n], best, best * 1e-6 + 1e-6) << round;
    }
  }
}

TEST(Rectangle, overlap_and_distance) {
  const Rectangle a{{0, 0, 0}, 2, 1};
  EXPECT_TRUE(overlap(a, {{1.2, 0, 0}, 1, 1}));
  EXPECT_FALSE(overlap(a, {{1.5, 0, 0}, 1, 1})) << "a shared border is no contact";
  EXPECT_NEAR(distance(a, {{2.5, 0, 0}, 1, 1}), 1.0, 1e-12);
  EXPECT_EQ(distance(a, {{0.1, 0.1, 1}, 0.2, 0.2}), 0.0) << "one inside the other";
  const double s = std::sqrt(0.5);
  EXPECT_NEAR(distance(a, {{0, 0.5 + s + 0.3, M_PI / 4}, 1, 1}), 0.3, 1e-12) << "a corner ahead";
  EXPECT_FALSE(overlap(a, {{1.0 + 0.5, 0.5 + 0.5, M_PI / 4}, 1, 1})) << "corner by corner";
}

TEST(Rectangle, distance_is_zero_exactly_when_they_overlap) {
  Random random(2);
  int overlaps = 0;
  for (int round = 0; round < 3000; ++round) {
    const auto draw = [&] {
      return Rectangle{{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)},
                       random.uniform(0.1, 1.5),
                       random.uniform(0.1, 1.0)};
    };
    const Rectangle a = draw(), b = draw();
    EXPECT_EQ(overlap(a, b), overlap(b, a));
    EXPECT_EQ(overlap(a, b), distance(a, b) == 0.0);
    EXPECT_NEAR(distance(a, b), distance(b, a), 1e-12);
    overlaps += overlap(a, b);
  }
  EXPECT_GT(overlaps, 500);
  EXPECT_LT(overlaps, 2500);
}

World stairs() {
  const std::array<Box, 4> boxes{Box{2, 6, -2, 2, 0, 0.06}, Box{3, 6, -2, 2, 0, 0.18},
                                 Box{6, 6.2, -2, 2, 0, 3}, Box{-2, -1.5, -2, 2, 0.55, 3}};
  return *make_box_world(boxes, 0, 3);
}

TEST(StandingMap, a_step_too_high_blocks_its_edge) {
  const World world = stairs();
  const StandingMap wheels(world, 0.5, 0.08), tracks(world, 0.5, 0.15);
  const Rectangle on_low{{2.0, 0, 0}, 0.6, 0.5}, on_high{{3.0, 0, 0}, 0.6, 0.5},
      at_wall{{5.8, 0, 0}, 0.6, 0.5};
  EXPECT_FALSE(wheels.touches(on_low)) << "6 cm";
  EXPECT_TRUE(wheels.touches(on_high)) << "12 cm";
  EXPECT_FALSE(tracks.touches(on_high));
  EXPECT_TRUE(tracks.touches(at_wall));
  EXPECT_FALSE(tracks.touches({{5.5, 0, 0}, 0.6, 0.5}));
  EXPECT_FALSE(wheels.touches({{-1.75, 0, 0}, 0.3, 0.3})) << "under the shelf";
  EXPECT_TRUE(StandingMap(world, 0.6, 0.08).touches({{-1.75, 0, 0}, 0.3, 0.3})) << "too tall for it";
}

TEST(StandingMap, ground_rises_smoothly) {
  const World world = stairs();
  const StandingMap map(world, 0.5, 0.15);
  EXPECT_NEAR(map.ground(0, 0), 0.0, 1e-6);
  EXPECT_NEAR(map.ground(2.5, 0), 0.06, 1e-6);
  EXPECT_NEAR(map.ground(4.5, 0), 0.18, 1e-6);
  for (double x = 0; x < 5.0; x += 0.01)
    EXPECT_LT(std::abs(map.ground(x + 0.01, 0) - map.ground(x, 0)), 0.006) << x;
  EXPECT_EQ(map.ground(100, 100), 0.0) << "beside an open world";
}

TEST(StandingMap, clearance_is_the_way_to_the_wall) {
  const World world = stairs();
  const StandingMap map(world, 0.5, 0.15);
  for (const double x : {4.0, 4.5, 5.0, 5.6})
    EXPECT_NEAR(map.clearance({{x, 0, 0}, 0.6, 0.5}), 6.0 - 0.3 - x, 0.03) << x;
  EXPECT_EQ(map.clearance({{5.9, 0, 0.3}, 0.6, 0.5}), 0.0);
}

TEST(StandingMap, clearance_reaches_beyond_the_columns_of_an_open_world) {
  const std::array<Box, 1> wall{Box{6, 6.3, -8, 8, 0, 2}};
  const StandingMap map(*make_box_world(wall, 0, 3), 0.5, 0.08);
  for (const double x : {-40.0, 0.0, 3.9, 4.2, 5.0})
    EXPECT_NEAR(map.clearance({{x, 0, 0}, 0.6, 0.5}), 6.0 - 0.3 - x, 0.03) << x;
  EXPECT_NEAR(map.clearance({{6.15, 20, 0}, 0.6, 0.5}), 20.0 - 8.0 - 0.25, 0.03) << "at its side";
}

TEST(StandingMap, nothing_is_at_no_distance) {
  const std::array<Box, 1> kerb{Box{1, 2, 0, 1, 0, 0.05}};
  const StandingMap empty(*make_box_world({}, 0, 3), 0.5, 0.08), low(*make_box_world(kerb, 0, 3), 0.5, 0.08);
  for (const double x : {0.0, 1.5, 30.0})
    for (const StandingMap* map : {&empty, &low})
      EXPECT_TRUE(std::isinf(map->clearance({{x, 0, 0}, 0.6, 0.5}))) << x;
}

}  // namespace
}  // namespace adit::sim
