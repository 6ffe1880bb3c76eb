// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/discovery/namesakes.hpp"

#include <gtest/gtest.h>

namespace adit::agent {
namespace {

using Verdict = Namesakes::Verdict;
constexpr wire::ParticipantId kOwn{1}, kOther{2}, kThird{3};

/// A robot with start id 50, and what it hears of others with its name.
struct Robot {
  Namesakes names{kOwn};
  Time now{100s};
  void pass(Duration time) { now += time; }
  /// Signs of life once a second.
  Verdict hear(const wire::ParticipantId& from, int signs, std::optional<Namesakes::Claim> claim = {}) {
    for (int i = 0; i < signs; ++i) {
      names.described(from, claim, now);
      names.tick(now);
      pass(1s);
    }
    return names.verdict();
  }
  void held(bool is) { names.claim({is, 50}, now); }
};

TEST(Namesakes, ARobotThatAStationHeardFirstStaysWhateverOthersClaim) {
  Robot robot;
  robot.held(false);
  robot.names.station(robot.now);
  robot.pass(Namesakes::kSettled);
  EXPECT_EQ(robot.hear(kOther, 1), Verdict::alone);  // may be a late sample of its own former agent
  EXPECT_EQ(robot.hear(kOther, 5), Verdict::stays);
  EXPECT_EQ(robot.hear(kThird, 5, Namesakes::Claim{true, 1}), Verdict::stays);
  EXPECT_TRUE(robot.names.obeys(0));
  EXPECT_TRUE(robot.names.obeys(50));
  EXPECT_FALSE(robot.names.obeys(7));  // a station that means another one
}

TEST(Namesakes, AHeldRobotStaysAfterARestartOfItsAgent) {
  Robot robot;
  robot.names.held_before();
  robot.held(true);
  EXPECT_EQ(robot.hear(kOther, 5), Verdict::stays);
}

TEST(Namesakes, ANewerRobotObeysNobodyFromTheFirstSignOn) {
  Robot robot;
  robot.held(false);
  robot.names.station(robot.now);
  EXPECT_EQ(robot.hear(kOther, 1), Verdict::undecided);
  EXPECT_FALSE(robot.names.obeys(50));
  EXPECT_EQ(robot.hear(kOther, 4), Verdict::gives_way);
  EXPECT_FALSE(robot.names.obeys(50));
  EXPECT_EQ(robot.names.announced(), (Namesakes::Claim{false, 50}));
}

TEST(Namesakes, ItGivesWayWhileTheOtherIsOutOfRangeAndNotWhenItLeft) {
  Robot robot;
  robot.hear(kOther, 5);
  robot.pass(50s);
  robot.names.tick(robot.now);
  EXPECT_EQ(robot.names.verdict(), Verdict::gives_way);
  robot.pass(10s);
  robot.names.tick(robot.now);
  EXPECT_EQ(robot.names.verdict(), Verdict::alone);
  robot.names = Namesakes(kOwn);
  robot.hear(kOther, 5);
  robot.names.left(kOther);
  robot.names.tick(robot.now);
  EXPECT_EQ(robot.names.verdict(), Verdict::alone);
}

TEST(Namesakes, OfSeveralThatGiveWayTheHeldOneStaysThenTheLowerStart) {
  const auto verdict = [](bool held, const Namesakes::Claim& claim, const Namesakes::Claim& last) {
    Robot robot;
    robot.held(held);
    for (int i = 0; i < 4; ++i, robot.pass(1s)) {
      robot.names.described(kOther, claim, robot.now);
      robot.names.described(kThird, last, robot.now);
      robot.names.tick(robot.now);
    }
    return robot.names.verdict();
  };
  const Namesakes::Claim later{false, 60}, earlier{false, 40}, held{true, 70};
  EXPECT_EQ(verdict(false, later, later), Verdict::stays);
  EXPECT_EQ(verdict(false, later, earlier), Verdict::gives_way);
  EXPECT_EQ(verdict(false, held, later), Verdict::gives_way);
  EXPECT_EQ(verdict(true, held, earlier), Verdict::stays);
}

TEST(Namesakes, OnlyWhenAllOthersGiveWay) {
  Robot robot;
  robot.held(false);
  EXPECT_EQ(robot.hear(kOther, 4), Verdict::gives_way);
  EXPECT_EQ(robot.hear(kThird, 4, Namesakes::Claim{false, 60}), Verdict::gives_way);
  EXPECT_EQ(robot.hear(kOther, 4, Namesakes::Claim{false, 60}), Verdict::stays);
}

TEST(Namesakes, AreBounded) {
  Robot robot;
  robot.held(false);
  for (std::uint8_t i = 2; i < 100; ++i) robot.names.heard({i}, robot.now);
  EXPECT_EQ(robot.hear({99}, 3), Verdict::undecided);  // one of those that there is no room for
}

}  // namespace
}  // namespace adit::agent
