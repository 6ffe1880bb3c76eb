// SPDX-License-Identifier: Apache-2.0
// Faults of the scenario file as they happen in a run: what each does, and that each ends only itself.
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

constexpr const char* kHead = R"(world: {boxes: [], floor: 0, ceiling: 3}
duration: 20
link: wifi
lidar: planar
robots:
  - {id: r1, platform: wheeled, pose: [0, 0, 0]}
  - {id: r2, platform: legged, pose: [0, 6, 0]}
basestations:
  - {id: op1, pose: [0, 3]}
script:
  - {at: 2, by: op1, do: take r1}
  - {at: 3, by: op1, do: goto r1 9 0}
)";

RunReport run(const std::string& rest) {
  const RunReport report = run_text(kHead + rest, "faults.yaml");
  for (const RuleResult& rule : report.rules) EXPECT_EQ(rule.violations, 0U) << rule.title;
  return report;
}

/// That the expectations hold with the faults, and not without. `script`: further lines of it.
void expect_both(const std::string& script, const std::string& faults, const std::string& expect) {
  for (const std::string& line : run(script + "faults:\n" + faults + "expect:\n" + expect).complaints())
    ADD_FAILURE() << line;
  EXPECT_FALSE(run(script + "expect:\n" + expect).ok()) << "the fault makes no difference";
}

TEST(Faults, AGoalWhoseJudgementEndsWithTheCommandComponentIsAnsweredWhenItIsRepeated) {
  for (int after = 30; after <= 46; after += 2) {
    const std::string head = R"(world: {boxes: [[-9, 9, 2, 2.3, 0, 2.5]], floor: 0, ceiling: 3}
duration: 7
link: {name: mine, bandwidth: 2e6, latency: 0.03}
lidar: planar
robots:
  - {id: r1, platform: wheeled, pose: [0, 0, 0]}
basestations:
  - {id: op1, pose: [0, 3]}
script:
  - {at: 5, by: op1, do: goto r1 2 0}
faults:
  - {at: 5.0)";
    const RunReport report = run_text(head + std::to_string(after) + ", crash: r1/command}\n", "faults.yaml");
    for (const std::string& line : report.complaints()) ADD_FAILURE() << after << " ms: " << line;
  }
}

TEST(Faults, OverlappingCutsEndOnlyThemselves) {
  expect_both("  - {at: 7, by: op1, do: mode r1 hold}\n",
              "  - {at: 5, cut: [op1, r1], for: 8}\n  - {at: 6, cut: [r1, op1], for: 0.5}\n",
              "  - {at: 12, robot: r1, mode: waypoint}\n");
}

TEST(Faults, BodyOfASlipIsStuckThoughItsWheelsSayThatItDrives) {
  expect_both("", "  - {at: 5, slip: r1, wheels: [1, 0], for: 4}\n",
              "  - {from: 5.1, to: 8.9, robot: r1, still: 0.001}\n");
  // Its agent believes the wheels: it brakes for the goal 4 m before it.
  expect_both("", "  - {at: 5, slip: r1, wheels: [1, 0], for: 4}\n",
              "  - {at: 19, robot: r1, near: [5, 0, 1]}\n");
}

TEST(Faults, CommandGivenUpDuringACutIsNotObeyedAfterIt) {
  expect_both(
      "  - {at: 7, by: op1, do: mode r1 hold}\n", "  - {at: 6, cut: [op1, r1], for: 6}\n",
      "  - {at: 11, by_operator: op1, refused: no_answer}\n  - {at: 18, robot: r1, mode: waypoint}\n");
}

TEST(Faults, ACutOneWayLetsTheOtherPass) {
  // The command arrives; its answer does not: the station gives up.
  expect_both("  - {at: 7, by: op1, do: mode r1 hold}\n",
              "  - {at: 6, cut: [r1, op1], one_way: true, for: 8}\n",
              "  - {at: 8, robot: r1, mode: hold}\n  - {at: 12, by_operator: op1, refused: no_answer}\n");
}

TEST(Faults, APartitionCutsBetweenItsGroupsOnly) {
  expect_both("  - {at: 7, by: op1, do: stop r1}\n  - {at: 7, by: op1, do: stop r2}\n",
              "  - {at: 6, partition: [[op1, r2], [r1]], for: 5}\n",
              "  - {at: 8, robot: r2, stopped: true}\n  - {at: 8, robot: r1, stopped: false}\n");
}

TEST(Faults, StuckDriveIgnoresEveryVelocity) {
  expect_both("", "  - {at: 4, stuck: r1, for: 12}\n  - {at: 5, stuck: r1, for: 1}\n",
              "  - {at: 15.5, robot: r1, near: [0, 0, 2.0]}\n  - {at: 15.5, robot: r1, mode: waypoint}\n");
}

TEST(Faults, WithoutOdometryARobotDoesNotGoOn) {
  expect_both("", "  - {at: 4, sensor_silent: r1, sensor: odometry, for: 12}\n",
              "  - {at: 15.5, robot: r1, near: [1, 0, 2.5]}\n");
}

TEST(Faults, WithoutLidarARobotDoesNotGoOn) {
  expect_both("", "  - {at: 4, sensor_silent: r1, for: 12}\n",
              "  - {at: 15.5, robot: r1, near: [1, 0, 2]}\n");
}

TEST(Faults, ClockJumpEndsTheLeaseOfALock) {
  // The lock's lease runs out by the robot's clock.
  expect_both("  - {at: 4, by: op1, do: lock r1}\n",
              "  - {at: 6, cut: [op1, r1], for: 4}\n  - {at: 7, clock_jump: {r1: 400}}\n",
              "  - {at: 9, robot: r1, locked: false, holder: op1}\n");
}

TEST(Faults, CountsFaults) {
  const RunReport report =
      run("faults:\n  - {at: 4, reorder: [op1, r1], chance: 0.5, for: 5}\n  - {at: 5, duplicate: [op1, r1], "
          "chance: 0.5, for: 5}\n"
          "  - {at: 5, disk_full: r1, for: 2}\n  - {at: 6, crash: r2}\n  - {at: 8, crash: r2}\n"
          "expect:\n  - {faults_at_least: 6}\n");
  EXPECT_EQ(report.fault_count(), 5U);
  EXPECT_EQ(report.faults.at("crash"), 2U);
  ASSERT_EQ(report.complaints().size(), 1U) << "five are less than six";
}

}  // namespace
}  // namespace adit::sim
