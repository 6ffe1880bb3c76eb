// SPDX-License-Identifier: Apache-2.0
// Whole drives: scan, plan and follow in worlds of boxes, for the three standard platforms.
#include <gtest/gtest.h>

#include "tests/nav/closed_loop.hpp"

namespace adit::nav::test {
namespace {

class EveryPlatform : public ::testing::TestWithParam<Platform> {};

/// A corridor along x, 2 m wide, from x0 to x1, closed at both ends.
BoxWorld corridor(double x0, double x1) {
  return {{{x0, x1, 1.0, 1.2}, {x0, x1, -1.2, -1.0}, {x0 - 0.2, x0, -1.2, 1.2}, {x1, x1 + 0.2, -1.2, 1.2}}};
}

/// A wall across y at x, with an opening of `width` around y.
void add_door(BoxWorld& world, double x, double y, double width) {
  world.boxes.push_back({x, x + 0.15, y + width / 2, y + 5});
  world.boxes.push_back({x, x + 0.15, y - 5, y - width / 2});
}

TEST_P(EveryPlatform, DrivesDownACorridor) {
  ClosedLoop run(GetParam(), corridor(-2, 16), {0, 0.3, 0.2});
  EXPECT_TRUE(run.drive(Target::to({13, 0}), 40));
  EXPECT_LT(run.distance_to(13, 0), 0.3);
  EXPECT_GT(run.least_clearance, 0.1);
  EXPECT_GT(run.fastest, 0.8 * GetParam().max_speed);
  EXPECT_LE(run.fastest, GetParam().max_speed + 1e-9);
  EXPECT_LE(run.steepest, GetParam().max_acceleration + 1e-6);
}

TEST_P(EveryPlatform, GoesThroughADoor) {
  BoxWorld world{{{-3, 8, 3, 3.2}, {-3, 8, -3.2, -3}, {-3.2, -3, -3, 3}, {8, 8.2, -3, 3}}};
  add_door(world, 3.0, 0.0, 0.9);
  ClosedLoop run(GetParam(), world, {0, 0.6, 0.3});
  EXPECT_TRUE(run.drive(Target::to({6, 0.3}), 60));
  EXPECT_GT(run.least_clearance, 0.02);
}

TEST_P(EveryPlatform, PicksItsWayThroughClutter) {
  BoxWorld world = corridor(-2, 14);
  for (Box& wall : world.boxes) {  // widened to 5 m
    if (wall.y0 == 1.0) wall.y0 = 2.5, wall.y1 = 2.7;
    if (wall.y1 == -1.0) wall.y0 = -2.7, wall.y1 = -2.5;
  }
  for (const auto& [x, y] :
       {std::pair{2.5, 0.1}, {4.2, -1.4}, {4.4, 1.2}, {6.3, 0.0}, {8.3, 1.3}, {8.6, -1.0}})
    world.boxes.push_back({x - 0.2, x + 0.2, y - 0.2, y + 0.2, 0.0, 0.6});
  ClosedLoop run(GetParam(), world, {0, 0, 0});
  EXPECT_TRUE(run.drive(Target::to({11, 0}), 60));
  EXPECT_GT(run.least_clearance, 0.03);
}

TEST_P(EveryPlatform, TurnsRoundForAGoalBehind) {
  ClosedLoop run(GetParam(), corridor(-10, 10), {0, 0, 0});
  EXPECT_TRUE(run.drive(Target::to({-6, 0}), 40));
  EXPECT_GT(run.least_clearance, 0.1);
  EXPECT_LT(run.driven, 8.0);
}

TEST_P(EveryPlatform, BacksOutOfWhereItCannotTurn) {
  // A niche that fits the robot, closed in front: the way out is backwards.
  const Platform p = GetParam();
  const double side = p.width / 2 + 0.12;
  BoxWorld world{{{-0.6, 1.5, side, side + 0.2},
                  {-0.6, 1.5, -side - 0.2, -side},
                  {1.3, 1.5, -side, side},
                  {-8, -7.8, -3, 3}}};
  ClosedLoop run(p, world, {0.4, 0, 0});
  EXPECT_TRUE(run.drive(Target::to({-5, 0}), 60));
  EXPECT_GT(run.least_clearance, 0.02);
}

TEST_P(EveryPlatform, StopsInADeadEndAndSaysSo) {
  BoxWorld world{{{-1, 4, 1.0, 1.2}, {-1, 4, -1.2, -1.0}, {4, 4.2, -1.2, 1.2}}};
  ClosedLoop run(GetParam(), world, {0, 0, 0});
  EXPECT_FALSE(run.drive(Target::to({9, 0}), 30));
  EXPECT_TRUE(run.last.blocked);
  EXPECT_TRUE(run.follower.command().zero());
  EXPECT_GT(run.truth.x, 1.5);
  EXPECT_GT(run.least_clearance, 0.03);
}

TEST_P(EveryPlatform, GivesUpAGoalThatItCannotComeNearTo) {
  // The goal is too close to a wall: nothing ahead is blocked, the robot could drive to and fro for ever.
  BoxWorld world = corridor(-2, 12);
  ClosedLoop run(GetParam(), world, {0, 0, 0});
  EXPECT_FALSE(run.drive(Target::to({5, 0.95}), 30));
  EXPECT_TRUE(run.recovery.gave_up());
  EXPECT_TRUE(run.follower.command().zero());
  EXPECT_GT(run.least_clearance, 0.03);
  const double driven = run.driven;
  run.drive(Target::to({5, 0.95}), 5);
  EXPECT_EQ(run.driven, driven) << "and stands";
  EXPECT_TRUE(run.drive(Target::to({8, 0}), 30)) << "another goal is another matter";
}

TEST_P(EveryPlatform, SmartJoystickStopsBeforeAWall) {
  BoxWorld world{{{5, 5.2, -20, 20}}};
  ClosedLoop run(GetParam(), world, {0, 0, 0});
  run.drive(Target::along(0.0, GetParam().max_speed), 20);
  EXPECT_TRUE(run.last.blocked);
  EXPECT_TRUE(run.follower.command().zero());
  EXPECT_GT(run.least_clearance, 0.05);
  EXPECT_GT(run.truth.x + GetParam().length / 2, 4.2);
  EXPECT_LT(std::fabs(run.truth.y), 1.0);
}

TEST_P(EveryPlatform, SeesAWallWithOneRing) {
  BoxWorld world = corridor(-2, 10);
  ClosedLoop run(GetParam(), world, {0, 0, 0});
  run.rings = 1;
  EXPECT_FALSE(run.drive(Target::to({15, 0}), 50));
  EXPECT_TRUE(run.last.blocked);
  EXPECT_GT(run.least_clearance, 0.03);
  EXPECT_GT(run.truth.x, 7.5);
}

TEST_P(EveryPlatform, PassesAnOncomingPerson) {
  BoxWorld world{{{-2, 16, 1.75, 1.95}, {-2, 16, -1.95, -1.75}}};
  world.boxes.push_back({});
  ClosedLoop run(GetParam(), world, {0, 0, 0});
  double x = 10.0;
  bool arrived = false;
  for (int i = 0; i < 400 && !arrived; ++i) {
    if (x > -1.0) x -= 0.04;  // 0.4 m/s
    run.world.boxes.back() = {x, x + 0.6, -0.55, 0.0, 0.0, 0.5};
    run.cycle(Target::to({13, 0}));
    arrived = run.last.arrived;
  }
  EXPECT_TRUE(arrived);
  EXPECT_GT(run.least_clearance, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Nav, EveryPlatform, ::testing::Values(wheeled(), tracked(), legged()),
                         [](const auto& one) { return one.param.name; });

/// A car with each controller.
class EveryCar : public ::testing::TestWithParam<std::string> {
 protected:
  /// Drives to the goal; checks that it never turns tighter than its steering lets it.
  bool drive(ClosedLoop& run, const Eigen::Vector2d& goal, double seconds) {
    for (const double end = run.time + seconds; run.time < end;) {
      const Pose2 before = run.truth * Pose2{-run.platform.rear_axle(), 0, 0};
      run.cycle(Target::to(goal));
      const Pose2 moved = before.inverse() * (run.truth * Pose2{-run.platform.rear_axle(), 0, 0});
      const double way = std::hypot(moved.x, moved.y);
      EXPECT_LE(std::fabs(moved.yaw), way / run.platform.least_radius() + 2e-3);
      backwards_ |= run.follower.command().vx < -0.1;
      if (run.last.arrived && run.follower.command().zero()) return true;
    }
    return false;
  }
  bool backwards_{false};
};

TEST_P(EveryCar, DrivesDownACorridor) {
  ClosedLoop run(car(), corridor(-2, 16), {0, 0.3, 0.2}, GetParam());
  EXPECT_TRUE(drive(run, {13, 0}, 40));
  EXPECT_GT(run.least_clearance, 0.1);
  EXPECT_GT(run.fastest, 0.9);
  EXPECT_FALSE(backwards_);
}

TEST_P(EveryCar, GoesThroughADoorAndRoundCrates) {
  BoxWorld world{{{-3, 12, 3, 3.2}, {-3, 12, -3.2, -3}, {-3.2, -3, -3, 3}, {12, 12.2, -3, 3}}};
  add_door(world, 3.0, 0.0, 1.1);
  world.boxes.push_back({6.5, 7.0, -0.6, 0.8, 0.0, 0.6});
  ClosedLoop run(car(), world, {0, 0.6, 0.3}, GetParam());
  EXPECT_TRUE(drive(run, {10, 0.3}, 60));
  EXPECT_GT(run.least_clearance, 0.03);
}

TEST_P(EveryCar, ComesToGoalsBesideAndBehindIt) {
  for (const Eigen::Vector2d& goal : {Eigen::Vector2d(0, 1), {0.3, -0.8}, {-1, 0.4}, {-3, 2}, {-6, 0}}) {
    ClosedLoop run(car(), corridor(-10, 10), {0, 0, 0}, GetParam());
    for (Box& wall : run.world.boxes) {  // widened to 7 m
      if (wall.y0 == 1.0) wall.y0 = 3.5, wall.y1 = 3.7;
      if (wall.y1 == -1.0) wall.y0 = -3.7, wall.y1 = -3.5;
    }
    EXPECT_TRUE(drive(run, goal, 40)) << goal.transpose();
    EXPECT_LT(run.distance_to(goal.x(), goal.y()), 0.3);
    EXPECT_GT(run.least_clearance, 0.1);
  }
  EXPECT_TRUE(backwards_);
}

TEST_P(EveryCar, BacksOutOfANiche) {
  const double side = car().width / 2 + 0.12;
  const BoxWorld world{{{-0.8, 1.5, side, side + 0.2},
                        {-0.8, 1.5, -side - 0.2, -side},
                        {1.3, 1.5, -side, side},
                        {-8, -7.8, -3, 3}}};
  ClosedLoop run(car(), world, {0.4, 0, 0}, GetParam());
  EXPECT_TRUE(drive(run, {-5, 0}, 40));
  EXPECT_GT(run.least_clearance, 0.02);
}

TEST_P(EveryCar, StandsBeforeAGoalInAWall) {
  ClosedLoop run(car(), corridor(-2, 12), {0, 0, 0}, GetParam());
  EXPECT_FALSE(drive(run, {5, 0.95}, 60));
  EXPECT_TRUE(run.last.blocked);
  EXPECT_TRUE(run.follower.command().zero());
  EXPECT_GT(run.least_clearance, 0.03);
  EXPECT_GT(run.truth.x, 3.5) << "as near as it can";
}

TEST_P(EveryCar, AStickLeadsItRoundACrateAndStopsItBeforeAWall) {
  BoxWorld world{{{8, 8.2, -20, 20}, {3, 3.4, -0.3, 0.5}}};
  ClosedLoop run(car(), world, {0, 0, 0}, GetParam());
  run.drive(Target::along(0.0, 1.0), 30);
  EXPECT_TRUE(run.last.blocked);
  EXPECT_GT(run.truth.x, 5.5);
  EXPECT_GT(run.least_clearance, 0.03);
  run.drive(Target::along(M_PI, 0.5), 3);
  EXPECT_LT(run.follower.command().vx, -0.2) << "back where the stick says so";
}

INSTANTIATE_TEST_SUITE_P(Nav, EveryCar, ::testing::ValuesIn(controller_names()),
                         [](const auto& one) { return one.param; });

TEST(ClosedLoopSlip, ATrackedRobotThatLosesMuchOfEachTurnArrives) {
  Platform slippery = tracked();
  slippery.turn_slip = 0.35;
  for (const std::string& tracks : controller_names()) {
    BoxWorld world = corridor(-6, 10);
    world.boxes.push_back({3, 3.4, -0.9, -0.4});
    ClosedLoop run(slippery, world, {0, 0, M_PI}, tracks);
    EXPECT_TRUE(run.drive(Target::to({7, 0}), 40)) << tracks;
    EXPECT_GT(run.least_clearance, 0.03) << tracks;
  }
}

TEST(ClosedLoopNoise, ArrivesWithNoisyRanges) {
  ClosedLoop run(wheeled(), corridor(-2, 16), {0, 0, 0});
  run.noise = 0.03;
  EXPECT_TRUE(run.drive(Target::to({12, 0.2}), 40));
  EXPECT_GT(run.least_clearance, 0.1);
}

TEST(ClosedLoopOdometry, ABiasedOdometryMissesByTheBias) {
  ClosedLoop run(wheeled(), BoxWorld{{{-5, 15, 5, 5.2}, {-5, 15, -5.2, -5}}}, {0, 0, 0});
  run.bias = {0.8, -0.6, 0};
  EXPECT_TRUE(run.drive(Target::to({6, 1}), 30));
  EXPECT_GT(run.distance_to(6, 1), 0.7);
  EXPECT_LT(run.distance_to(6 - 0.8, 1 + 0.6), 0.3);
}

TEST(ClosedLoopDeterminism, SameSeedSameDrive) {
  std::vector<double> ends;
  for (int i = 0; i < 2; ++i) {
    ClosedLoop run(tracked(), corridor(-2, 10), {0, 0.2, 0.1});
    run.drive(Target::to({7, 0}), 15);
    ends.insert(ends.end(), {run.truth.x, run.truth.y, run.truth.yaw, run.time});
  }
  EXPECT_EQ(std::vector(ends.begin(), ends.begin() + 4), std::vector(ends.begin() + 4, ends.end()));
}

TEST(ClosedLoopWithoutCorrespondences, OnlyTheMonitorIsLeft) {
  // What the other tests would see if the correspondence grid were lost: no plan says "blocked" any more, and
  // only the collision monitor is left between the robot and the wall.
  BoxWorld world{{{4, 4.2, -1.2, 1.2}}};
  ClosedLoop with(wheeled(), world, {0, 0, 0}), without(wheeled(), world, {0, 0, 0});
  auto emptied = std::make_shared<PlannerLibrary>(*PlannerLibrary::build(wheeled()));
  for (auto& option : emptied->options) option.grid = {};
  without.local_navigation = LocalNavigation(wheeled(), emptied);
  EXPECT_TRUE(with.drive(Target::to({8, 0}), 25));
  EXPECT_FALSE(without.drive(Target::to({8, 0}), 15));
  EXPECT_EQ(without.blocked_cycles, 0);
  EXPECT_GT(without.held_steps, 0);
  EXPECT_GT(without.least_clearance, 0.0);
}

}  // namespace
}  // namespace adit::nav::test
