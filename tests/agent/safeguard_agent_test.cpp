// SPDX-License-Identifier: Apache-2.0
// What an agent does by itself when its holder is silent or its battery empties.
#include <gmock/gmock.h>

#include "core/store/memory_disk.hpp"
#include "sensor_msgs/msg/BatteryState.h"
#include "tests/agent/agent_bench.hpp"
#include "tests/agent/only_zero.hpp"

namespace adit::agent {
namespace {

using namespace radio;  // the command kinds
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

class Safeguards : public testing::Test {
 protected:
  void begin(AgentParams params = {}) {
    params.disk = disk;
    bench = std::make_unique<AgentBench>(params);
    op1 = &bench->join("op1");
    op2 = &bench->join("op2");
    bench->run(1500ms);
  }
  static AgentParams with(OnLoss action) {
    AgentParams params;
    params.safeguards.link_loss.action = action;
    params.safeguards.link_loss.after = 5s;
    return params;
  }
  void go(double x) {
    ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
    ASSERT_EQ(bench->ask(*op1, CMD_GOTO, "", x, 0), Reason::none);
    bench->run(2s);
    ASSERT_GT(bench->command.vx, 0.1);
  }
  /// op1 is out of reach; op2 sees it all.
  void lose(bool lost) { op1->up = !lost; }

  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::unique_ptr<AgentBench> bench{};
  AgentBench::Operator *op1{}, *op2{};
};

TEST_F(Safeguards, GoesOnWithoutItsHolder) {
  begin(with(OnLoss::go_on));
  go(60);
  lose(true);
  bench->run(8s);
  EXPECT_GT(bench->command.vx, 0.1);
  EXPECT_EQ(op2->behaviour.mode(), "waypoint");
  EXPECT_THAT(op2->notice_codes(), Contains("link_lost"));
  lose(false);
  bench->run(2s);
  EXPECT_THAT(op1->notice_codes(), Contains("link_back"));
}

TEST_F(Safeguards, ARestartOfTheCommandComponentIsNoSignOfLifeOfTheHolder) {
  begin(with(OnLoss::go_on));
  go(60);
  lose(true);
  bench->run(3s);
  ASSERT_TRUE(bench->agent().inject("command", ComponentFault::crash));
  bench->run(3500ms);
  EXPECT_THAT(op2->notice_codes(), Contains("link_lost")) << "6.5 s after the last sign of life";
}

TEST_F(Safeguards, HoldsWithoutItsHolderAndDoesNotGoOnByItself) {
  begin(with(OnLoss::hold));
  go(60);
  lose(true);
  bench->run(4s);
  EXPECT_GT(bench->command.vx, 0.1);
  bench->run(3s);
  EXPECT_EQ(op2->behaviour.mode(), "hold");
  EXPECT_EQ(op2->behaviour.goal_state(), radio::GOAL_KEPT);
  EXPECT_EQ(bench->command, Twist2{});
  lose(false);
  bench->run(5s);
  EXPECT_EQ(bench->command, Twist2{}) << "reconnection moves nothing";
  EXPECT_EQ(bench->ask(*op1, CMD_MODE, "waypoint"), Reason::none);
  bench->run(1s);
  EXPECT_GT(bench->command.vx, 0.1);
}

TEST_F(Safeguards, GoesBackToWhereItsHolderWasHeard) {
  begin(with(OnLoss::back));
  go(60);
  const double heard = bench->pose.x;
  lose(true);
  bench->run(7s);
  EXPECT_THAT(op2->notice_codes(), Contains("returning"));
  EXPECT_NEAR(op2->behaviour.goal()[0], heard, 3.0);
  bench->run(60s);
  EXPECT_EQ(op2->behaviour.goal()[0], 0.0) << "not heard there either: on to the start";
  EXPECT_NEAR(bench->pose.x, 0.0, 1.0);
}

TEST_F(Safeguards, ALostLinkMovesNoRobotThatHolds) {
  begin(with(OnLoss::back));
  ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
  bench->commands.clear();
  lose(true);
  bench->run(20s);
  EXPECT_THAT(bench->commands, only_zero());
}

TEST_F(Safeguards, AStoppedRobotDoesNotGoBack) {
  begin(with(OnLoss::back));
  go(60);
  ASSERT_EQ(bench->ask(*op2, CMD_STOP), Reason::none);
  bench->commands.clear();
  lose(true);
  bench->run(20s);
  EXPECT_THAT(bench->commands, only_zero());
}

class Batteries : public Safeguards {
 protected:
  void begin(AgentParams params = {}) {
    Safeguards::begin(std::move(params));
    wire = bench->network().join(100, "battery");
    writer = wire::Writer<sensor_msgs::msg::BatteryState>::make(*wire, wire::topics::kBattery).value();
    bench->run(500ms);
  }
  void charge(float percentage) {
    sensor_msgs::msg::BatteryState b;
    b.percentage(percentage);
    (void)writer.write(b);
    bench->run(300ms);
  }
  int count(const std::string& code) {
    const auto codes = op2->notice_codes();
    return static_cast<int>(std::count(codes.begin(), codes.end(), code));
  }
  std::unique_ptr<wire::Participant> wire{};
  wire::Writer<sensor_msgs::msg::BatteryState> writer{};
};

TEST_F(Batteries, EveryThresholdIsReportedOnceToAllStations) {
  begin();
  charge(0.9F);
  EXPECT_FLOAT_EQ(op1->state.battery(), 0.9F);
  for (const float c : {0.29F, 0.28F, 0.19F, 0.18F}) charge(c);
  EXPECT_EQ(count("battery_warning"), 1);
  EXPECT_EQ(count("battery_low"), 1);
  EXPECT_EQ(count("battery_last"), 0);
}

TEST_F(Batteries, TheLastOneHolds) {
  begin();
  go(60);
  charge(0.05F);
  bench->run(1s);
  EXPECT_EQ(op1->behaviour.mode(), "hold");
  EXPECT_EQ(op1->behaviour.goal_state(), radio::GOAL_KEPT);
  EXPECT_EQ(bench->ask(*op1, CMD_MODE, "waypoint"), Reason::none) << "the holder decides";
  bench->run(1s);
  EXPECT_GT(bench->command.vx, 0.1);
}

TEST_F(Batteries, TheLastOneReturnsWhereThatIsWanted) {
  AgentParams params;
  params.safeguards.return_at_last_battery = true;
  begin(params);
  go(60);
  charge(0.05F);
  bench->run(1s);
  EXPECT_EQ(op1->behaviour.mode(), "waypoint");
  EXPECT_EQ(op1->behaviour.goal()[0], 0.0);
}

class RefusedReturn : public Batteries {
 protected:
  /// The lidar is silent when the charge passes the last threshold: the return is refused.
  void SetUp() override {
    AgentParams params;
    params.safeguards.return_at_last_battery = true;
    begin(params);
    go(60);
    bench->lidar_alive = false;
    bench->run(700ms);
    charge(0.05F);
    ASSERT_EQ(op1->behaviour.mode(), "waypoint");
    ASSERT_EQ(op1->behaviour.goal()[0], 60.0);
  }
  void see_again() {
    bench->lidar_alive = true;
    bench->run(20s);
  }
};

TEST_F(RefusedReturn, IsRepeatedUntilItIsAccepted) {
  bench->run(10s);
  EXPECT_EQ(count("returning"), 0);
  EXPECT_EQ(count("return_refused"), 1) << "one notification, though it was refused several times";
  see_again();
  EXPECT_EQ(op1->behaviour.goal()[0], 0.0);
  EXPECT_EQ(count("returning"), 1);
}

TEST_F(RefusedReturn, EndsWhenTheHolderRequestsSomething) {
  ASSERT_EQ(bench->ask(*op1, CMD_MODE, "hold"), Reason::none);
  bench->commands.clear();
  see_again();
  EXPECT_THAT(bench->commands, only_zero());
}

TEST_F(RefusedReturn, EndsWhenTheHolderGivesAnotherGoal) {
  bench->lidar_alive = true;
  bench->run(150ms);  // The next attempt is not due yet.
  ASSERT_EQ(bench->ask(*op1, CMD_GOTO, "", 50, 0), Reason::none);
  bench->run(20s);
  EXPECT_EQ(op1->behaviour.goal()[0], 50.0);
}

TEST_F(RefusedReturn, EndsWhenTheBatteryRecovers) {
  charge(0.9F);
  see_again();
  EXPECT_EQ(op1->behaviour.goal()[0], 60.0);
}

TEST_F(RefusedReturn, MovesNoRobotThatWasStopped) {
  ASSERT_EQ(bench->ask(*op2, CMD_STOP), Reason::none);
  bench->commands.clear();
  bench->lidar_alive = true;
  bench->run(5s);
  ASSERT_EQ(bench->ask(*op1, CMD_RESET, "", 0, 0, true), Reason::none);
  bench->run(40s);
  EXPECT_THAT(bench->commands, only_zero());
}

TEST_F(RefusedReturn, SurvivesARestart) {
  bench->stop_agent();
  bench->start_agent();
  see_again();
  EXPECT_EQ(op1->behaviour.goal()[0], 0.0);
}

TEST_F(Batteries, ARestartRepeatsNoReport) {
  begin();
  charge(0.25F);
  EXPECT_EQ(count("battery_warning"), 1);
  bench->stop_agent();
  bench->start_agent();
  bench->run(2s);
  op2->notices.clear();
  charge(0.24F);
  EXPECT_EQ(count("battery_warning"), 0);
}

}  // namespace
}  // namespace adit::agent
