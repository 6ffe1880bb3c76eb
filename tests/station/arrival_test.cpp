// SPDX-License-Identifier: Apache-2.0
// goto --wait: when it ends, and how.
#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class ArrivalTest : public StationTest {
 protected:
  ArrivalTest() {
    add("r1");
    start();
    run_for(6s);
    execute("take r1");
  }
  FakeRobot& r1() { return *robots_[0]; }
  /// The robot's goal as it will be `when` from now.
  void goal_later(Duration when, radio::GoalState phase) {
    scheduler_.at(scheduler_.elapsed() + when, [this, phase] {
      r1().behaviour.goal_state(phase);
      r1().publish();
    });
  }
};

TEST_F(ArrivalTest, WithoutWaitItReturnsWhenAccepted) {
  const Duration before = scheduler_.elapsed();
  const Outcome outcome = execute("goto r1 12 0.5");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.text, "r1: driving to 12.00 0.50\n");
  EXPECT_LT(scheduler_.elapsed() - before, 100ms);
}

TEST_F(ArrivalTest, ReturnsOnArrival) {
  goal_later(20s, radio::GOAL_REACHED);
  const Duration before = scheduler_.elapsed();
  const Outcome outcome = execute("goto r1 12 0.5 --wait");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.text, "r1: arrived at 12.00 0.50\n");
  EXPECT_NEAR(seconds(scheduler_.elapsed() - before), 20.0, 0.2);
}

TEST_F(ArrivalTest, AGoalReachedBeforeDoesNotCount) {
  execute("goto r1 1 1");
  r1().behaviour.goal_state(radio::GOAL_REACHED);
  r1().publish();
  run_for(100ms);
  goal_later(5s, radio::GOAL_REACHED);
  const Duration before = scheduler_.elapsed();
  EXPECT_EQ(execute("goto r1 2 2 --wait").exit_code, 0);
  EXPECT_GT(scheduler_.elapsed() - before, 4s);
}

TEST_F(ArrivalTest, RefusedAtOnce) {
  r1().answering = [](const radio::Command&) { return Reason::goal_unreachable; };
  const Outcome outcome = execute("goto r1 12 0.5 --wait");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.json["results"][0]["reason"], "goal_unreachable");
}

TEST_F(ArrivalTest, BlockedForFiveSecondsIsAnEndAMomentIsNot) {
  goal_later(2s, radio::GOAL_BLOCKED);
  goal_later(5s, radio::GOAL_ACTIVE);
  goal_later(10s, radio::GOAL_BLOCKED);
  const Duration before = scheduler_.elapsed();
  const Outcome outcome = execute("goto r1 12 0.5 --wait");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.error, HasSubstr("[blocked]"));
  EXPECT_NEAR(seconds(scheduler_.elapsed() - before), 15.0, 0.3);
}

TEST_F(ArrivalTest, NoWayThereEndsItAtOnce) {
  r1().behaviour.reason(static_cast<std::uint16_t>(Reason::goal_unreachable));
  goal_later(2s, radio::GOAL_BLOCKED);
  const Duration before = scheduler_.elapsed();
  const Outcome outcome = execute("goto r1 12 0.5 --wait");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.error, HasSubstr("no way leads to the goal"));
  EXPECT_THAT(outcome.error, HasSubstr("[goal_unreachable]"));
  EXPECT_LT(seconds(scheduler_.elapsed() - before), 2.5);
}

TEST_F(ArrivalTest, StoppedEndsIt) {
  begin("goto r1 12 0.5 --wait");
  run_for(2s);
  execute("stop r1");
  run_for(500ms);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_EQ(late_[0].exit_code, 1);
  EXPECT_THAT(late_[0].error, HasSubstr("[stopped]"));
}

TEST_F(ArrivalTest, LeavingTheModeEndsIt) {
  begin("goto r1 12 0.5 --wait");
  run_for(2s);
  execute("mode r1 hold");
  run_for(500ms);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_THAT(late_[0].error, HasSubstr("left waypoint for hold"));
}

TEST_F(ArrivalTest, AnotherGoalEndsIt) {
  begin("goto r1 12 0.5 --wait");
  run_for(2s);
  execute("goto r1 3 3");
  run_for(500ms);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_THAT(late_[0].error, HasSubstr("another goal"));
}

TEST_F(ArrivalTest, ALostRobotIsWaitedForHalfAMinute) {
  begin("goto r1 12 0.5 --wait");
  run_for(2s);
  r1().alive = false;
  run_for(20s);
  EXPECT_TRUE(late_.empty());
  run_for(12s);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_EQ(late_[0].exit_code, 3);
}

}  // namespace
}  // namespace adit::station
