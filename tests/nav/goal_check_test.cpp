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
