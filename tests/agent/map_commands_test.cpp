// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/command/map_commands.hpp"

#include <gtest/gtest.h>

#include "tests/agent/command_bench.hpp"

namespace adit::agent {
namespace {

/// A robot that op1 holds; the test answers for the router.
class MapCommandsTest : public testing::Test {
 protected:
  MapCommandsTest() { EXPECT_TRUE(bench.say("op1", "take").accepted()); }
  void handle(const Command& command) {
    commands.handle(command, [this](const std::optional<Answer>& answer) { answers.push_back(answer); });
  }

  CommandBench bench{};
  std::vector<std::function<void(const Result<GoalReport>&)>> judgements{};
  std::vector<std::function<void(const Result<PlannedRoute>&)>> routes{};
  std::vector<std::optional<Answer>> answers{};
  MapCommands commands{
      bench.interface(),
      {[this](const auto&, bool, auto done) { judgements.push_back(std::move(done)); },
       [this](const auto&, auto done) { routes.push_back(std::move(done)); }, [this] { return bench.now; }}};
};

TEST_F(MapCommandsTest, EachRepeatOfAGoalThatIsBeingJudgedIsAnswered) {
  const Command go = bench.command("op1", "goto 5 0");
  handle(go);
  handle(go);
  EXPECT_TRUE(answers.empty());
  ASSERT_EQ(judgements.size(), 1U) << "it is judged once";
  judgements[0](GoalReport{});
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_TRUE(answers[0]->accepted());
  EXPECT_EQ(answers[1]->seq, answers[0]->seq);
}

TEST_F(MapCommandsTest, AGoalThatNoMapJudgesIsHandledAllTheSame) {
  handle(bench.command("op1", "goto 5 0"));
  ASSERT_EQ(judgements.size(), 1U);
  judgements[0](Error{Reason::no_answer, "busy"});
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers[0]->accepted());
}

TEST_F(MapCommandsTest, APlanIsAnsweredWithItsRouteOrTheReasonWhyThereIsNone) {
  handle(bench.command("op1", "plan 5 0"));
  ASSERT_EQ(routes.size(), 1U);
  routes[0](PlannedRoute{.length = 7});
  ASSERT_EQ(answers.size(), 1U);
  ASSERT_TRUE(answers[0]->route);
  EXPECT_EQ(answers[0]->route->length, 7);
  handle(bench.command("op1", "plan 6 0"));
  routes[1](Error{Reason::no_answer, "busy"});
  EXPECT_EQ(answers[1]->reason, Reason::no_answer);
}

TEST_F(MapCommandsTest, OtherCommandsPassAtOnce) {
  handle(bench.command("op1", "goto 5 0"));
  handle(bench.command("op1", "stop"));
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers[0]->accepted());
}

}  // namespace
}  // namespace adit::agent
