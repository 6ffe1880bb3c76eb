// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/agent/agent_bench.hpp"
#include "tests/agent/only_zero.hpp"

namespace adit::agent {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

class AgentTest : public testing::Test {
 protected:
  AgentTest() { bench.run(1500ms); }
  void take() { ASSERT_EQ(bench.ask(op1, radio::CMD_TAKE), Reason::none); }
  void enter_manual() {
    take();
    bench.stream(op1, 0.0, 300ms);
    bench.send(op1, radio::CMD_MODE, "manual");
    bench.stream(op1, 0.0, 300ms);
    ASSERT_EQ(op1.behaviour.mode(), "manual");
  }
  AgentBench bench{};
  AgentBench::Operator& op1 = bench.join("op1");
  AgentBench::Operator& op2 = bench.join("op2");
};

TEST_F(AgentTest, SaysWhoItIsAndThatItHolds) {
  EXPECT_EQ(op1.capabilities.name(), "r1");
  EXPECT_EQ(op1.capabilities.protocol(), 1);
  EXPECT_THAT(op1.capabilities.modes(), Contains("waypoint"));
  EXPECT_EQ(op1.behaviour.mode(), "hold");
  EXPECT_EQ(op1.authority.holder(), "");
  EXPECT_NE(op1.authority.epoch().start(), 0u);
  ASSERT_FALSE(op1.health.components().empty());
  for (const auto& c : op1.health.components()) EXPECT_TRUE(c.healthy()) << c.name();
}

TEST_F(AgentTest, SendsZeroToTheDriverAtTwentyHertz) {
  bench.commands.clear();
  bench.run(1s);
  EXPECT_EQ(bench.commands.size(), 20u);
  EXPECT_THAT(bench.commands, only_zero());
}

TEST_F(AgentTest, TakenByOneThenByTheOther) {
  take();
  EXPECT_EQ(op2.authority.holder(), "op1");
  EXPECT_EQ(bench.ask(op2, radio::CMD_TAKE), Reason::none);
  EXPECT_EQ(op1.authority.holder(), "op2");
  EXPECT_THAT(op1.notice_codes(), ElementsAre("taken"));
}

TEST_F(AgentTest, RepeatsAreAnsweredButDoneOnce) {
  take();
  const auto counter = op1.authority.epoch().counter();
  (void)op1.command.write(bench.last_command);
  (void)op1.command.write(bench.last_command);
  bench.run(300ms);
  EXPECT_EQ(op1.answers.size(), 3u);
  EXPECT_EQ(op1.authority.epoch().counter(), counter);
}

TEST_F(AgentTest, JoystickReachesTheDriverAtOnce) {
  enter_manual();
  const Duration sent = bench.elapsed();
  bench.stick(op1, 0.5);
  bench.run(10ms);
  EXPECT_NEAR(bench.command.vx, 0.5, 1e-6);
  EXPECT_LT(seconds(bench.command_at - sent), 0.005);
}

TEST_F(AgentTest, VelocityIsCutToThePlatform) {
  enter_manual();
  bench.stream(op1, 50.0, 200ms);
  EXPECT_NEAR(bench.command.vx, Platform{}.max_speed, 1e-6);
}

TEST_F(AgentTest, SilentJoystickIsZeroThenHold) {
  enter_manual();
  bench.stream(op1, 0.5, 500ms);
  bench.run(400ms);
  EXPECT_EQ(bench.command, Twist2{});
  EXPECT_EQ(op1.behaviour.mode(), "manual");
  bench.run(700ms);
  EXPECT_EQ(op1.behaviour.mode(), "hold");
  EXPECT_THAT(op1.notice_codes(), Contains("joystick_lost"));
}

TEST_F(AgentTest, StopOfAnotherIsZeroAtOnce) {
  enter_manual();
  bench.stream(op1, 0.5, 500ms);
  bench.send(op2, radio::CMD_STOP);
  bench.run(20ms);
  EXPECT_EQ(bench.command, Twist2{});
  bench.stream(op1, 0.5, 300ms);
  EXPECT_EQ(bench.command, Twist2{});
  EXPECT_TRUE(op1.behaviour.stopped());
  EXPECT_THAT(op1.notice_codes(), Contains("stopped"));
  EXPECT_EQ(bench.ask(op1, radio::CMD_RESET), Reason::stop_of_another);
  EXPECT_EQ(bench.ask(op1, radio::CMD_RESET, {}, 0, 0, true), Reason::none);
  bench.stream(op1, 0.5, 300ms);
  EXPECT_EQ(bench.command, Twist2{});  // in hold: a reset moves nothing
  EXPECT_EQ(op1.behaviour.reason(), static_cast<std::uint16_t>(Reason::none)) << "the stop is gone";
}

TEST_F(AgentTest, DrivesToItsGoal) {
  take();
  ASSERT_EQ(bench.ask(op1, radio::CMD_GOTO, {}, 4.0, 1.0), Reason::none);
  EXPECT_EQ(op1.behaviour.mode(), "waypoint");
  bench.run(15s);
  EXPECT_NEAR(bench.pose.x, 4.0, 0.4);
  EXPECT_NEAR(bench.pose.y, 1.0, 0.4);
  EXPECT_EQ(op1.behaviour.goal_state(), radio::GOAL_REACHED);
  EXPECT_THAT(op1.notice_codes(), Contains("arrived"));
  EXPECT_EQ(bench.command, Twist2{});
  EXPECT_NEAR(op1.state.x(), 4.0, 0.4);
}

TEST_F(AgentTest, GoalsAreInTheMapFrame) {
  AgentParams params{};
  params.start = {10.0, 5.0, M_PI / 2};
  AgentBench turned(params);
  auto& op = turned.join("op1");
  turned.run(1500ms);
  EXPECT_NEAR(op.state.x(), 10.0, 1e-3);
  ASSERT_EQ(turned.ask(op, radio::CMD_TAKE), Reason::none);
  ASSERT_EQ(turned.ask(op, radio::CMD_GOTO, {}, 10.0, 8.0), Reason::none);
  turned.run(12s);
  EXPECT_NEAR(turned.pose.x, 3.0, 0.4);
  EXPECT_NEAR(turned.pose.y, 0.0, 0.4);
  EXPECT_NEAR(op.state.y(), 8.0, 0.4);
}

TEST_F(AgentTest, GoalInAnObstacleIsRefused) {
  for (float x = 2.8f; x < 3.2f; x += 0.05f)
    for (float y = -0.2f; y < 0.2f; y += 0.05f)
      for (const float z : {0.3f, 0.4f}) bench.obstacles.push_back({x, y, z});
  bench.run(1s);
  take();
  EXPECT_EQ(bench.ask(op1, radio::CMD_GOTO, {}, 3.0, 0.0), Reason::goal_unreachable);
  EXPECT_THAT(op1.notice_codes(), Contains("mode_refused"));
}

TEST_F(AgentTest, PoseMovesNothingAndHomeGoesToTheStart) {
  take();
  ASSERT_EQ(bench.ask(op1, radio::CMD_POSE, {}, 3.0, 1.0), Reason::none);
  bench.run(500ms);
  EXPECT_NEAR(op1.state.x(), 3.0, 0.05);
  EXPECT_NEAR(op1.state.y(), 1.0, 0.05);
  EXPECT_EQ(bench.command, Twist2{});
  ASSERT_EQ(bench.ask(op1, radio::CMD_HOME), Reason::none);
  EXPECT_EQ(op1.behaviour.mode(), "waypoint");
  EXPECT_EQ(op1.behaviour.goal()[0], 0.0) << "where it started in the map";
  EXPECT_EQ(bench.ask(op1, radio::CMD_POSE, {}, 0.0, 0.0), Reason::wrong_mode);
}

class RoutedAgentTest : public testing::Test {
 protected:
  static AgentParams params() {
    AgentParams p{};
    p.platform.router = "graph";
    return p;
  }
  RoutedAgentTest() { bench.run(1500ms); }
  AgentBench bench{params()};
  AgentBench::Operator& op1 = bench.join("op1");
};

TEST_F(RoutedAgentTest, AnswersPlanForAnyStationWithoutMoving) {
  const auto way = [&](double x, double y) {
    op1.answers.clear();
    EXPECT_EQ(bench.ask(op1, radio::CMD_PLAN, {}, x, y), Reason::none);
    const bool planned = !op1.answers.empty() && op1.answers.back().route().size() == 1;
    EXPECT_TRUE(planned);
    return planned ? op1.answers.back().route().front() : radio::PlannedRoute();
  };
  EXPECT_NEAR(way(3.0, 0.0).length(), 3.0, 0.1);
  const radio::PlannedRoute far = way(60.0, 0.0);
  EXPECT_GT(far.unknown_length(), 10.0);
  ASSERT_GE(far.points().size(), 6U);
  EXPECT_EQ(far.points().size(), 3U * far.corners());
  EXPECT_NEAR(far.points()[far.points().size() - 3], 60.0, 0.2);
  EXPECT_EQ(bench.ask(op1, radio::CMD_PLAN, {}, std::nan(""), 0.0), Reason::out_of_range);
  bench.run(1s);
  EXPECT_EQ(bench.command, Twist2{});
  EXPECT_EQ(op1.behaviour.mode(), "hold");
}

TEST_F(RoutedAgentTest, SaysWhenItsRouterDoesNotAnswer) {
  ASSERT_TRUE(bench.agent().inject("router", ComponentFault::hang));
  bench.run(50ms);
  bench.send(op1, radio::CMD_PLAN, {}, 3.0, 0.0);
  bench.run(600ms);
  ASSERT_FALSE(op1.answers.empty());
  EXPECT_EQ(op1.answers.back().reason(), static_cast<std::uint16_t>(Reason::no_answer));
  EXPECT_THAT(op1.answers.back().text(), HasSubstr("router"));
}

TEST_F(AgentTest, PlanIsRefusedWithoutARouter) {
  EXPECT_EQ(bench.ask(op1, radio::CMD_PLAN, {}, 3.0, 0.0), Reason::not_supported);
  EXPECT_FALSE(bench.agent().inject("router", ComponentFault::crash));
}

TEST(AgentPlatform, AnUnknownRouterIsAnError) {
  AgentParams params{};
  params.platform.router = "magic";
  try {
    AgentBench bench(params);
    FAIL() << "it started";
  } catch (const std::runtime_error& refused) {
    EXPECT_THAT(refused.what(), testing::AllOf(HasSubstr("magic"), HasSubstr("graph")));
  }
}

TEST_F(AgentTest, StopsWhileTheLidarIsSilentAndContinues) {
  take();
  ASSERT_EQ(bench.ask(op1, radio::CMD_GOTO, {}, 8.0, 0.0), Reason::none);
  bench.run(2s);
  EXPECT_GT(bench.command.vx, 0.1);
  bench.lidar_alive = false;
  bench.run(700ms);
  EXPECT_EQ(bench.command, Twist2{});
  EXPECT_EQ(op1.behaviour.mode(), "waypoint");
  EXPECT_EQ(op1.behaviour.reason(), static_cast<std::uint16_t>(Reason::terrain_stale));
  bench.lidar_alive = true;
  bench.run(1s);
  EXPECT_GT(bench.command.vx, 0.1);
}

TEST_F(AgentTest, ASilentDriverEndsManualAndIsReported) {
  enter_manual();
  bench.driver_alive = false;
  bench.stream(op1, 0.5, 700ms);
  EXPECT_EQ(bench.command, Twist2{});
  EXPECT_EQ(op1.behaviour.mode(), "hold");
  EXPECT_THAT(op1.notice_codes(), Contains("driver_lost"));
  EXPECT_EQ(bench.ask(op1, radio::CMD_GOTO, {}, 1.0, 0.0), Reason::driver_silent);
}

TEST_F(AgentTest, SmartJoystickDrivesAhead) {
  take();
  bench.stream(op1, 0.0, 300ms);
  bench.send(op1, radio::CMD_MODE, "smart_joystick");
  bench.stream(op1, 0.0, 300ms);
  ASSERT_EQ(op1.behaviour.mode(), "smart_joystick");
  bench.stream(op1, 0.6, 4s);
  EXPECT_GT(bench.pose.x, 1.0);
  bench.stream(op1, 0.0, 300ms);
  EXPECT_EQ(bench.command, Twist2{});
}

TEST_F(AgentTest, RestartedOperatorHasHisRobotBack) {
  take();
  ASSERT_EQ(bench.ask(op1, radio::CMD_LOCK), Reason::none);
  bench.restart(op1);
  bench.run(500ms);
  EXPECT_EQ(op1.authority.holder(), "op1");
  EXPECT_TRUE(op1.authority.locked());
  EXPECT_EQ(bench.ask(op1, radio::CMD_MODE, "hold"), Reason::none);
}

TEST_F(AgentTest, RestartedAgentHoldsWithoutHolder) {
  take();
  ASSERT_EQ(bench.ask(op1, radio::CMD_GOTO, {}, 8.0, 0.0), Reason::none);
  const auto start = op1.authority.epoch().start();
  bench.stop_agent();
  bench.command = {};
  bench.run(500ms);
  bench.start_agent();
  bench.run(1500ms);
  EXPECT_EQ(op1.authority.holder(), "");
  EXPECT_NE(op1.authority.epoch().start(), start);
  EXPECT_EQ(op1.behaviour.mode(), "hold");
  EXPECT_EQ(bench.command, Twist2{});
  EXPECT_EQ(bench.ask(op1, radio::CMD_MODE, "hold"), Reason::nobody_holds);
}

TEST_F(AgentTest, ConsoleEndsALock) {
  take();
  ASSERT_EQ(bench.ask(op1, radio::CMD_LOCK), Reason::none);
  std::string answer;
  bench.agent().at_console("unlock", [&](const std::string& a) { answer = a; });
  bench.run(300ms);
  EXPECT_EQ(answer, "unlocked\n");
  EXPECT_FALSE(op1.authority.locked());
  bench.agent().at_console("status", [&](const std::string& a) { answer = a; });
  bench.run(10ms);
  EXPECT_THAT(answer, testing::HasSubstr("held by op1"));
}

TEST_F(AgentTest, ConsoleShowsThePeers) {
  take();
  bench.run(1s);
  std::string answer;
  bench.agent().at_console("peers", [&](const std::string& a) { answer = a; });
  bench.run(10ms);
  EXPECT_THAT(answer, testing::ContainsRegex("op1 +station +present +heard 0[.][0-9] s ago, the holder\n"));
}

TEST(AgentRun, SameSeedSameRun) {
  const auto run = [](std::uint64_t seed) {
    AgentBench bench({}, seed);
    auto& op = bench.join("op1");
    bench.run(1s);
    (void)bench.ask(op, radio::CMD_TAKE);
    (void)bench.ask(op, radio::CMD_GOTO, {}, 3.0, 0.5);
    bench.run(5s);
    return bench.commands;
  };
  EXPECT_EQ(run(3), run(3));
}

TEST(AgentRun, RefusedTreeHoldsAndSaysSo) {
  // One that contradicts the mode table, and one that is not there.
  for (const std::string& tree : {source_folder() + "/tests/rehearsal/hostile_trees/without_not_stopped.xml",
                                  std::string("/nowhere/robot.xml")}) {
    AgentBench bench(AgentParams{}, 1, tree);
    auto& op = bench.join("op1");
    bench.run(2s);
    EXPECT_THAT(op.notice_codes(), testing::Contains("tree_refused"));
    EXPECT_THAT(op.notices,
                testing::Contains(testing::Property(&radio::Notification::text, testing::HasSubstr(tree))));
    ASSERT_EQ(bench.ask(op, radio::CMD_TAKE), Reason::none);
    EXPECT_EQ(op.behaviour.mode(), "hold");
    EXPECT_EQ(op.behaviour.reason(), static_cast<std::uint16_t>(Reason::tree_refused));
    EXPECT_EQ(bench.ask(op, radio::CMD_GOTO, {}, 3, 0), Reason::tree_refused);
    EXPECT_EQ(bench.ask(op, radio::CMD_MODE, "manual"), Reason::tree_refused);
    EXPECT_EQ(bench.ask(op, radio::CMD_MODE, "fly"), Reason::mode_unknown);
    EXPECT_EQ(bench.ask(op, radio::CMD_MODE, "hold"), Reason::none);
    EXPECT_EQ(bench.ask(op, radio::CMD_STOP), Reason::none);
    EXPECT_EQ(bench.ask(op, radio::CMD_RESET), Reason::none);
    EXPECT_EQ(bench.command, Twist2{});
  }
}

TEST(AgentRun, BadNameIsAnError) {
  VirtualScheduler scheduler(1);
  wire::SimulatedNetwork network(scheduler, {});
  const auto machine = scheduler.machine("r1", 0s);
  const auto radio = network.join(77, "r1"), robot = network.join(100, "r1");
  AgentParams params{};
  params.name = "no good";
  EXPECT_EQ(Agent(params, *machine, *radio, *robot).start().reason(), Reason::bad_argument);
}

}  // namespace
}  // namespace adit::agent
