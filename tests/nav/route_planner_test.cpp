// SPDX-License-Identifier: Apache-2.0
// The global planner over given maps.
#include <gtest/gtest.h>

#include <chrono>

#include "nav/routing/route_follower.hpp"
#include "tests/nav/route_world.hpp"

namespace adit::nav::test {
namespace {

constexpr double kHard = 0.22;  // m: half the width of wheeled(), and a cell aside of a gap

TEST(RoutePlanner, StraightOverOpenGround) {
  GridWorld world(200, 100);
  world.border();
  RoutePlanner planner(wheeled());
  world.tell(planner);
  const Route route = planner.plan({1.5, 5, 0}, {18.5, 4, 0});
  ASSERT_TRUE(route.found());
  EXPECT_EQ(route.points.size(), 2u);
  EXPECT_NEAR(route.length, std::hypot(17, 1), 0.05);
  EXPECT_EQ(route.unknown_length, 0.0);
  EXPECT_EQ(route.points.front().head<2>(), Eigen::Vector2d(1.5, 5));
  EXPECT_EQ(route.points.back().head<2>(), Eigen::Vector2d(18.5, 4));
}

TEST(RoutePlanner, ClearForgetsEverything) {
  GridWorld world(200, 100);
  world.border();
  RoutePlanner planner(wheeled());
  world.tell(planner);
  ASSERT_FALSE(planner.plan({1.5, 5, 0}, {1.5, 20, 0}).found()) << "beyond the border";
  planner.clear();
  EXPECT_EQ(planner.map().used(), 0);
  EXPECT_TRUE(planner.plan({1.5, 5, 0}, {1.5, 20, 0}).found());
  world.tell(planner);
  EXPECT_FALSE(planner.plan({1.5, 5, 0}, {1.5, 20, 0}).found()) << "and learns it again";
}

// What passed for ground a step and a slope up, once, makes no floor of its own between the robot and the
// rest.
TEST(RoutePlanner, IsolatedWrongHeightsMakeNoFloor) {
  RoutePlanner planner(wheeled());
  const auto tell = [&planner](int x, int y, double z) { planner.set_ground(middle(x, y, z)); };
  for (int y = 0; y < 96; y += 16)
    for (int x = 0; x < 160; x += 16) tell(x, y, 0.41);
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 160; ++x)
      if (x % 16 > 2 || y % 16 > 2) tell(x, y, 0.0);
  for (int y = 0; y < 96; y += 16)
    for (int x = 0; x < 160; x += 16) tell(x, y, 0.0);
  planner.finish();
  const Route route = planner.plan({0.8, 4.0, 0}, {15.2, 4.0, 0});
  ASSERT_TRUE(route.found());
  EXPECT_EQ(route.unknown_length, 0.0);
  EXPECT_LT(route.length, 16.0);
}

// Against brute force: found when and only when there is a way, hardly longer, never through a wall.
TEST(RoutePlanner, NearlyShortestInRandomWorlds) {
  int found = 0, proven = 0;
  double worst = 1, sum = 0;
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    const GridWorld world = GridWorld::random(200, 200, 40 + static_cast<int>(seed % 4) * 25, seed);
    RouteParams params;
    params.narrow_cost = 0;  // the shortest, not the roomiest
    RoutePlanner planner(wheeled(), params);
    world.tell(planner);
    const auto free = world.passable(kHard), roomy = world.passable(kHard + 0.05);
    std::mt19937 draw(seed);
    for (int i = 0; i < 4; ++i) {
      int p[4];
      for (int& v : p) v = 5 + static_cast<int>(draw() % 190);
      const auto ok = [&](int x, int y) { return free[static_cast<std::size_t>(y * world.width + x)]; };
      if (!ok(p[0], p[1]) || !ok(p[2], p[3])) continue;
      const double shortest = world.shortest(free, p[0], p[1], p[2], p[3]);
      const Route route = planner.plan(middle(p[0], p[1]), middle(p[2], p[3]));
      // Between cells that touch at a corner of tiles only, the graph has no way.
      const double surely = world.shortest(roomy, p[0], p[1], p[2], p[3]);
      ASSERT_TRUE(route.found() ? std::isfinite(shortest) : !std::isfinite(surely))
          << "seed " << seed << " pair " << i;
      if (!route.found()) {
        ++proven;
        continue;
      }
      ++found;
      EXPECT_GE(route_clearance(world, route), kHard - 0.1) << "seed " << seed;
      double length = 0;
      for (std::size_t k = 0; k + 1 < route.points.size(); ++k)
        length += (route.points[k + 1] - route.points[k]).norm();
      EXPECT_NEAR(route.length, length, 1e-6) << "of every leg, also one that a line does not pass";
      EXPECT_EQ(route.unknown.size() + 1, route.points.size());
      if (!std::isfinite(surely)) continue;
      const double ratio = route.length / std::max(surely, 1.0);
      worst = std::max(worst, ratio);
      sum += ratio;
    }
  }
  EXPECT_GT(found, 60);
  EXPECT_GT(proven, 2);
  EXPECT_LT(worst, 1.12);
  EXPECT_LT(sum / found, 1.01);
}

TEST(RoutePlanner, StaysInTheMiddleOfWideSpace) {
  GridWorld world(200, 60);
  world.border();
  world.fill(80, 120, 0, 22);
  world.fill(80, 120, 38, 60);  // a passage of 1.6 m
  RoutePlanner planner(wheeled());
  world.tell(planner);
  const Route route = planner.plan({2, 1, 0}, {18, 1, 0});
  ASSERT_TRUE(route.found());
  EXPECT_GT(route_clearance(world, route), 0.35);
}

TEST(RoutePlanner, GapsJustWiderThanTheRobot) {
  for (const int cells : {6, 2}) {  // 0.6 m for a robot of 0.5 m, and 0.2 m
    GridWorld world(100, 60);
    world.border();
    world.fill(48, 50, 0, 60);
    world.fill(48, 50, 30, 30 + cells, false);
    RoutePlanner planner(wheeled());
    world.tell(planner);
    EXPECT_EQ(planner.plan({1, 1, 0}, {9, 5, 0}).found(), cells == 6);
  }
}

TEST(RoutePlanner, UnreachableIsProven) {
  GridWorld world(160, 100);
  world.border();
  world.fill(100, 102, 0, 100);
  RoutePlanner planner(wheeled());
  world.tell(planner);
  EXPECT_EQ(planner.plan({2, 5, 0}, {14, 5, 0}).status, RouteStatus::unreachable);
  // Beyond the walls all is unknown, but nothing leads there.
  EXPECT_EQ(planner.plan({2, 5, 0}, {30, 5, 0}).status, RouteStatus::unreachable);
  // In the wall itself.
  GridWorld thick(160, 100);
  thick.border();
  thick.fill(60, 100, 30, 70);
  RoutePlanner other(wheeled());
  thick.tell(other);
  EXPECT_EQ(other.plan({2, 5, 0}, {8, 5, 0}).status, RouteStatus::unreachable);
}

TEST(RoutePlanner, UnknownSpaceMayBeTried) {
  GridWorld world(100, 100);  // known, without walls around
  RoutePlanner planner(wheeled());
  world.tell(planner);
  const Route route = planner.plan({2, 5, 0}, {25, 5, 0});
  ASSERT_TRUE(route.found());
  EXPECT_NEAR(route.length, 23, 0.6);
  EXPECT_NEAR(route.unknown_length, 15, 1.0);
  ASSERT_EQ(route.unknown.size() + 1, route.points.size());
  EXPECT_TRUE(route.unknown.back());
  // Nothing known at all.
  RoutePlanner blank(wheeled());
  const Route straight = blank.plan({0, 0, 0}, {9, 3, kNan});
  ASSERT_TRUE(straight.found());
  EXPECT_NEAR(straight.length, std::hypot(9, 3), 0.3);
  EXPECT_NEAR(straight.unknown_length, straight.length, 0.5);
  EXPECT_EQ(blank.plan({0, 0, 0}, {90'000, 0, 0}).status, RouteStatus::too_far);
}

TEST(RoutePlanner, KnownWayBeforeAnUnknownOneOfLikeLength) {
  GridWorld world(200, 100);
  world.border();
  world.fill(60, 140, 30, 70);  // way round below 20 m or so
  RoutePlanner planner(wheeled());
  for (int y = 0; y < 50; ++y)  // the upper half was never seen
    for (int x = 0; x < 200; ++x)
      if (world.at(x, y))
        planner.set_obstacle(middle(x, y), 2);
      else
        planner.set_ground(middle(x, y));
  planner.finish();
  const Route route = planner.plan({2, 4.9, 0}, {18, 4.9, 0});
  ASSERT_TRUE(route.found());
  EXPECT_LT(route.unknown_length, 1.0);
}

TEST(RoutePlanner, BlockedPlacesCountForAWhile) {
  GridWorld world(200, 100);
  world.border();
  world.fill(98, 102, 0, 100);
  world.fill(98, 102, 20, 28, false);
  world.fill(98, 102, 80, 88, false);
  RoutePlanner planner(wheeled());
  world.tell(planner);
  const Eigen::Vector3d from{2, 2.4, 0}, to{18, 2.4, 0};
  const Route near = planner.plan(from, to);
  ASSERT_TRUE(near.found());
  EXPECT_LT(near.length, 17);
  planner.map().block({10, 2.4, 0}, 5.0);
  const Route far = planner.plan(from, to);
  ASSERT_TRUE(far.found());
  EXPECT_GT(far.length, 18);
  planner.map().block({10, 8.4, 0}, 6.0);
  EXPECT_EQ(planner.plan(from, to).status, RouteStatus::unreachable);
  EXPECT_TRUE(planner.map().has_blocked_places());
  planner.add_scan(PointCloud{}, Pose3::level({2, 2.4, 0}, 0), 25.5);  // 20 s later the first counts no more
  planner.finish();
  EXPECT_NEAR(planner.plan(from, to).length, near.length, 0.1);
  planner.map().block({10, 2.4, 0}, 27.0);  // again: twice as long
  planner.add_scan(PointCloud{}, Pose3::level({2, 2.4, 0}, 0), 60.0);
  planner.finish();
  EXPECT_GT(planner.plan(from, to).length, 18);
}

/// Two floors 3 m apart with a ramp of 10 m between them, in an open hall.
struct TwoFloors {
  static constexpr double kHeight = 3.0;
  RoutePlanner planner{wheeled()};
  TwoFloors(bool ramp, double rise = kHeight) {
    for (int y = 0; y < 100; ++y)
      for (int x = 0; x < 200; ++x) {
        const bool edge = x == 0 || y == 0 || x == 199 || y == 99;
        const bool on_ramp = ramp && x >= 60 && x < 160 && y >= 40 && y < 60;
        const auto put = [&](double z, bool wall) {
          if (wall)
            planner.set_obstacle(middle(x, y, z), 1.0);
          else
            planner.set_ground(middle(x, y, z));
        };
        // Under the ramp, where it is low, there is no floor; above it is a hole with a railing.
        if (!on_ramp || (x - 60) * 0.1 * 0.3 > 1.0) put(0.0, edge);
        if (on_ramp) put((x - 60) * 0.1 * rise / 10, y == 40 || y == 59);
        const bool hole = ramp && x >= 55 && x < 160 && y >= 38 && y < 62;
        if (!hole) put(kHeight, edge);
        if (hole && (y == 38 || y == 61 || x == 55)) put(kHeight, true);
      }
    planner.finish();
  }
};

TEST(RoutePlanner, TwoFloorsWithARamp) {
  TwoFloors floors(true);
  const Route up = floors.planner.plan({2, 2, 0}, {2, 2, 3});
  ASSERT_TRUE(up.found());
  EXPECT_GT(up.length, 25);
  EXPECT_LT(up.length, 36);
  EXPECT_EQ(up.unknown_length, 0.0);
  double highest = -1;
  for (const auto& p : up.points) {
    EXPECT_GE(p.z(), highest - 0.1);
    highest = std::max(highest, p.z());
  }
  EXPECT_NEAR(highest, 3.0, 0.05);
  const Route down = floors.planner.plan({2, 2, 3}, {18, 8, 0});
  ASSERT_TRUE(down.found());
  EXPECT_NEAR(down.points.back().z(), 0.0, 0.05);
  // Without a height the goal is on the robot's floor.
  const Route level = floors.planner.plan({2, 2, 3}, {18, 2, kNan});
  ASSERT_TRUE(level.found());
  EXPECT_NEAR(level.length, 16, 0.2);
}

TEST(RoutePlanner, TheSamePlaceOnAnotherFloorIsAnotherGoal) {
  TwoFloors floors(true);
  RouteFollower route_follower;
  route_follower.step(floors.planner, {.place = {2, 2, 0}, .goal = {8, 2, std::nan("")}});
  EXPECT_LT(route_follower.route().length, 7);
  route_follower.step(floors.planner, {.place = {2, 2, 0}, .goal = {8, 2, 3}, .stamp_s = 0.1});
  EXPECT_GT(route_follower.route().length, 15);
}

TEST(RoutePlanner, ObstacleBelowARampIsNotOnTheRamp) {
  RoutePlanner planner(wheeled());
  planner.set_ground({1, 1, 0.7});
  planner.set_obstacle({1, 1, 0}, 0.7);  // its side, seen from the floor
  planner.finish();
  EXPECT_NEAR(planner.ground(1, 1, 0).value(), 0.7, 1e-3);
}

TEST(RoutePlanner, StairsLeadToALandingThatTheirTilesBelongTo) {
  // Six steps of 0.2 m, some of them in tiles of the floor and some in those of the landing.
  for (const double from : {3.0, 3.3, 3.9, 4.4}) {
    RoutePlanner legs(legged());
    for (int y = 0; y < 30; ++y)
      for (int x = 99; x >= 0; --x) {  // the landing is seen first
        const double above = std::clamp(std::ceil(((x + 0.5) * 0.1 - from) / 0.3), 0.0, 6.0) * 0.2;
        if (y == 0 || y == 29 || x == 0 || x == 99)
          legs.set_obstacle(middle(x, y, above), 1);
        else
          legs.set_ground(middle(x, y, above));
      }
    legs.finish();
    const Route up = legs.plan({1, 1.5, 0}, {9, 1.5, 1.2}), down = legs.plan({9, 1.5, 1.2}, {1, 1.5, 0});
    ASSERT_TRUE(up.found()) << from;
    ASSERT_TRUE(down.found()) << from;
    EXPECT_NEAR(up.points.back().z(), 1.2, 1e-3);
    EXPECT_NEAR(down.points.back().z(), 0, 1e-3);
  }
}

TEST(RoutePlanner, GapsAreAsWideAsTheReturnsSay) {
  // The faces of a gap lie anywhere in their cells.
  for (const double width : {0.60, 0.34})
    for (double low = 2.01; low < 2.1; low += 0.02) {
      RoutePlanner planner(wheeled());
      GridWorld world(60, 50);
      world.border();
      world.tell(planner);
      for (double y = 0.05; y < 5; y += 0.02)
        if (y <= low || y >= low + width) planner.set_obstacle({3.05, y, 0}, 2);
      planner.finish();
      EXPECT_EQ(planner.plan({1, 2, 0}, {5, 2, 0}).found(), width > 0.5) << width << " from " << low;
    }
}

TEST(RoutePlanner, NoRampNoWayUp) {
  TwoFloors floors(false);
  EXPECT_EQ(floors.planner.plan({2, 2, 0}, {2, 2, 3}).status, RouteStatus::unreachable);
  EXPECT_TRUE(floors.planner.plan({2, 2, 0}, {18, 2, 0}).found());
}

TEST(RoutePlanner, StepsByPlatform) {
  for (const double step : {0.05, 0.16}) {
    RoutePlanner wheels(wheeled()), legs(legged());
    for (RoutePlanner* planner : {&wheels, &legs}) {
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 100; ++x) planner->set_ground(middle(x, y, x < 50 ? 0.0 : step));
      for (int x = 0; x < 100; ++x)
        for (const int y : {0, 39}) planner->set_obstacle(middle(x, y, x < 50 ? 0.0 : step), 1);
      for (int y = 0; y < 40; ++y)
        for (const int x : {0, 99}) planner->set_obstacle(middle(x, y, x < 50 ? 0.0 : step), 1);
      planner->finish();
    }
    EXPECT_EQ(wheels.plan({1, 2, 0}, {9, 2, kNan}).found(), step < 0.1);
    EXPECT_TRUE(legs.plan({1, 2, 0}, {9, 2, kNan}).found());
  }
}

/// A gallery of 1 km that is 4 m wide, at an angle to the axes, and falls by 3 per cent. `walls`: along both
/// sides; else unknown space begins there.
void add_deep_gallery(RoutePlanner& planner, bool walls) {
  const Eigen::Vector2d along = Eigen::Vector2d(1.0, 0.9).normalized(), aside(-along.y(), along.x());
  for (double s = 0; s <= 1000; s += 0.07)
    for (double t = walls ? -2.2 : -2.0; t <= (walls ? 2.2 : 2.0); t += 0.07) {
      const Eigen::Vector2d at = s * along + t * aside;
      const Eigen::Vector3d place(at.x(), at.y(), -0.03 * s);
      if (std::abs(t) > 2.0)
        planner.set_obstacle(place, 2.0);
      else
        planner.set_ground(place);
    }
  planner.finish();
}

TEST(RoutePlanner, FindsAWayAlongADeepGallery) {
  const Eigen::Vector2d along = Eigen::Vector2d(1.0, 0.9).normalized();
  const auto at = [&](double s) { return Eigen::Vector3d(s * along.x(), s * along.y(), -0.03 * s); };
  for (const bool walls : {true, false}) {
    RoutePlanner planner(wheeled());
    add_deep_gallery(planner, walls);
    const Route route = planner.plan(at(2), at(995));
    ASSERT_TRUE(route.found()) << "walls " << walls;
    EXPECT_EQ(route.unknown_length, 0.0);
    EXPECT_NEAR(route.length, 993, 10);
    const std::vector<Eigen::Vector3d> goals{at(22), at(500), at(995)};
    const std::vector<float> costs = planner.costs(at(2), goals);
    EXPECT_NEAR(costs[0], 20, 4);
    EXPECT_TRUE(std::isfinite(costs[1]));
    EXPECT_TRUE(std::isfinite(costs[2]));
  }
}

TEST(RoutePlanner, OneHighCellEndsNoSearch) {
  GridWorld world(1500, 1500);
  RoutePlanner planner(wheeled());
  world.tell(planner);
  planner.set_ground({75.05, 75.05, 31.0});
  planner.finish();
  const Eigen::Vector3d from(3, 3, 0), to(140, 120, 0);
  const Route route = planner.plan(from, to);
  ASSERT_TRUE(route.found());
  EXPECT_NEAR(route.length, (to - from).norm(), 5);
  const std::vector<Eigen::Vector3d> goals{{23, 3, 0}, to};
  const std::vector<float> costs = planner.costs(from, goals);
  EXPECT_NEAR(costs[0], 20, 2);
  EXPECT_TRUE(std::isfinite(costs[1]));
}

TEST(RoutePlanner, BoundedMemory) {
  RouteParams params;
  params.tiles = 200;
  RoutePlanner planner(wheeled(), params);
  for (int x = 0; x < 4000; x += 5) {
    const double at = x * 0.1;
    planner.add_scan(std::vector<Eigen::Vector3f>{{5.f, 0.f, 0.5f}, {0.f, 5.f, 0.5f}},
                     Pose3::level({at, 0, 0}, 0), at);
  }
  EXPECT_LE(planner.map().used(), 200);
  EXPECT_LE(planner.map().size(), 200);
  EXPECT_LT(planner.memory(), 2'000'000u);
  EXPECT_TRUE(planner.plan({399.5, 0, 0}, {390, 0, 0}).found());
}

// Who keeps to a route measures it with each scan; one that is no line would be lost at once.
TEST(RoutePlanner, EachLegOfAWayIsPassableAsALine) {
  int found = 0, attempts = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const GridWorld world = GridWorld::random(200, 200, 60, seed);
    RoutePlanner planner(wheeled());
    std::mt19937 draw(seed);
    const auto upto = [&](int n) { return static_cast<int>(draw() % static_cast<std::uint32_t>(n)); };
    const int known_x = 40 + upto(160), known_y = 40 + upto(160);  // the rest is unseen
    for (int y = 0; y < known_y; ++y)
      for (int x = 0; x < known_x; ++x) {
        if (world.at(x, y))
          planner.set_obstacle(middle(x, y, 0), 2.0);
        else
          planner.set_ground(middle(x, y, 0));
      }
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d from = middle(upto(known_x), upto(known_y), 0);
      const Eigen::Vector3d to = middle(upto(200), upto(200), 0);
      if (!planner.line(from, from).passable || !planner.line(to, to).passable) continue;
      Route route = planner.plan(from, to);
      if (!route.found()) continue;
      ++found;
      attempts += route.unknown_length > 0.0;
      EXPECT_TRUE(planner.measure(route)) << seed << " " << i;
    }
  }
  EXPECT_GT(found, 200);
  EXPECT_GT(attempts, 40);
}

TEST(RoutePlanner, SameInputsSameRoute) {
  const auto run = [] {
    const GridWorld world = GridWorld::random(200, 200, 60, 4);
    RoutePlanner planner(wheeled());
    world.tell(planner);
    return planner.plan({1, 1, 0}, {19, 19, 0});
  };
  const Route a = run(), b = run();
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.cost, b.cost);
}

}  // namespace
}  // namespace adit::nav::test
