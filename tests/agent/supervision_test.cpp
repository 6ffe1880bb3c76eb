// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "core/command/vocabulary.hpp"
#include "geometry_msgs/msg/TwistStamped.h"
#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using testing::Contains;
using testing::Not;

/// An agent that drives to a goal far away, with a holder.
class SupervisionTest : public testing::Test {
 protected:
  static AgentParams params() {
    AgentParams p{};
    p.name = "r1";
    p.planning = 20ms;
    return p;
  }
  SupervisionTest() : bench(with_end(params())) {
    op = &bench.join("op1");
    bench.run(3s);
    EXPECT_EQ(bench.ask(*op, radio::CMD_TAKE), Reason::none);
    EXPECT_EQ(bench.ask(*op, radio::CMD_GOTO, "", 50, 0), Reason::none);
    bench.run(2s);
    EXPECT_GT(bench.command.vx, 0.5);
    op->notices.clear();
  }
  AgentParams with_end(AgentParams p) {
    p.end = [this](const std::string& why) {
      ended = why;
      ended_at = bench.elapsed();
    };
    p.alive = [this] { ++alive; };
    return p;
  }
  radio::ComponentHealth health(const std::string& component) {
    for (const auto& c : op->health.components())
      if (c.name() == component) return c;
    ADD_FAILURE() << "no health of " << component;
    return {};
  }
  /// How long the driver got zero and nothing else, at most, within so much time from now.
  bool zero_within(Duration patience) {
    for (Duration t{}; t < patience; t += 10ms) {
      if (bench.command.zero()) return true;
      bench.run(10ms);
    }
    return bench.command.zero();
  }
  void inject(const std::string& component, ComponentFault fault) {
    ASSERT_TRUE(bench.agent().inject(component, fault));
  }

  std::string ended{};
  Duration ended_at{};
  int alive{};
  AgentBench bench;
  AgentBench::Operator* op{};
};

// The zeros of the supervisor are of the type that the driver knows.
TEST(SupervisionOfAStampedDriver, GetsStampedZerosWhenTheCommandComponentHangs) {
  std::string ended;
  AgentParams p{};
  p.name = "r1";
  p.velocity = VelocityType::twist_stamped;
  p.end = [&](const std::string& why) { ended = why; };
  AgentBench bench(p);
  const auto machine = bench.machine("driver");
  const auto strand = machine->strand("driver");
  const auto wire = bench.network().join(100, "stamped");
  std::size_t zeros = 0;
  const auto reader =
      wire::make_reader(*wire, wire::topics::kCmdVelStamped, *strand,
                        [&](const geometry_msgs::msg::TwistStamped& t, const wire::SampleInfo&) {
                          if (t.twist().linear().x() == 0.0) ++zeros;
                        });
  bench.run(3s);
  EXPECT_GT(zeros, 0u);
  ASSERT_TRUE(bench.agent().inject("command", ComponentFault::hang));
  bench.run(200ms);
  const std::size_t before = zeros;
  bench.run(1s);
  EXPECT_GT(zeros, before);
}

TEST_F(SupervisionTest, ACrashedPlannerIsBackInATenthOfASecondAndTheRobotDrivesOn) {
  inject("planner", ComponentFault::crash);
  bench.run(100ms);
  EXPECT_THAT(op->notice_codes(), Contains("component_failed"));
  EXPECT_THAT(op->notice_codes(), Contains("component_back"));
  bench.run(1s);
  EXPECT_EQ(health("planner").restarts(), 1u);
  EXPECT_EQ(health("planner").state(), radio::COMPONENT_UP);
  EXPECT_GT(bench.command.vx, 0.5);
  EXPECT_EQ(op->behaviour.mode(), "waypoint");
  EXPECT_TRUE(ended.empty());
}

TEST_F(SupervisionTest, AHungPlannerIsFoundWithinASecondReplacedAndZeroIsSentMeanwhile) {
  inject("planner", ComponentFault::hang);
  EXPECT_TRUE(zero_within(620ms));  // plans count for 500 ms
  bench.run(400ms);
  EXPECT_THAT(op->notice_codes(), Contains("component_hung"));
  bench.run(1s);
  EXPECT_EQ(health("planner").hung(), 1u);
  EXPECT_EQ(health("planner").state(), radio::COMPONENT_UP);
  EXPECT_GT(bench.command.vx, 0.5);
  EXPECT_TRUE(ended.empty());
}

TEST_F(SupervisionTest, TheCommandInterfaceGoesOnWhileThePlannerHangs) {
  inject("planner", ComponentFault::hang);
  inject("sensors", ComponentFault::crash);
  bench.run(300ms);
  EXPECT_EQ(bench.ask(*op, radio::CMD_STOP), Reason::none);
  EXPECT_TRUE(bench.command.zero());
}

TEST_F(SupervisionTest, ASecondHangRestartsTheAgent) {
  inject("planner", ComponentFault::hang);
  bench.run(2s);
  EXPECT_TRUE(ended.empty());
  inject("sensors", ComponentFault::hang);
  bench.run(1s);
  EXPECT_THAT(ended, testing::HasSubstr("sensors"));
  EXPECT_THAT(op->notice_codes(), Contains("escalated"));
  EXPECT_TRUE(bench.command.zero());
  const std::size_t commands = bench.commands.size();
  bench.run(1s);
  for (std::size_t i = commands; i < bench.commands.size(); ++i) EXPECT_TRUE(bench.commands[i].zero());
}

TEST_F(SupervisionTest, AHungSensorsComponentIsReplacedAndScansComeAgain) {
  inject("sensors", ComponentFault::hang);
  EXPECT_TRUE(zero_within(1100ms));
  bench.run(2s);
  EXPECT_EQ(health("sensors").hung(), 1u);
  EXPECT_GT(bench.command.vx, 0.5);
}

TEST_F(SupervisionTest, ACrashedCommandComponentIsBackWithItsStateUnderAnotherEpoch) {
  EXPECT_EQ(bench.ask(*op, radio::CMD_LOCK), Reason::none);
  const auto before = op->authority;
  inject("command", ComponentFault::crash);
  bench.run(10ms);
  EXPECT_TRUE(bench.command.zero());
  bench.run(90ms);
  EXPECT_THAT(op->notice_codes(), testing::IsSupersetOf({"component_failed", "component_back", "restarted"}));
  bench.run(1s);
  EXPECT_NE(op->authority.epoch().start(), before.epoch().start());
  EXPECT_EQ(op->authority.epoch().counter(), before.epoch().counter() + 1);
  EXPECT_EQ(op->authority.holder(), "op1");
  EXPECT_TRUE(op->authority.locked());
  EXPECT_EQ(health("command").restarts(), 1u);
  EXPECT_EQ(op->behaviour.mode(), "waypoint");
  EXPECT_GT(bench.command.vx, 0.5);  // to its goal, once the tree had checked the conditions
}

TEST_F(SupervisionTest, AStopSurvivesACrashOfTheCommandComponent) {
  EXPECT_EQ(bench.ask(*op, radio::CMD_STOP), Reason::none);
  const std::size_t commands = bench.commands.size();
  inject("command", ComponentFault::crash);
  bench.run(2s);
  EXPECT_EQ(op->authority.stops().size(), 1u);
  for (std::size_t i = commands; i < bench.commands.size(); ++i) EXPECT_TRUE(bench.commands[i].zero());
  EXPECT_GT(bench.commands.size(), commands + 20);
}

TEST_F(SupervisionTest, AHungCommandStrandIsSeenFromOutsideAndEndsTheAgent) {
  const Duration hung_at = bench.elapsed();
  inject("command", ComponentFault::hang);
  EXPECT_TRUE(zero_within(300ms));  // by the supervisor
  bench.run(1s);
  EXPECT_THAT(ended, testing::HasSubstr("command"));
  EXPECT_LT(ended_at - hung_at, 1s);
  EXPECT_THAT(op->notice_codes(), testing::IsSupersetOf({"component_hung", "escalated"}));
  EXPECT_EQ(health("command").healthy(), false);
  const int was_alive = alive;
  bench.run(1s);
  EXPECT_EQ(alive, was_alive);  // the watchdog is not fed
}

// The station marks driver and store in its listing by the same rule.
TEST_F(SupervisionTest, RestartTakesTheSupervisedComponentsAndRefusesOthers) {
  std::string answer;
  const auto ask = [&](const std::string& line) {
    answer.clear();
    bench.agent().at_console(line, [&](const std::string& text) { answer = text; });
    bench.run(10ms);
    return answer;
  };
  ask("health");
  EXPECT_THAT(answer, testing::ContainsRegex("planner +up +auto"));
  EXPECT_THAT(answer, testing::ContainsRegex("driver +up +- "));
  std::size_t refused = 0;
  for (const auto& part : op->health.components()) {
    const bool taken = ask("policy " + part.name() + " auto") == "done\n";
    EXPECT_EQ(taken, command::is_component(part.name())) << part.name();
    if (taken) continue;
    ++refused;
    EXPECT_THAT(ask("restart " + part.name()),
                testing::StartsWith("refused: " + part.name() +
                                    " is no component of the agent; restart takes agent, command, planner"));
  }
  EXPECT_GT(refused, 0U);
  for (const char* incomplete : {"restart", "restart planner now", "policy planner", "policy planner on"})
    EXPECT_THAT(ask(incomplete),
                testing::MatchesRegex("refused: '" + std::string(incomplete) +
                                      "' is no command of the console .*restart COMPONENT.*\n"));
  EXPECT_THAT(ask("policy agent auto"), testing::Not(testing::HasSubstr("takes agent")));
}

TEST(Health, ADriverThatWasNeverPresentHasNotFailed) {
  AgentBench bench;
  bench.driver_alive = false;
  const auto& op = bench.join("op1");
  const auto driver = [&] {
    for (const auto& c : op.health.components())
      if (c.name() == "driver") return c;
    ADD_FAILURE() << "no health of the driver";
    return radio::ComponentHealth{};
  };
  bench.run(3s);
  EXPECT_EQ(driver().state(), radio::COMPONENT_STARTING);
  EXPECT_EQ(driver().text(), "no usable odometry since the start of the agent");
  bench.driver_alive = true;
  bench.run(1s);
  EXPECT_EQ(driver().state(), radio::COMPONENT_UP);
  bench.driver_alive = false;
  bench.run(2s);
  EXPECT_EQ(driver().state(), radio::COMPONENT_FAILED);
}

TEST_F(SupervisionTest, TheWatchdogIsFedTwentyTimesASecond) {
  const int before = alive;
  bench.run(1s);
  EXPECT_NEAR(alive - before, 20, 1);
}

TEST_F(SupervisionTest, ACrashLoopBacksOffAndEscalates) {
  for (int i = 0; i < 6 && ended.empty(); ++i) {
    inject("planner", ComponentFault::crash);
    bench.run(2200ms);
  }
  bench.run(200ms);
  EXPECT_THAT(ended, testing::HasSubstr("planner"));
}

TEST_F(SupervisionTest, UnderThePolicyManualItWaitsForTheOperator) {
  EXPECT_EQ(bench.ask(*op, radio::CMD_POLICY, "planner", 0, 0, false), Reason::none);
  EXPECT_FALSE(health("planner").automatic());
  inject("planner", ComponentFault::crash);
  bench.run(5s);
  EXPECT_EQ(health("planner").state(), radio::COMPONENT_FAILED);
  EXPECT_TRUE(bench.command.zero());
  EXPECT_EQ(bench.ask(*op, radio::CMD_RESTART, "planner"), Reason::none);
  bench.run(1s);
  EXPECT_EQ(health("planner").state(), radio::COMPONENT_UP);
  EXPECT_GT(bench.command.vx, 0.5);
}

TEST_F(SupervisionTest, OnlyTheHolderRestartsAndOnlyComponents) {
  auto& other = bench.join("op2");
  bench.run(1s);
  EXPECT_EQ(bench.ask(other, radio::CMD_RESTART, "planner"), Reason::not_holder);
  EXPECT_EQ(bench.ask(*op, radio::CMD_RESTART, "wheels"), Reason::bad_argument);
  EXPECT_EQ(bench.ask(*op, radio::CMD_POLICY, "wheels"), Reason::bad_argument);
  EXPECT_EQ(bench.ask(*op, radio::CMD_POLICY, "command", 0, 0, false), Reason::not_supported);
  EXPECT_THAT(op->notice_codes(), Not(Contains("component_back")));
}

TEST_F(SupervisionTest, TheOperatorRestartsTheAgent) {
  EXPECT_EQ(bench.ask(*op, radio::CMD_RESTART, "agent"), Reason::none);
  EXPECT_THAT(ended, testing::HasSubstr("operator"));
}

TEST_F(SupervisionTest, AHungAgentCanBeDestroyed) {
  inject("command", ComponentFault::hang);
  inject("planner", ComponentFault::hang);
  inject("sensors", ComponentFault::hang);
  bench.run(1s);
  bench.stop_agent();
  bench.start_agent();
  bench.run(3s);
  EXPECT_EQ(bench.ask(*op, radio::CMD_TAKE), Reason::none);
}

}  // namespace
}  // namespace adit::agent
