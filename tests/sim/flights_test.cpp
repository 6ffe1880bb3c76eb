// SPDX-License-Identifier: Apache-2.0
// The world with three flights.
#include "sim/world/flights.hpp"

#include <gmock/gmock.h>

#include <deque>

#include "sim/world/standing_map.hpp"

namespace adit::sim {
namespace {

/// Whether a body 0.5 m wide and 0.6 m high, which takes such a step, gets from the start to a place.
bool gets_to(const FlightsWorld& made, const World& world, const Eigen::Vector2d& place, double step) {
  const StandingMap map(world, 0.6, step);
  constexpr int kSide = 400;  // Cells of 0.1 m.
  std::vector<bool> seen(std::size_t{kSide} * kSide);
  std::deque<std::array<int, 2>> open{
      {static_cast<int>(made.world.start.x() * 10), static_cast<int>(made.world.start.y() * 10)}};
  while (!open.empty()) {
    const auto [i, j] = open.front();
    open.pop_front();
    if (i < 0 || j < 0 || i >= kSide || j >= kSide) continue;
    if (seen[static_cast<std::size_t>(j * kSide + i)] || map.distance(0.1 * i + 0.05, 0.1 * j + 0.05) < 0.25)
      continue;
    seen[static_cast<std::size_t>(j * kSide + i)] = true;
    for (const auto& [a, b] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) open.push_back({i + a, j + b});
  }
  return seen[static_cast<std::size_t>(static_cast<int>(place.y() * 10) * kSide +
                                       static_cast<int>(place.x() * 10))];
}

TEST(FlightsWorld, StairsLeadToTheRoomAndARampDoesForEvenSeeds) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const FlightsWorld made = generate_flights(seed);
    const World world = make_box_world(made.world.boxes, 0.0, made.world.ceiling).value();
    EXPECT_TRUE(gets_to(made, world, made.room.head<2>(), 0.18)) << "seed " << seed;
    EXPECT_EQ(gets_to(made, world, made.room.head<2>(), 0.08), made.ramp) << "seed " << seed;
    EXPECT_TRUE(gets_to(made, world, made.hall, 0.08)) << "seed " << seed;
    EXPECT_EQ(made.ramp, seed % 2 == 0);
  }
}

TEST(FlightsWorld, TheStatedStairsAreThoseOfTheWorld) {
  for (const std::uint64_t seed : {3, 5, 7}) {
    const FlightsWorld made = generate_flights(seed);
    const World world = make_box_world(made.world.boxes, 0.0, made.world.ceiling).value();
    for (const Staircase& stairs : made.stairs) {
      ASSERT_TRUE(valid(stairs)) << "seed " << seed;
      EXPECT_GE(stairs.rise, 0.14);
      EXPECT_LE(stairs.rise, 0.18);
      const auto height_at = [&](double along) {
        const Eigen::Vector2d at = stairs.foot.head<2>() + along * stairs.direction();
        return world.ground_height(at.x(), at.y(), 1.0).value();
      };
      EXPECT_NEAR(height_at(-0.1), stairs.floor_below(), 1e-6) << "seed " << seed;
      for (int n = 0; n < stairs.steps; ++n)
        EXPECT_NEAR(height_at((n + 0.5) * stairs.run), stairs.floor_below() + (n + 1) * stairs.rise, 1e-6)
            << "seed " << seed << ", step " << n;
      EXPECT_NEAR(height_at((stairs.steps - 1) * stairs.run + 0.8), stairs.floor_above(), 1e-6);
    }
    EXPECT_NEAR(world.ground_height(made.room.x(), made.room.y(), 1.0).value(), made.room.z(), 1e-6);
    EXPECT_NEAR(made.stairs[2].floor_above(), made.room.z(), 1e-6);
  }
}

}  // namespace
}  // namespace adit::sim
