// SPDX-License-Identifier: Apache-2.0
// The collision monitor against a planner that drives into a wall on purpose, and a manual drive without a
// lidar, in the simulated world.
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

constexpr const char* kMonitorHead =
    R"(world: {boxes: [[6, 6.3, -8, 8, 0, 2], [3, 3.4, -1.4, -0.6, 0, 0.4]], floor: 0, ceiling: 3}
duration: 24
link: wifi
robots:
  - {id: r1, platform: PLATFORM, pose: [0, 0, 0]}
basestations:
  - {id: op1, pose: [0, 3]}
script:
  - {at: 2, by: op1, do: take r1}
)";

RunReport run(const std::string& platform, const std::string& rest, const std::string& defect) {
  std::string text = kMonitorHead;
  text.replace(text.find("PLATFORM"), 8, platform);
  return run_text(text + rest, "monitor.yaml", defect);
}

/// At the wall straight ahead, then at the low crate from beside it.
constexpr const char* kIntoTheWall =
    "  - {at: 3, by: op1, do: goto r1 9 0.3}\n  - {at: 12, by: op1, do: goto r1 3.2 -1}\n";

class Monitor : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(Monitor, APlannerThatDrivesIntoAWallDoesNotHitIt) {
  const auto [platform, lidar] = GetParam();
  const RunReport report =
      run(platform, std::string(kIntoTheWall) + "lidar: " + lidar + "\n", "blind_planner");
  const RobotResult& robot = report.robots.at("r1");
  EXPECT_EQ(robot.collisions, 0);
  EXPECT_GT(robot.min_clearance, 0.0);
  EXPECT_LT(robot.min_clearance, 0.15) << "it came as far as the monitor let it";
  EXPECT_GT(robot.distance, 4.5);
}

INSTANTIATE_TEST_SUITE_P(
    All, Monitor, testing::Combine(testing::Values("wheeled", "tracked", "legged"), testing::Values("full")),
    [](const auto& each) { return std::string(std::get<0>(each.param)) + "_" + std::get<1>(each.param); });

TEST(MonitorAway, TheSamePlannerHitsIt) {
  EXPECT_GT(run("wheeled", kIntoTheWall, "blind_and_unwatched").robots.at("r1").collisions, 0);
}

TEST(MonitorManual, ADeadLidarLeavesThirtyCentimetresASecond) {
  const RunReport report = run("wheeled",
                               "  - {at: 4, by: op1, do: drive r1 -1 0 0 --for 12}\n"
                               "faults:\n  - {at: 3, sensor_silent: r1, sensor: lidar, for: 20}\n",
                               "");
  EXPECT_NEAR(report.robots.at("r1").distance, 0.3 * 12, 0.5);
  EXPECT_EQ(report.robots.at("r1").collisions, 0);
}

}  // namespace
}  // namespace adit::sim
