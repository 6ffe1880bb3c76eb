// SPDX-License-Identifier: Apache-2.0
// The collision monitor in a complete agent: what manual mode may do near things and with a dead lidar.
#include <gmock/gmock.h>

#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using testing::Contains;
using testing::Not;

AgentParams stops_in_manual(bool stops) {
  AgentParams params{};
  params.platform.manual_collision_stop = stops;
  return params;
}

struct MonitorTest : testing::TestWithParam<bool> {
  MonitorTest() {
    bench.run(1500ms);
    EXPECT_EQ(bench.ask(op1, radio::CMD_TAKE), Reason::none);
  }
  void enter(const std::string& mode) {
    bench.stream(op1, 0.0, 300ms);
    bench.send(op1, radio::CMD_MODE, mode);
    bench.stream(op1, 0.0, 300ms);
    ASSERT_EQ(op1.behaviour.mode(), mode);
  }
  void wall(float x) {
    for (float y = -1.0f; y < 1.0f; y += 0.04f)
      for (const float z : {0.2f, 0.3f, 0.4f}) bench.obstacles.push_back({x, y, z});
  }
  AgentBench bench{stops_in_manual(GetParam())};
  AgentBench::Operator& op1 = bench.join("op1");
};

TEST_P(MonitorTest, ManualWithADeadLidarDrivesSlowlyAndTheOperatorIsWarned) {
  enter("manual");
  bench.stream(op1, 0.8, 500ms);
  EXPECT_NEAR(bench.command.vx, 0.8, 1e-6);
  EXPECT_THAT(op1.notice_codes(), Not(Contains("lidar_silent")));
  bench.lidar_alive = false;
  bench.stream(op1, 0.8, 2s);
  EXPECT_NEAR(bench.command.vx, 0.3, 1e-6);
  EXPECT_EQ(op1.behaviour.mode(), "manual");
  const auto codes = op1.notice_codes();
  EXPECT_EQ(std::count(codes.begin(), codes.end(), "lidar_silent"), 1) << "once";
  bench.lidar_alive = true;
  bench.stream(op1, 0.8, 500ms);
  EXPECT_NEAR(bench.command.vx, 0.8, 1e-6);
}

TEST_P(MonitorTest, ManualBeforeAWall) {
  wall(2.5f);
  bench.run(300ms);
  enter("manual");
  bench.stream(op1, 1.0, GetParam() ? 6s : 3500ms);
  EXPECT_THAT(op1.notice_codes(), Contains("obstacle_near"));
  if (GetParam()) {
    EXPECT_EQ(bench.command, Twist2{}) << "the platform's file asked for it";
    EXPECT_LT(bench.pose.x + Platform{}.length / 2, 2.5);
  } else {
    EXPECT_NEAR(bench.command.vx, 0.3, 1e-6) << "slow, and never stopped";
  }
}

TEST_P(MonitorTest, SmartJoystickWithADeadLidarStops) {
  enter("smart_joystick");
  bench.stream(op1, 0.8, 1s);
  EXPECT_GT(bench.command.vx, 0.2);
  bench.lidar_alive = false;
  bench.stream(op1, 0.8, 800ms);
  EXPECT_EQ(bench.command, Twist2{});
  EXPECT_THAT(op1.notice_codes(), Not(Contains("lidar_silent"))) << "the mode says why itself";
}

TEST_P(MonitorTest, ScansOfAnUnknownFrameAreRefusedByName) {
  bench.lidar_frame = "velodyne";
  bench.run(2s);
  EXPECT_THAT(op1.notice_codes(), Contains("sensor_refused"));
  const auto& heard = op1.notices;
  const auto refused =
      std::find_if(heard.begin(), heard.end(), [](const auto& n) { return n.code() == "sensor_refused"; });
  ASSERT_NE(refused, heard.end());
  EXPECT_EQ(refused->reason(), static_cast<std::uint16_t>(Reason::frame_unknown));
  EXPECT_THAT(refused->text(), testing::HasSubstr("'velodyne'"));
  bench.stream(op1, 0.0, 300ms);
  EXPECT_EQ(bench.ask(op1, radio::CMD_MODE, "smart_joystick"), Reason::terrain_stale)
      << "nothing may drive by them";
  bench.lidar_frame = "lidar";
  bench.run(500ms);
  bench.stream(op1, 0.0, 300ms);
  EXPECT_EQ(bench.ask(op1, radio::CMD_MODE, "smart_joystick"), Reason::none);
}

INSTANTIATE_TEST_SUITE_P(ManualStops, MonitorTest, testing::Bool(),
                         [](const auto& each) { return each.param ? "asked_for" : "by_default"; });

}  // namespace
}  // namespace adit::agent
