// SPDX-License-Identifier: Apache-2.0
// Worlds to try navigation in.
#include "sim/world/generate.hpp"

#include <gmock/gmock.h>

#include <deque>

#include "sim/world/standing_map.hpp"

namespace adit::sim {
namespace {

class Generated : public testing::TestWithParam<std::string_view> {};

/// Where a body 0.6 m high, which takes such a step, can be.
StandingMap standing_map(const GeneratedWorld& made, double step) {
  return StandingMap(make_box_world(made.boxes, 0.0, made.ceiling).value(), 0.6, step);
}

/// How much of the world a body of the given width gets to from the start, by columns of 0.1 m.
double reachable(const GeneratedWorld& made, const StandingMap& map, double width) {
  const int nx = static_cast<int>(made.size.x() * 10), ny = static_cast<int>(made.size.y() * 10);
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(nx) * ny);
  std::deque<std::pair<int, int>> open{
      {static_cast<int>(made.start.x() * 10), static_cast<int>(made.start.y() * 10)}};
  std::size_t count = 0;
  while (!open.empty()) {
    const auto [i, j] = open.front();
    open.pop_front();
    if (i < 0 || j < 0 || i >= nx || j >= ny) continue;
    auto& here = seen[static_cast<std::size_t>(j) * nx + i];
    if (here || map.distance(0.1 * i + 0.05, 0.1 * j + 0.05) < width / 2) continue;
    here = 1;
    ++count;
    for (const auto& [a, b] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) open.emplace_back(i + a, j + b);
  }
  return static_cast<double>(count) / (made.size.x() * made.size.y() * 100);
}

TEST_P(Generated, IsTheSameForASeedAndGivesAWay) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const auto made = generate_world(GetParam(), seed);
    ASSERT_TRUE(made) << made.error().text;
    EXPECT_EQ(made->boxes, generate_world(GetParam(), seed)->boxes);
    const StandingMap map = standing_map(*made, 0.08);
    EXPECT_GT(map.distance(made->start.x(), made->start.y()), 0.9) << "seed " << seed;
    EXPECT_GT(reachable(*made, map, 0.6), 0.15) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Generated, testing::ValuesIn(world_kinds().begin(), world_kinds().end()),
                         [](const auto& each) { return std::string(each.param); });

TEST(GeneratedWorlds, TenAreForNavigationAnywhere) {
  EXPECT_EQ(world_kinds().size(), 13u);
  EXPECT_EQ(navigation_kinds().size(), 10u);
}

TEST(GeneratedWorlds, TunnelIsSmoothFromEndToEnd) {
  const World world = make_box_world(generate_tunnel(120).boxes, 0.0, 3.0).value();
  const VoxelGrid& grid = world.grid();
  for (double x = 0.1; x < 119.9; x += 0.1)
    for (const double y : {1.0, -1.0}) {
      const double range = grid.cast(grid.locate({x, 1.5, 1.0}), {0.0, y, 0.0}, 10.0);
      ASSERT_NEAR(range, 1.5, 0.06) << x;
    }
  EXPECT_NEAR(grid.cast(grid.locate({2.0, 1.5, 1.0}), {1.0, 0.0, 0.0}, 200.0), 118.0, 0.06);
}

TEST(GeneratedWorlds, SeedsDiffer) {
  for (const char* kind : {"corridor", "cave", "rubble", "maze", "rooms", "gaps", "loop"})
    EXPECT_NE(generate_world(kind, 1)->boxes, generate_world(kind, 2)->boxes) << kind;
}

TEST(GeneratedWorlds, StairsAreForClimbingPlatforms) {
  const auto made = generate_world("stairs", 1).value();
  EXPECT_GT(reachable(made, standing_map(made, 0.22), 0.5),
            reachable(made, standing_map(made, 0.08), 0.5) + 0.1);
}

TEST(GeneratedWorlds, RefusesAnUnknownKind) {
  EXPECT_EQ(generate_world("castle", 1).reason(), Reason::bad_argument);
}

}  // namespace
}  // namespace adit::sim
