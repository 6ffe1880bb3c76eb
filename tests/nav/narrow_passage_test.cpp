// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/folders/folders.hpp"
#include "tests/nav/route_drive.hpp"
#include "tests/nav/route_world.hpp"

namespace adit::nav::test {
namespace {

/// A hall of 10 x 6 m; a wall across it at x = 5 m with a gap from y = `low` to `high`, cells of 0.1 m.
void set_hall(RoutePlanner& planner, int low, int high) {
  GridWorld world(100, 60);
  world.border();
  world.fill(50, 52, 0, 60);
  world.fill(50, 52, low, high, false);
  world.tell(planner);
}

TEST(NarrowPassage, IsTheMiddleOfAGapAndPointsThroughIt) {
  RoutePlanner planner(wheeled());
  set_hall(planner, 27, 33);
  for (const bool back : {false, true}) {
    const Eigen::Vector3d a{3.5, 1.5, 0}, b{6.5, 4.5, 0};
    const Route route = back ? planner.plan(b, a) : planner.plan(a, b);
    ASSERT_TRUE(route.found());
    const auto passage = planner.passage(route.points, 5.0);
    ASSERT_TRUE(passage);
    EXPECT_NEAR(passage->middle.x(), 5.1, 0.15);
    EXPECT_NEAR(passage->middle.y(), 3.0, 0.06);
    EXPECT_NEAR(passage->axis.x(), back ? -1 : 1, 0.05);
    EXPECT_NEAR(passage->clear_width, 0.7, 0.01) << "between the middles of the cells on both sides";
  }
}

TEST(NarrowPassage, ItIsAsNarrowForARouteBesideItsMiddle) {
  RoutePlanner planner(car());
  set_hall(planner, 26, 33);  // 10 cm wider than it is; 20 cm from cell to cell
  for (const double y : {2.86, 2.95, 3.04}) {
    const std::vector<Eigen::Vector3d> points{{3.5, y, 0}, {6.5, y, 0}};
    const auto passage = planner.passage(points, 5.0);
    ASSERT_TRUE(passage) << y;
    EXPECT_NEAR(passage->middle.y(), 2.95, 0.06) << y;
  }
}

TEST(NarrowPassage, ADoorAtTheEndOfAPassageIsOneThePassageIsNot) {
  for (const Platform& platform : {car(), tracked()}) {
    RoutePlanner planner(platform);
    GridWorld world(100, 60);
    world.border();
    world.fill(0, 52, 0, 60);
    world.fill(0, 50, 26, 35, false);   // a passage 0.9 m wide
    world.fill(50, 52, 27, 34, false);  // and its door
    world.tell(planner);
    const std::vector<Eigen::Vector3d> points{{2, 3.05, 0}, {8, 3.05, 0}};
    const auto passage = planner.passage(points, 5.0);
    ASSERT_TRUE(passage) << platform.name;
    EXPECT_NEAR(passage->middle.x(), 5.1, 0.15) << platform.name;
    EXPECT_FALSE(planner.passage(points, 2.0)) << platform.name << ": the passage";
  }
}

TEST(NarrowPassage, AWideOpeningAndOneWallAreNone) {
  RoutePlanner planner(wheeled());
  set_hall(planner, 20, 40);
  const Route through = planner.plan({3.5, 1.5, 0}, {6.5, 4.5, 0});
  ASSERT_TRUE(through.found());
  EXPECT_FALSE(planner.passage(through.points, 5.0));
  const Route along = planner.plan({1, 0.5, 0}, {4, 0.5, 0});
  ASSERT_TRUE(along.found());
  EXPECT_FALSE(planner.passage(along.points, 5.0)) << "a wall on one side";
}

TEST(NarrowPassage, FartherThanAskedForOrWhereTheRouteBeginsItIsNone) {
  RoutePlanner planner(wheeled());
  set_hall(planner, 27, 33);
  const Route far = planner.plan({1, 3, 0}, {9, 3, 0});
  ASSERT_TRUE(far.found());
  EXPECT_FALSE(planner.passage(far.points, 2.0));
  const Route within = planner.plan({5.1, 3.05, 0}, {9, 3, 0});
  ASSERT_TRUE(within.found());
  EXPECT_FALSE(planner.passage(within.points, 4.0));
}

TEST(NarrowPassage, WideGapIsNoPassage) {
  for (const auto& [high, is_passage] : {std::pair{33, true}, std::pair{34, false}}) {  // 0.7 and 0.8 m
    RoutePlanner planner(wheeled());
    set_hall(planner, 27, high);
    const std::vector<Eigen::Vector3d> points{{3.5, 3, 0}, {6.5, 3, 0}};
    EXPECT_EQ(planner.passage(points, 5.0).has_value(), is_passage) << high;
  }
}

TEST(NarrowPassage, SidesThatAreNotOppositeEachOtherAreFittedByTheWidestStrip) {
  for (const double turned : {0.0, 10.0, 20.0}) {  // of the route, past the block
    RoutePlanner planner(tracked());
    GridWorld world(100, 60);
    world.border();
    world.fill(38, 56, 34, 60);  // long on the left
    world.fill(52, 56, 0, 27);   // a short block on the right, at its far end
    world.tell(planner);
    const double t = turned * M_PI / 180.0;
    const Eigen::Vector3d middle(5.2, 3.05, 0), along(std::cos(t), std::sin(t), 0);
    const std::vector<Eigen::Vector3d> points{middle - 2.0 * along, middle + 2.0 * along};
    const auto passage = planner.passage(points, 4.0);
    ASSERT_TRUE(passage) << turned;
    EXPECT_NEAR(passage->axis.y(), 0.0, 0.03) << turned;
    EXPECT_NEAR(passage->middle.y(), 3.05, 0.06) << turned;
    EXPECT_NEAR(passage->clear_width, 0.8, 0.02) << turned;
  }
}

TEST(NarrowPassage, TheKeeperLeadsBehindItOnItsAxis) {
  RoutePlanner planner(wheeled());
  set_hall(planner, 27, 33);
  RouteFollower route_follower;
  const Eigen::Vector3d goal{8, 1.5, 0};
  const RouteStep aside =
      route_follower.step(planner, {.place = {4.2, 1.5, 0}, .goal = goal, .stamp_s = 0.0});
  ASSERT_TRUE(aside.passage);
  EXPECT_NEAR(aside.target.y(), 3.0, 0.1);
  EXPECT_NEAR(aside.target.x(), 6.0, 0.2) << "behind it, on its axis";
  const RouteStep behind =
      route_follower.step(planner, {.place = {5.9, 3.0, 0}, .goal = goal, .stamp_s = 2.0});
  EXPECT_FALSE(behind.passage);
  EXPECT_LT(behind.target.y(), 2.5) << "and on along the route";
}

/// Where the keeper, at x, says that the middle of the passage is after one of its sides was found 10 cm
/// nearer.
double middle_seen_again_from(double x) {
  RoutePlanner planner(wheeled());
  set_hall(planner, 27, 33);
  RouteFollower route_follower;
  const Eigen::Vector3d goal{8, 3.0, 0};
  route_follower.step(planner, {.place = {x, 3.0, 0}, .goal = goal, .stamp_s = 0.0});
  for (const int cell : {50, 51}) planner.set_obstacle(middle(cell, 32), 2.0);
  planner.finish();
  return route_follower.step(planner, {.place = {x, 3.0, 0}, .goal = goal, .stamp_s = 0.1})
      .passage.value()
      .middle.y();
}

TEST(NarrowPassage, StaysWhenANearViewShiftsItByLessThanTenCentimetres) {
  EXPECT_NEAR(middle_seen_again_from(2.3), 2.95, 0.01) << "2.8 m before it";
  EXPECT_NEAR(middle_seen_again_from(3.5), 3.0, 0.01) << "1.6 m before it";
}

TEST(NarrowPassage, AWallWhoseFootWasTakenTooHighIsNoStep) {
  RoutePlanner planner(tracked());  // it climbs 15 cm
  for (int x = 0; x < 60; ++x)
    for (int y = 0; y < 60; ++y) {
      const bool wall = x == 0 || y == 0 || x == 59 || y == 59 || (x == 30 && (y < 27 || y > 32));
      const Eigen::Vector3d place(0.1 * x + 0.05, 0.1 * y + 0.05, wall ? 0.25 : 0.0);
      if (wall)
        planner.set_obstacle(place, 0.5);
      else
        planner.set_ground(place);
    }
  planner.finish();
  EXPECT_TRUE(planner.plan({1.5, 3, 0}, {4.5, 3, 0}).found());
}

/// A hall with a wall across it, and a gap in that, so much wider than the robot; started from aside.
void expect_passed(const Platform& platform, double wider) {
  const double half = (platform.width + wider) / 2;
  for (const double y : all_seeds() ? std::vector{1.0, 2.0, 3.0, 4.0, 5.0} : std::vector{1.0, 4.0}) {
    BoxWorld world{{{-0.2, 0, 0, 6},
                    {10, 10.2, 0, 6},
                    {0, 10, -0.2, 0},
                    {0, 10, 6, 6.2},
                    {5, 5.2, 0, 3 - half},
                    {5, 5.2, 3 + half, 6}}};
    RouteDrive drive(platform, world, {2, y, 0});
    EXPECT_TRUE(drive.to(8, 2, 60)) << platform.name << ", " << wider << " m wider, from y = " << y;
    EXPECT_GT(drive.loop.least_clearance, 0.0)
        << platform.name << ", " << wider << " m wider, from y = " << y;
  }
}

TEST(NarrowPassage, ARobotPassesAGapFifteenCentimetresWiderThanItself) {
  for (const Platform& platform : {wheeled(), tracked(), legged()}) expect_passed(platform, 0.15);
}

TEST(NarrowPassage, ACarPassesAGapTenCentimetresWiderThanItself) {
  for (const double wider : all_seeds() ? std::vector{0.10, 0.15, 0.20, 0.25, 0.30} : std::vector{0.10})
    expect_passed(car(), wider);
}

TEST(NarrowPassage, ItGoesStraightOnUntilItHasLeftIt) {
  RoutePlanner planner(wheeled());
  set_hall(planner, 27, 33);
  RouteFollower route_follower;
  const Eigen::Vector3d goal{8, 1.0, 0};
  for (const double x : {4.0, 4.6, 5.1, 5.5}) {
    const RouteStep step = route_follower.step(planner, {.place = {x, 3.0, 0}, .goal = goal, .stamp_s = x});
    EXPECT_NEAR(step.target.x(), 6.0, 0.2) << x;
    EXPECT_GT(step.target.y(), 2.6) << x << ": the goal lies aside";
  }
  EXPECT_LT(route_follower.step(planner, {.place = {5.8, 3.0, 0}, .goal = goal, .stamp_s = 6.0}).target.y(),
            2.4);
}

/// The hall with one gap: a robot before it is asked to look for another route.
RouteStep look_around_in_hall(RoutePlanner& planner, bool only_if_found) {
  set_hall(planner, 26, 33);
  RouteFollower route_follower(car());
  const RouteRequest request{.place = {4.4, 3.1, 0}, .goal = {8, 1.0, 0}};
  EXPECT_TRUE(route_follower.step(planner, request).passage);
  RouteRequest asks = request;
  asks.ask = only_if_found ? RouteAsk::around_if_found : RouteAsk::around;
  asks.stamp_s = 1.0;
  return route_follower.step(planner, asks);
}

TEST(NarrowPassage, ABlockedOneIsClosedInItsMiddle) {
  RoutePlanner planner(car());
  const RouteStep step = look_around_in_hall(planner, false);
  EXPECT_EQ(step.state, RouteStep::State::blocked);
  EXPECT_TRUE(step.replanned);
  ASSERT_EQ(planner.map().blocked_places().size(), 1u);
  EXPECT_NEAR(planner.map().blocked_places().front().y, 3.0, 0.15) << "not before the robot, which is aside";
  planner.map().unblock();
  EXPECT_FALSE(planner.map().has_blocked_places());
}

TEST(NarrowPassage, WhatMovesClosesNoneIfThereIsNoOtherWay) {
  RoutePlanner planner(car());
  const RouteStep step = look_around_in_hall(planner, true);
  EXPECT_EQ(step.state, RouteStep::State::along);
  EXPECT_FALSE(planner.map().has_blocked_places());
}

TEST(NarrowPassage, FarBeforeItWhatBlocksIsAheadOfTheRobot) {
  RoutePlanner planner(wheeled());
  set_hall(planner, 27, 33);
  RouteFollower route_follower;
  RouteRequest request{.place = {2.5, 3.05, 0}, .goal = {8, 1.0, 0}};
  route_follower.step(planner, request);
  request.ask = RouteAsk::around;
  route_follower.step(planner, request);
  ASSERT_EQ(planner.map().blocked_places().size(), 1u);
  EXPECT_NEAR(planner.map().blocked_places().front().x, 3.4, 0.1);
}

TEST(NarrowPassage, WhatBlocksBehindItLeavesItOpen) {
  RoutePlanner planner(wheeled());
  set_hall(planner, 27, 33);
  RouteFollower route_follower;
  RouteRequest request{.place = {4.4, 3.0, 0}, .goal = {9, 3.0, 0}};
  EXPECT_TRUE(route_follower.step(planner, request).passage);
  request.ask = RouteAsk::around;
  request.blocked_ahead = 3.0;
  route_follower.step(planner, request);
  ASSERT_EQ(planner.map().blocked_places().size(), 1u);
  EXPECT_NEAR(planner.map().blocked_places().front().x, 7.4, 0.2);
}

}  // namespace
}  // namespace adit::nav::test
