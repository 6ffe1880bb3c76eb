// SPDX-License-Identifier: Apache-2.0
// A driver whose odometry begins again elsewhere: while the agent runs, and while it does not (rule 7).
#include <gmock/gmock.h>

#include "core/store/memory_disk.hpp"
#include "tests/agent/agent_bench.hpp"
#include "tests/agent/only_zero.hpp"

namespace adit::agent {
namespace {

using namespace radio;  // the command kinds
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class OdometryReset : public testing::Test {
 protected:
  void SetUp() override {
    AgentParams params;
    params.boot = 1;
    params.disk = disk;
    params.platform.max_speed = 2.0;
    params.platform.router = "graph";
    bench = std::make_unique<AgentBench>(params);
    op1 = &bench->join("op1");
    op2 = &bench->join("op2");
    bench->run(1500ms);
    ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
    ASSERT_EQ(bench->ask(*op1, CMD_GOTO, "", 30, 0), Reason::none);
    bench->run(4s);
    ASSERT_GT(bench->command.vx, 0.5);
    ASSERT_GT(bench->pose.x, 3.0);
  }
  /// The process dies, and another one is started half a second later.
  void crash() {
    bench->stop_agent();
    bench->command = {};  // Its parent sends zero.
    bench->run(500ms);
    bench->commands.clear();
  }
  std::string notice(const AgentBench::Operator& op) {
    for (const auto& n : op.notices)
      if (n.code() == "odometry_jumped") return n.text();
    return {};
  }

  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::unique_ptr<AgentBench> bench{};
  AgentBench::Operator *op1{}, *op2{};
};

TEST_F(OdometryReset, EndsInZeroAndHoldAndAllOperatorsAreNotified) {
  bench->pose = {};
  bench->run(100ms);
  bench->commands.clear();
  bench->run(3s);
  EXPECT_THAT(bench->commands, only_zero());
  EXPECT_EQ(op1->behaviour.mode(), "hold");
  EXPECT_EQ(static_cast<Reason>(op1->behaviour.reason()), Reason::odometry_jumped);
  EXPECT_EQ(op1->behaviour.goal_state(), radio::GOAL_KEPT);
  for (const auto* op : {op1, op2}) EXPECT_THAT(notice(*op), HasSubstr("pose r1 X Y YAW"));
}

TEST_F(OdometryReset, AManualModeEndsInHoldToo) {
  bench->stream(*op1, 0.0, 200ms);
  (void)bench->send(*op1, CMD_MODE, "manual");
  bench->stream(*op1, 0.0, 300ms);
  bench->stream(*op1, 1.0, 2s);
  ASSERT_GT(bench->command.vx, 0.5);
  bench->pose = {};
  bench->stream(*op1, 1.0, 200ms);
  bench->commands.clear();
  bench->stream(*op1, 1.0, 1s);
  EXPECT_THAT(bench->commands, only_zero());
  EXPECT_EQ(op1->behaviour.mode(), "hold");
}

TEST_F(OdometryReset, TheRobotIsTakenToBeWhereItWas) {
  const double before = bench->pose.x;
  bench->pose = {};
  bench->run(500ms);
  EXPECT_NEAR(op1->state.x(), before, 0.3);
}

TEST_F(OdometryReset, AGoalDoesNotGoOnByItself) {
  bench->pose = {};
  bench->run(20s);
  EXPECT_NEAR(bench->pose.x, 0, 0.2);
  EXPECT_EQ(bench->ask(*op1, CMD_MODE, "waypoint"), Reason::none) << "the operator decides";
  bench->run(1s);
  EXPECT_GT(bench->command.vx, 0.3);
}

TEST_F(OdometryReset, WhileTheAgentIsAwayEndsInHold) {
  crash();
  bench->pose = {};
  bench->start_agent();
  bench->run(5s);
  EXPECT_THAT(bench->commands, only_zero());
  EXPECT_EQ(op1->behaviour.mode(), "hold");
  EXPECT_EQ(static_cast<Reason>(op1->behaviour.reason()), Reason::odometry_jumped);
  EXPECT_EQ(op1->behaviour.goal_state(), radio::GOAL_KEPT);
  EXPECT_THAT(notice(*op2), HasSubstr("jumped"));
}

TEST_F(OdometryReset, WhileTheCommandComponentIsAwayEndsInHold) {
  ASSERT_TRUE(bench->agent().inject("command", ComponentFault::crash));
  bench->run(20ms);
  bench->pose = {};
  bench->run(200ms);
  bench->commands.clear();
  bench->run(5s);
  EXPECT_THAT(bench->commands, only_zero());
  EXPECT_EQ(static_cast<Reason>(op1->behaviour.reason()), Reason::odometry_jumped);
}

TEST_F(OdometryReset, AfterASlowDriveIsComparedWithAPlaceOfTheLastSecond) {
  bench->stream(*op1, 0.0, 200ms);
  (void)bench->send(*op1, CMD_MODE, "manual");
  bench->stream(*op1, 0.0, 300ms);
  bench->stream(*op1, 0.3, 5s);
  ASSERT_NEAR(bench->command.vx, 0.3, 0.05);
  crash();
  bench->pose.x -=
      4.5;  // The body can go 4.1 m in 1.6 s, and 7.6 m until it stands when the agent is silent.
  bench->start_agent();
  bench->run(3s);
  EXPECT_THAT(notice(*op2), HasSubstr("jumped"));
}

TEST_F(OdometryReset, WithoutAResetTheGoalContinuesAfterARestart) {
  crash();
  bench->start_agent();
  bench->run(5s);
  EXPECT_EQ(op1->behaviour.mode(), "waypoint");
  EXPECT_GT(bench->pose.x, 6.0);
  EXPECT_EQ(notice(*op1), "");
}

TEST_F(OdometryReset, ADriverThatReturnsAtItsPlaceIsNoReset) {
  bench->driver_alive = false;
  bench->run(10s);
  bench->driver_alive = true;
  bench->run(2s);
  EXPECT_EQ(op1->behaviour.mode(), "waypoint");
  EXPECT_EQ(notice(*op1), "");
}

TEST_F(OdometryReset, AlternatingDriversAreReportedOnceInFiveSeconds) {
  for (int i = 0; i < 100; ++i) {
    bench->pose.x += i % 2 == 0 ? 5 : -5;
    bench->run(20ms);
  }
  int reports = 0;
  for (const auto& n : op1->notices)
    if (n.code() == "odometry_jumped") ++reports;
  EXPECT_EQ(reports, 1);
}

}  // namespace
}  // namespace adit::agent
