// SPDX-License-Identifier: Apache-2.0
#include "nav/recovery/recovery.hpp"

#include <gtest/gtest.h>

#include <map>

#include "nav/recovery/way_back.hpp"
#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

/// A robot on a route of 20 m. It backs up when it is asked to, and is asked ten times a second.
class RecoveryTest : public testing::Test {
 protected:
  RecoveryState look(double seconds) {
    for (double end = now + seconds; now < end - 1e-9; now += 0.1) {
      in.stamp_s = now;
      if (recovery.state() == RecoveryState::back_up) in.at.x() -= 0.05;
      const RecoveryState before = recovery.state();
      if (recovery.look(in) != before) ++begun[recovery.state()];
      if (const RouteAsk ask = recovery.take_ask(); ask == RouteAsk::open) {
        opens = true;
      } else if (ask != RouteAsk::none) {
        replans.push_back(ask == RouteAsk::around_if_found);
        if (answer) recovery.replanned(), in.route = *answer;
      }
    }
    return recovery.state();
  }
  void drive(double metres) {
    for (double way = 0; way < metres; way += 0.1) {
      in.at.x() += 0.1;
      in.left -= 0.1;
      look(0.1);
    }
  }

  Recovery recovery{};
  RecoveryInput in{.goal = 1, .route = 1, .left = 20.0};
  double now{0};
  std::map<RecoveryState, int> begun{};
  std::vector<bool> replans{};
  bool opens{};                           ///< The router was asked to open what it marked.
  std::optional<std::uint32_t> answer{};  ///< Number of the route that the router finds.
};

TEST_F(RecoveryTest, AMomentIsNoBlock) {
  in.blocked = true;
  in.cause = Cause::fixed;
  EXPECT_EQ(look(0.9), RecoveryState::drive);
  in.blocked = false;
  look(0.5);
  in.blocked = true;
  EXPECT_EQ(look(0.9), RecoveryState::drive) << "blocked cycles far apart do not add up";
}

TEST_F(RecoveryTest, WhatStandsInTheWayIsReportedWhileItTriesUntilItMakesProgress) {
  in.blocked = true;
  in.cause = Cause::fixed;
  look(2.9);
  EXPECT_EQ(recovery.reason(), Reason::none);
  look(0.3);
  EXPECT_NE(recovery.state(), RecoveryState::give_up);
  EXPECT_EQ(recovery.reason(), Reason::blocked) << "its operator hears of it after 3 s";
  EXPECT_EQ(recovery.cause(), Cause::fixed);
  in.blocked = false;
  look(2);
  EXPECT_EQ(recovery.state(), RecoveryState::drive);
  EXPECT_EQ(recovery.reason(), Reason::blocked) << "it is where it was";
  drive(0.7);
  EXPECT_EQ(recovery.reason(), Reason::none);
}

TEST_F(RecoveryTest, ADoorThatOpensLeavesNothingToReport) {
  in.blocked = true;
  in.cause = Cause::fixed;
  look(3.5);
  in.route = 0;
  in.unreachable = true;
  look(20);
  EXPECT_EQ(recovery.reason(), Reason::goal_unreachable);
  in.route = 2;
  in.unreachable = in.blocked = false;
  look(0.1);
  EXPECT_EQ(recovery.state(), RecoveryState::drive);
  EXPECT_EQ(recovery.reason(), Reason::none);
}

TEST_F(RecoveryTest, AMomentWithAFreePathIsNoWayOut) {
  in.cause = Cause::fixed;
  for (int n = 0; n < 4; ++n) {
    in.blocked = true;
    look(0.9);
    in.blocked = false;
    look(0.1);
  }
  EXPECT_EQ(recovery.reason(), Reason::blocked);
  look(1.1);
  EXPECT_EQ(recovery.reason(), Reason::none);
}

TEST_F(RecoveryTest, TriesEachThingOnceThenAnotherWayThenStands) {
  in.blocked = true;
  in.cause = Cause::fixed;
  answer = 0;
  look(60);
  EXPECT_EQ(begun[RecoveryState::nudge], 1);
  EXPECT_EQ(begun[RecoveryState::back_up], 1);
  EXPECT_EQ(replans, std::vector{false});
  EXPECT_EQ(begun[RecoveryState::give_up], 1);
  EXPECT_EQ(recovery.reason(), Reason::blocked);
}

TEST_F(RecoveryTest, GivesUpWithin15Seconds) {
  in.blocked = true;
  in.cause = Cause::fixed;
  answer = 0;
  EXPECT_EQ(look(15), RecoveryState::give_up);
}

// The targets of a route slide with the robot, and the map moves its goal: neither is progress.
TEST_F(RecoveryTest, NeitherAnotherRouteNorAnotherGoalRestoresItsAttempts) {
  in.blocked = true;
  in.cause = Cause::fixed;
  for (std::uint32_t n = 1; n < 40; ++n) {
    in.route = n;
    in.goal = 1 + n / 10;
    answer = n + 1;
    look(1.5);
  }
  EXPECT_EQ(begun[RecoveryState::nudge], 1);
  EXPECT_EQ(begun[RecoveryState::back_up], 1);
}

TEST_F(RecoveryTest, ProgressOnTheRouteElsewhereRestoresThem) {
  in.blocked = true;
  in.cause = Cause::fixed;
  answer = 2;
  look(20);
  ASSERT_EQ(begun[RecoveryState::back_up], 1);
  in.route = 3;
  in.blocked = false;
  drive(1.8);
  in.blocked = true;
  look(3);
  EXPECT_EQ(begun[RecoveryState::back_up], 1) << "it only drove back to where it was";
  in.blocked = false;
  in.route = 4;
  drive(6);
  in.blocked = true;
  look(10);
  EXPECT_EQ(begun[RecoveryState::back_up], 2);
}

TEST_F(RecoveryTest, WaitsForWhatMovesAndGoesOn) {
  in.blocked = true;
  in.cause = Cause::mover;
  EXPECT_EQ(look(2), RecoveryState::wait);
  EXPECT_EQ(recovery.reason(), Reason::none);
  look(1.5);
  EXPECT_EQ(recovery.reason(), Reason::blocked) << "its operator hears of it after 3 s";
  EXPECT_EQ(recovery.cause(), Cause::mover);
  look(60);
  EXPECT_EQ(replans, (std::vector{true, true})) << "twice in a minute it looks for a way round";
  EXPECT_EQ(recovery.state(), RecoveryState::wait);
  in.blocked = false;
  EXPECT_EQ(look(0.2), RecoveryState::drive);
  look(1.0);
  EXPECT_EQ(recovery.reason(), Reason::none) << "waiting is not being stuck";
}

TEST_F(RecoveryTest, WhatStoppedMovingIsAnObstacle) {
  in.blocked = true;
  in.cause = Cause::peer;
  look(10);
  in.cause = Cause::fixed;
  EXPECT_EQ(look(0.2), RecoveryState::wait) << "not by one look";
  look(1.2);
  EXPECT_NE(recovery.state(), RecoveryState::wait);
}

TEST_F(RecoveryTest, WithoutARouteItSaysSoWithinThreeSeconds) {
  in.route = 0;
  EXPECT_EQ(look(2), RecoveryState::drive);
  look(1.2);
  EXPECT_EQ(recovery.state(), RecoveryState::give_up);
  EXPECT_EQ(recovery.reason(), Reason::blocked);
  in.route = 2;
  EXPECT_EQ(look(0.2), RecoveryState::drive);
}

TEST_F(RecoveryTest, AProofIsReportedAtOnceAndTakenBack) {
  in.route = 0;
  in.unreachable = true;
  look(0.1);
  EXPECT_TRUE(recovery.gave_up());
  EXPECT_EQ(recovery.reason(), Reason::goal_unreachable);
  in.route = 1;
  in.unreachable = false;
  look(0.1);
  EXPECT_FALSE(recovery.gave_up());
}

TEST_F(RecoveryTest, ADoorThatOpensIsSeenBeforeTheMapForgetsItsBlock) {
  in.blocked = true;
  in.cause = Cause::fixed;
  answer = 0;
  ASSERT_EQ(look(15), RecoveryState::give_up);
  in.blocked = false;
  in.ends_at_goal = true;
  look(0.5);
  EXPECT_FALSE(opens);
  look(0.7);
  EXPECT_TRUE(opens);
  in.route = 2;
  EXPECT_EQ(look(0.2), RecoveryState::drive);
}

TEST_F(RecoveryTest, ToAndFroWithoutProgressIsStuckHoweverOftenTheGoalMovesWithTheMap) {
  for (int n = 0; n < 600 && recovery.reason() != Reason::stuck; ++n) {
    in.left = 5.0 + 0.06 * (n % 5);
    look(0.1);
  }
  EXPECT_EQ(recovery.reason(), Reason::stuck);
  EXPECT_LT(now, 50);
}

TEST_F(RecoveryTest, StandingOnPurposeIsNeitherStuckNorAnEnd) {
  in.left = 0.2;
  in.stands = true;
  EXPECT_EQ(look(120), RecoveryState::drive);
}

TEST_F(RecoveryTest, AStartThatIsBlockedIsLeftOrNamed) {
  in.route = 0;
  in.start_blocked = true;
  in.side = Side::left;
  EXPECT_EQ(look(1.2), RecoveryState::nudge);
  EXPECT_EQ(recovery.target({}).kind, Target::Kind::leave);
  in.blocked = true;
  look(4);
  EXPECT_TRUE(recovery.gave_up());
  EXPECT_EQ(recovery.reason(), Reason::start_in_collision);
}

TEST_F(RecoveryTest, NearItsGoalARobotThatComesNoNearerEnds) {
  in.left = 0.6;
  look(12);
  EXPECT_TRUE(recovery.gave_up());
  EXPECT_NE(recovery.reason(), Reason::stuck);
}

std::vector<ObstaclePoint> wall_behind(double x) {
  std::vector<ObstaclePoint> points;
  for (double y = -1; y <= 1; y += 0.05)
    points.push_back({static_cast<float>(x), static_cast<float>(y), 1.0f});
  return points;
}

TEST(WayBack, LeadsBackRoundTheBendThatTheRobotDrove) {
  WayBack way(wheeled());
  Pose2 pose{};
  for (int i = 0; i < 40; ++i) {
    pose = pose * Pose2{0.05, 0, 0.02};
    way.note(pose);
  }
  const auto plan = way.plan(pose, {});
  ASSERT_TRUE(plan);
  EXPECT_TRUE(plan->reverse);
  EXPECT_NEAR(plan->length, 1.9, 0.15);
  EXPECT_LT(plan->path().back().position().norm(), 0.25);
  EXPECT_NEAR(plan->path().back().yaw, 0.0, 0.1);
}

TEST(WayBack, EndsBeforeWhatStandsThereNow) {
  WayBack way(wheeled());
  for (int i = 0; i <= 30; ++i) way.note({0.1 * i, 0, 0});
  const auto plan = way.plan({3, 0, 0}, wall_behind(-1.5));
  ASSERT_TRUE(plan);
  EXPECT_LT(plan->length, 1.5 - wheeled().length / 2);
  EXPECT_GT(plan->length, 0.8);
  EXPECT_FALSE(way.plan({3, 0, 0}, wall_behind(-wheeled().length / 2 - 0.08)));
}

TEST(WayBack, IsUsedUpAndThenStraight) {
  WayBack way(wheeled());
  for (int i = 0; i <= 5; ++i) way.note({0.1 * i, 0, 0});
  const auto plan = way.plan({0, 0, 0}, {});
  ASSERT_TRUE(plan);
  EXPECT_NEAR(plan->path().back().x, -WayBack::kStraight, 1e-6);
}

}  // namespace
}  // namespace adit::nav::test
