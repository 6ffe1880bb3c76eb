// SPDX-License-Identifier: Apache-2.0
// Whether a body can stand at a goal, over given maps.
#include <gtest/gtest.h>

#include "nav/goals/goal_check.hpp"
#include "tests/nav/route_world.hpp"

namespace adit::nav::test {
namespace {

/// A room of 10 x 6 m that is known, with its walls.
class GoalCheckTest : public testing::Test {
 protected:
  GoalCheckTest() { world.border(); }
  Standing at(double x, double y) {
    if (planner.map().used() == 0) world.tell(planner);
    return check.stand(planner, {x, y, kNan}, 0.0);
  }
  GoalFinding judge(double x, double y, bool replace) {
    if (planner.map().used() == 0) world.tell(planner);
    return check.check(planner, {2, 3, 0}, {x, y, kNan}, replace);
  }

  GridWorld world{100, 60};
  Platform body{wheeled()};
  RoutePlanner planner{body};
  GoalCheck check{body};
};

TEST_F(GoalCheckTest, TheMiddleOfARoomIsStandable) { EXPECT_EQ(at(5, 3), Standing::standable); }

TEST_F(GoalCheckTest, ATableIsOccupied) {
  world.fill(50, 60, 25, 35);
  EXPECT_EQ(at(5.5, 3), Standing::occupied);
  EXPECT_EQ(at(5.0, 3), Standing::occupied) << "its edge";
  EXPECT_EQ(at(4.6, 3), Standing::standable) << "beside it, along its edge";
}

TEST_F(GoalCheckTest, ACorridorAsWideAsTheBodyHasOneHeading) {
  // 0.6 m wide, for a body of 0.6 x 0.5 m.
  world.fill(30, 60, 1, 27);
  world.fill(30, 60, 33, 59);
  EXPECT_EQ(at(4.5, 3.0), Standing::standable);
}

TEST_F(GoalCheckTest, APocketSmallerThanTheBodyIsTooNarrow) {
  // 0.4 m square, open above; the place itself is free.
  world.fill(45, 55, 25, 35);
  world.fill(48, 52, 28, 32, false);
  EXPECT_EQ(at(5, 3), Standing::too_narrow);
}

TEST_F(GoalCheckTest, AGapNarrowerThanTheBodyIsTooNarrowAndAWallBesideThePlaceIsNot) {
  world.fill(30, 60, 1, 28);
  world.fill(30, 60, 31, 59);
  EXPECT_EQ(at(4.5, 2.95), Standing::too_narrow) << "between walls 0.3 m apart";
  EXPECT_EQ(at(2.0, 0.25), Standing::occupied) << "0.15 m beside one wall";
}

TEST_F(GoalCheckTest, GroundBeyondTheWallsIsUnseen) {
  EXPECT_EQ(at(15, 3), Standing::unseen);
  EXPECT_EQ(judge(15, 3, false).standing, Standing::not_connected) << "the room is closed";
}

TEST_F(GoalCheckTest, ASteepPlaceIsRefused) {
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 100; ++x) planner.set_ground(middle(x, y, 0.05 * std::max(0, x - 50)));
  planner.finish();
  EXPECT_EQ(check.stand(planner, {2, 3, 0}, 0), Standing::standable);
  EXPECT_EQ(check.stand(planner, {7, 3, kNan}, 0), Standing::too_steep) << "a rise of 0.5 per metre";
}

TEST_F(GoalCheckTest, AHoleHasNoFloor) {
  world.tell(planner);
  for (int y = 25; y < 35; ++y)
    for (int x = 50; x < 60; ++x) planner.set_obstacle(middle(x, y), 0.02);
  planner.finish();
  EXPECT_EQ(at(5.5, 3), Standing::no_floor);
}

TEST_F(GoalCheckTest, ReplacesAGoalByTheNearestPlace) {
  world.fill(50, 60, 25, 35);
  const GoalFinding refused = judge(5.2, 3, false);
  EXPECT_EQ(refused.standing, Standing::occupied);
  EXPECT_FALSE(refused.moved.has_value());
  const GoalFinding moved = judge(5.2, 3, true);
  EXPECT_EQ(moved.standing, Standing::standable);
  ASSERT_TRUE(moved.moved.has_value());
  EXPECT_NEAR(*moved.moved, 0.45, 0.15);
  EXPECT_LT(moved.place.x(), 4.9);
  EXPECT_GT(moved.length, 2.0);
}

/// A block of 6 x 6 m, and around it pillars that leave a tapered body no room at any of 16 headings, but at
/// one place; on 64 x 64 tiles.
class GoalCheckAmongPillars : public testing::Test {
 protected:
  GoalCheckAmongPillars() {
    GridWorld world(1024, 1024);
    for (int y = 2; y < 1024; y += 3)
      for (int x = 2; x < 1024; x += 3) world.fill(x, x + 1, y, y + 1);
    world.fill(670, 730, 670, 730);
    world.fill(420, 432, 395, 407, false);
    world.tell(planner);
  }
  static Platform tapered() {
    Platform body = wheeled();
    body.length = 1.0;
    body.width = 0.5;
    body.footprint = {{0.5, -0.1}, {0.5, 0.1}, {-0.5, 0.25}, {-0.5, -0.25}};
    return body;
  }

  RoutePlanner planner{tapered()};
  GoalCheck check{tapered()};
};

TEST_F(GoalCheckAmongPillars, EndsAtItsBudget) {
  ASSERT_GT(planner.map().used(), 4000);
  EXPECT_GT(check.budget(), 1000);
  int checks = check.budget();
  EXPECT_FALSE(check.nearest(planner, {60, 30, 0}, 0.0, checks).has_value());
  EXPECT_EQ(checks, 0);
  const GoalFinding found = check.check(planner, {2, 3, 0}, {60.25, 30.25, 0}, true);
  EXPECT_EQ(found.standing, Standing::occupied);
  EXPECT_FALSE(found.moved.has_value());
}

TEST_F(GoalCheckAmongPillars, ASolidBlockTakesNoChecks) {
  int checks = check.budget();
  EXPECT_FALSE(check.nearest(planner, {70, 70, 0}, 0.0, checks).has_value());
  EXPECT_GT(checks, check.budget() * 9 / 10);
}

TEST_F(GoalCheckAmongPillars, FindsTheNearestPlaceWithinItsBudget) {
  // Brute force over all places within 3 m.
  const Eigen::Vector3d goal(41.2, 40.1, 0);
  double nearest = 1e9;
  for (int dy = -30; dy <= 30; ++dy)
    for (int dx = -30; dx <= 30; ++dx)
      if (const double range = std::hypot(dx, dy) * 0.1; range <= GoalCheck::kNearest && range < nearest)
        if (check.stand(planner, goal + Eigen::Vector3d(0.1 * dx, 0.1 * dy, 0), 0.0) == Standing::standable)
          nearest = range;
  ASSERT_GT(nearest, 0.5);
  ASSERT_LT(nearest, GoalCheck::kNearest);
  int plenty = 1'000'000;
  const auto found = check.nearest(planner, goal, 0.0, plenty);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR((*found - goal).norm(), nearest, 1e-9);
  int just = 1'000'000 - plenty, less = just - 1;
  EXPECT_EQ(check.nearest(planner, goal, 0.0, just), found);
  EXPECT_EQ(just, 0);
  EXPECT_FALSE(check.nearest(planner, goal, 0.0, less).has_value());
}

TEST_F(GoalCheckTest, AnUnseenGoalHasItsMetresThroughTheUnknown) {
  // A door in the wall at x = 10.
  world.fill(99, 100, 25, 35, false);
  const GoalFinding found = judge(15, 3, false);
  EXPECT_EQ(found.standing, Standing::unseen);
  EXPECT_NEAR(found.length, 13, 0.5);
  EXPECT_NEAR(found.unknown_length, 5, 0.6);
}

TEST_F(GoalCheckTest, OnACompleteMapUnknownSpaceIsNoGround) {
  world.fill(99, 100, 25, 35, false);
  RouteParams params;
  params.through_unknown = false;
  RoutePlanner complete(body, params);
  world.tell(complete);
  EXPECT_FALSE(complete.plan({2, 3, 0}, {15, 3, 0}).found());
  EXPECT_TRUE(complete.plan({2, 3, 0}, {8, 3, 0}).found());
}

}  // namespace
}  // namespace adit::nav::test
