// SPDX-License-Identifier: Apache-2.0
// stairs go: over a staircase that this robot, or another one, found.
#include "core/findings/finding_piece.hpp"
#include "core/findings/stairs_data.hpp"
#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr float kStep = 0.22F;

/// r1 and r2 climb, r3 does not. r2 found finding 1: six steps along y, from (4, 5, 0) up to 1.2 m.
class StairsGoTest : public StationTest {
 protected:
  StairsGoTest() {
    for (const char* name : {"r1", "r2", "r3"}) add(name);
    start();
    run_for(6s);
    robots_[0]->describe(1.0F, 1.0F, true, kStep);
    robots_[1]->describe(1.0F, 1.0F, true, kStep);
    robots_[2]->describe(1.0F, 1.0F, true);
    const Staircase stairs{
        .foot = {4, 5, 0.1},
        .heading = M_PI / 2,
        .rise = 0.2,
        .run = 0.3,
        .width = 1.2,
        .steps = 6,
        .sigma = {.place = 0.02, .heading = 0.01, .rise = 0.004, .run = 0.005, .width = 0.05}};
    radio::BulkPiece piece;
    piece.robot("r2");
    piece.session(3);
    piece.id(1);
    piece.kind(static_cast<std::uint8_t>(transfer::Kind::findings));
    piece.data(findings::encode({"r2",
                                 1,
                                 0,
                                 {{.key = {"r2", 1},
                                   .kind = findings::kStairs,
                                   .position = {4, 5, 0.1},
                                   .data = findings::encode_stairs(stairs)}}}));
    robots_[1]->send(piece);
    run_for(1s);
    execute("take r1 r2 r3");
  }
  /// Places to which a robot was sent, in turn; m.
  std::vector<std::vector<double>> goals(int robot) {
    std::vector<std::vector<double>> out;
    for (const FakeRobot::Heard& heard : robots_[robot]->commands())
      if (heard.command.kind() == radio::CMD_GOTO)
        out.emplace_back(heard.command.numbers().begin(), heard.command.numbers().begin() + 3);
    return out;
  }
  void arrive(int robot, radio::GoalState state = radio::GOAL_REACHED) {
    robots_[robot]->behaviour.goal_state(state);
    robots_[robot]->publish();
    run_for(500ms);
  }
};

TEST_F(StairsGoTest, OneThatSawItGetsThePlaceBehindTheFarEnd) {
  const Outcome up = execute("stairs go r2 1 up");
  EXPECT_EQ(up.text, "r2: going up the stairs\n");
  ASSERT_EQ(goals(1).size(), 1U);
  EXPECT_NEAR(goals(1)[0][0], 4.0, 0.001);
  EXPECT_NEAR(goals(1)[0][1], 5.0 + 5 * 0.3 + 0.8, 0.001);
  EXPECT_NEAR(goals(1)[0][2], 1.2, 0.001);
  EXPECT_EQ(execute("stairs go r2 1 down").exit_code, 0);
  ASSERT_EQ(goals(1).size(), 2U);
  EXPECT_NEAR(goals(1)[1][1], 4.2, 0.001);
  EXPECT_NEAR(goals(1)[1][2], 0.0, 0.001);
}

TEST_F(StairsGoTest, OneThatDidNotSeeItGoesToTheNearEndFirst) {
  EXPECT_EQ(execute("stairs go r1 1 down").exit_code, 0);
  run_for(5s);
  ASSERT_EQ(goals(0).size(), 1U);
  EXPECT_NEAR(goals(0)[0][2], 1.2, 0.001);
  arrive(0);
  ASSERT_EQ(goals(0).size(), 2U);
  EXPECT_NEAR(goals(0)[1][1], 4.2, 0.001);
  EXPECT_NEAR(goals(0)[1][2], 0.0, 0.001);
}

TEST_F(StairsGoTest, AnotherGoalOrAStopOnTheWayToTheNearEndEndsIt) {
  EXPECT_EQ(execute("stairs go r1 1 up").exit_code, 0);
  run_for(1s);
  EXPECT_EQ(execute("goto r1 9 9 0").exit_code, 0);
  arrive(0);
  EXPECT_EQ(goals(0).size(), 2U) << "the near end, and the place of the operator";
  EXPECT_EQ(execute("stairs go r1 1 up").exit_code, 0);
  run_for(1s);
  execute("stop r1");
  arrive(0);
  EXPECT_EQ(goals(0).size(), 3U);
}

TEST_F(StairsGoTest, AnOldStateThatSaysArrivedIsFollowedByNoGoalAfterAnotherCommand) {
  EXPECT_EQ(execute("stairs go r1 1 up").exit_code, 0);
  run_for(1s);
  robots_[0]->answering = [](const radio::Command&) { return std::nullopt; };
  begin("mode r1 hold");
  // The robot has not heard of it when it says that it arrived.
  arrive(0);
  run_for(5s);
  EXPECT_EQ(goals(0).size(), 1U);
}

TEST_F(StairsGoTest, ARobotThatIsNotHeardAnyMoreIsNotSentOn) {
  EXPECT_EQ(execute("stairs go r1 1 up").exit_code, 0);
  run_for(1s);
  robots_[0]->alive = false;
  run_for(10s);
  // A state that was late on its way, and nothing else.
  robots_[0]->alive = true;
  robots_[0]->behaviour.goal_state(radio::GOAL_REACHED);
  robots_[0]->publish();
  robots_[0]->alive = false;
  run_for(5s);
  EXPECT_EQ(goals(0).size(), 1U);
  const auto answer = op_->last_answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->command, "stairs go");
  EXPECT_EQ(answer->reason, Reason::no_answer);
  EXPECT_THAT(answer->text, HasSubstr("not heard any more"));
}

TEST_F(StairsGoTest, TheLogSaysWhyTheNearEndWasNotReached) {
  EXPECT_EQ(execute("stairs go r1 1 up").exit_code, 0);
  robots_[0]->behaviour.reason(static_cast<std::uint16_t>(Reason::goal_unreachable));
  arrive(0, radio::GOAL_BLOCKED);
  EXPECT_EQ(goals(0).size(), 1U);
  const auto answer = op_->last_answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->command, "stairs go");
  EXPECT_EQ(answer->reason, Reason::goal_unreachable);
}

TEST_F(StairsGoTest, RefusesWhatDoesNotClimbAndWhatIsNoStaircase) {
  const Outcome wheels = execute("stairs go r3 1 up");
  EXPECT_EQ(wheels.exit_code, 1);
  EXPECT_THAT(wheels.error, HasSubstr("r3 climbs no stairs"));
  EXPECT_EQ(wheels.json["reason"], "goal_over_stairs");
  EXPECT_THAT(execute("stairs go r2 7 up").error, HasSubstr("no staircase of that ID"));
  EXPECT_THAT(execute("stairs go r9 1 up").error, HasSubstr("r9"));
  EXPECT_EQ(execute("stairs go r2 1 sideways").exit_code, kExitUsage);
  EXPECT_EQ(execute("finding 1 reject").exit_code, 0);
  EXPECT_THAT(execute("stairs go r2 1 up").error, HasSubstr("rejected"));
  EXPECT_TRUE(goals(1).empty() && goals(2).empty());
}

}  // namespace
}  // namespace adit::station
