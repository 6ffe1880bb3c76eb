// SPDX-License-Identifier: Apache-2.0
// `down` and `release`: what robots do without their holder, and that the operator reads it before.
#include "basestation/model/leaving.hpp"
#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

class DownTest : public StationTest {
 protected:
  DownTest() {
    add("r1");
    add("r2");
    for (const auto& robot : robots_) robot->behaviour.mode("hold");
    start();
    op_->on_down = [this] { down_ = true; };
    run_for(6s);
    EXPECT_EQ(execute("take r1 r2").exit_code, 0);
  }

  bool down_{false};
  Timer later_{};
};

TEST_F(DownTest, RefusesWhileARobotWouldDriveOnAndSaysWhatEachDoes) {
  ASSERT_EQ(execute("goto r1 4 5").exit_code, 0);
  const Outcome refused = execute("down");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.error, HasSubstr("[would_go_on]"));
  EXPECT_THAT(refused.error, HasSubstr("down --leave"));
  EXPECT_THAT(refused.error, HasSubstr("r1: drives on to its goal 4.0 5.0, without a holder\n"));
  EXPECT_THAT(refused.error, HasSubstr("r2: stays in hold\n"));
  EXPECT_EQ(refused.json["reason"], "would_go_on");
  EXPECT_EQ(refused.json["robots"][0]["robot"], "r1");
  EXPECT_EQ(refused.json["robots"][0]["rests"], false);
  EXPECT_EQ(refused.json["robots"][0]["then"], "drives on to its goal 4.0 5.0, without a holder");
  EXPECT_EQ(refused.json["robots"][1]["rests"], true);
  EXPECT_FALSE(down_);
  for (const auto& robot : robots_) EXPECT_EQ(robot->holder, "op1") << "nothing was done";
}

TEST_F(DownTest, LeavesThemWhenToldSoAndSaysWhatEachDoes) {
  ASSERT_EQ(execute("goto r1 4 5").exit_code, 0);
  const Outcome left = execute("down --leave");
  EXPECT_EQ(left.exit_code, 0);
  EXPECT_TRUE(down_);
  EXPECT_THAT(left.text, HasSubstr("r1: released; drives on to its goal 4.0 5.0, without a holder\n"));
  EXPECT_THAT(left.text, HasSubstr("r2: released; stays in hold\n"));
  EXPECT_THAT(left.text, HasSubstr("station op1 is down\n"));
  EXPECT_EQ(left.json["robots"][0]["rests"], false);
  for (const auto& robot : robots_) EXPECT_EQ(robot->holder, "");
}

TEST_F(DownTest, EndsAtOnceWhenAllRest) {
  ASSERT_EQ(execute("goto r1 4 5").exit_code, 0);
  robots_[0]->behaviour.goal_state(radio::GOAL_REACHED);
  robots_[0]->publish();
  ASSERT_EQ(execute("stop r2").exit_code, 0);
  EXPECT_EQ(execute("down").exit_code, 0);
  EXPECT_TRUE(down_);
}

TEST_F(DownTest, WaitsForTheStateAfterACommandThatWasJustAccepted) {
  // The robot's new state comes later than its answer.
  robots_[0]->answering = [this](const radio::Command& command) -> std::optional<Reason> {
    if (command.kind() != radio::CMD_GOTO) return Reason::none;
    later_ = strand_->after(600ms, [this] {
      robots_[0]->behaviour.mode("waypoint");
      robots_[0]->behaviour.goal_state(radio::GOAL_ACTIVE);
      robots_[0]->publish();
    });
    return Reason::none;
  };
  robots_[0]->acting = [](const radio::Command& command) { return command.kind() != radio::CMD_GOTO; };
  ASSERT_EQ(execute("goto r1 4 5").exit_code, 0);
  EXPECT_EQ(execute("down").exit_code, 1);
  EXPECT_FALSE(down_);
}

TEST_F(DownTest, AStationThatWasJustStartedHearsItsRobotsFirst) {
  ASSERT_EQ(execute("goto r1 4 5").exit_code, 0);
  start();
  EXPECT_EQ(execute("down").exit_code, 1);
}

TEST_F(DownTest, ARobotThatIsNotHeardMayDrive) {
  ASSERT_EQ(execute("goto r1 4 5").exit_code, 0);
  robots_[0]->alive = false;
  run_for(5s);
  EXPECT_THAT(execute("down").error,
              HasSubstr("r1: is not heard; it was in waypoint, and keeps you as its holder\n"));
  const Outcome left = execute("down --leave");
  EXPECT_EQ(left.exit_code, 0);
  EXPECT_THAT(left.error, HasSubstr("r1: is not heard; it was in waypoint, and keeps you as its holder"));
  EXPECT_TRUE(down_);
}

TEST_F(DownTest, ReleaseSaysWhatTheRobotDoes) {
  ASSERT_EQ(execute("goto r1 4 5").exit_code, 0);
  run_for(1s);
  EXPECT_EQ(execute("release r1 r2").text,
            "r1: released; drives on to its goal 4.0 5.0, without a holder\nr2: released; stays in hold\n");
}

Robot in_mode(const std::string& mode) {
  Robot robot{};
  robot.name = "r1";
  robot.mode = mode;
  return robot;
}

TEST(Leaving, KnowsEachMode) {
  EXPECT_TRUE(after_release(in_mode("hold")).rests);
  for (const char* mode : {"manual", "smart_joystick", "convoy_follow", "get_out"}) {
    EXPECT_FALSE(after_release(in_mode(mode)).rests) << mode << ": it may drive now";
    EXPECT_THAT(after_release(in_mode(mode)).text, HasSubstr("holds")) << mode;
  }
  for (const char* mode : {"waypoint", "explore", "external", "orbit", ""}) {
    EXPECT_FALSE(after_release(in_mode(mode)).rests) << mode;
    EXPECT_THAT(after_release(in_mode(mode)).text, Not(HasSubstr("holds; "))) << mode;
  }
  Robot robot = in_mode("explore");
  robot.exploration.phase = ExplorationPhase::done;
  EXPECT_TRUE(after_release(robot).rests);
  robot.exploration.phase = ExplorationPhase::reporting;
  EXPECT_FALSE(after_release(robot).rests) << "it drives home";
  robot.stopped = true;
  EXPECT_TRUE(after_release(robot).rests);
  robot = in_mode("waypoint");
  robot.goal_state = GoalState::blocked;
  robot.reason = Reason::blocked;
  EXPECT_THAT(after_release(robot).text, HasSubstr("as soon as it can (every path is blocked)"));
}

}  // namespace
}  // namespace adit::station
