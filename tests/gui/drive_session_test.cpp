// SPDX-License-Identifier: Apache-2.0
// Driving one robot by hand, on virtual time.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "basestation/input/drive_session.hpp"
#include "basestation/input/shaping.hpp"

namespace adit::station::input {
namespace {

using testing::HasSubstr;

class DriveSessionTest : public testing::Test {
 protected:
  DriveSessionTest() {
    robot_.name = "r1";
    robot_.mine = true;
    robot_.mode = "smart_joystick";
    robot_.max_speed = 2.0F;
    robot_.max_turn = 1.0F;
    robot_.age = 0.05;
  }
  DriveSession::Step step(double dt = 0.01) {
    now_ += dt;
    return session_.step(hands_, {known_ ? &robot_ : nullptr, silent_, since_beat_}, now_);
  }
  void touch(double forward, double turn = 0.0) {
    hands_.touching = true;
    hands_.touched = {forward, 0.0, turn};
  }
  void hold_pad(double forward) {
    hands_.pad.present = true;
    hands_.pad.shoulder = true;
    hands_.pad.stick = {forward, 0.0, 0.0};
  }

  Robot robot_{};
  Hands hands_{};
  bool known_{true};
  double silent_{0.0}, since_beat_{0.0}, now_{100.0};
  DriveSession session_{"r1", 100.0};
};

TEST_F(DriveSessionTest, TheFingerGivesAShareOfTheRobotsLimits) {
  touch(0.5, -0.25);
  const auto next = step();
  EXPECT_DOUBLE_EQ(next.velocity.vx, 1.0);
  EXPECT_DOUBLE_EQ(next.velocity.wz, -0.25);
  EXPECT_EQ(next.why, "");
  hands_.touching = false;
  EXPECT_EQ(step().velocity.vx, 0.0) << "a lifted finger is zero, whatever the stick was";
}

TEST_F(DriveSessionTest, TheShoulderButtonOfThePadIsTheDeadMansSwitch) {
  hold_pad(1.0);
  EXPECT_DOUBLE_EQ(step().velocity.vx, 1.0) << "half of the limit";
  hands_.pad.fast = true;
  EXPECT_DOUBLE_EQ(step().velocity.vx, 2.0);
  hands_.pad.precise = true;
  EXPECT_DOUBLE_EQ(step().velocity.vx, 0.5);
  hands_.pad.shoulder = false;
  const auto next = step();
  EXPECT_EQ(next.velocity.vx, 0.0);
  EXPECT_TRUE(next.send) << "zero does not wait for the period";
  EXPECT_THAT(next.why, HasSubstr("shoulder"));
}

TEST_F(DriveSessionTest, APadThatIsPulledOutEndsIt) {
  hold_pad(1.0);
  step();
  hands_.pad = {};
  const auto next = step();
  EXPECT_TRUE(next.ends);
  EXPECT_THAT(next.why, HasSubstr("controller"));
}

TEST_F(DriveSessionTest, SamplesComeEachPeriodAndAtOnceForZeroAndForJumps) {
  touch(0.5);
  EXPECT_TRUE(step().send) << "the first";
  int sent = 0;
  for (int i = 0; i < 100; ++i) sent += step().send;
  EXPECT_EQ(sent, 20) << "in a second";
  while (!step().send) {
  }
  touch(0.55);
  EXPECT_FALSE(step().send) << "a small change waits";
  touch(0.9);
  EXPECT_TRUE(step().send) << "a large one does not";
  touch(0.0);
  EXPECT_TRUE(step().send);
}

TEST_F(DriveSessionTest, AFrozenWindowAnOldStateAndAStopAreZero) {
  touch(1.0);
  EXPECT_GT(step().velocity.vx, 0.0);
  since_beat_ = 0.3;
  EXPECT_EQ(step().velocity.vx, 0.0);
  EXPECT_THAT(step().why, HasSubstr("window"));
  since_beat_ = 0.0;
  EXPECT_EQ(step().velocity.vx, 0.0) << "a stick that was held all the time moves nothing";
  EXPECT_THAT(step().why, HasSubstr("let go once"));
  hands_.touching = false;
  step();
  touch(1.0);
  EXPECT_GT(step().velocity.vx, 0.0);
  robot_.age = 0.3;
  silent_ = 0.4;
  EXPECT_EQ(step().velocity.vx, 0.0);
  robot_.age = silent_ = 0.0;
  robot_.stops = {"op2"};
  const auto next = step();
  EXPECT_EQ(next.velocity.vx, 0.0);
  EXPECT_FALSE(next.ends) << "a stop can be reset";
}

TEST_F(DriveSessionTest, WhatTakesTheRobotAwayEndsIt) {
  const auto ends = [this] {
    DriveSession fresh("r1", now_);
    Robot robot = robot_;
    (void)fresh.step(hands_, {&robot, 0.0, 0.0}, now_);
    return [this, fresh](const Robot* other) mutable {
      return fresh.step(hands_, {other, 0.0, 0.0}, now_ + 2.0).ends;
    };
  };
  EXPECT_FALSE(ends()(&robot_));
  EXPECT_TRUE(ends()(nullptr));
  Robot other = robot_;
  other.lost = true;
  EXPECT_TRUE(ends()(&other));
  other = robot_;
  other.mine = false;
  other.holder = "op2";
  EXPECT_TRUE(ends()(&other));
  other = robot_;
  other.mode = "waypoint";
  EXPECT_TRUE(ends()(&other)) << "another front end gave it a goal";
}

TEST_F(DriveSessionTest, ARobotThatDoesNotEnterTheModeEndsItAfterAWhile) {
  robot_.mode = "hold";
  EXPECT_FALSE(step(1.5).ends);
  EXPECT_TRUE(step(4.0).ends);
}

TEST_F(DriveSessionTest, OddAxesMoveNothing) {
  touch(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity());
  const auto next = step();
  EXPECT_EQ(next.velocity.vx, 0.0);
  EXPECT_EQ(next.velocity.wz, 0.0);
  touch(50.0);
  EXPECT_DOUBLE_EQ(step().velocity.vx, 2.0);
}

TEST(Shaping, HasADeadZoneIsFinerNearTheCentreAndReachesTheEnd) {
  EXPECT_EQ(shaped(0.11), 0.0);
  EXPECT_EQ(shaped(-0.11), 0.0);
  EXPECT_LT(shaped(0.3), 0.2);
  EXPECT_DOUBLE_EQ(shaped(1.0), 1.0);
  EXPECT_DOUBLE_EQ(shaped(-1.0), -1.0);
  EXPECT_EQ(shaped(std::numeric_limits<double>::quiet_NaN()), 0.0);
  for (double v = 0.0; v < 1.0; v += 0.01) EXPECT_LE(shaped(v), shaped(v + 0.01));
}

}  // namespace
}  // namespace adit::station::input
