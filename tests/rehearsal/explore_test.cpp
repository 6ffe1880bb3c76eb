// SPDX-License-Identifier: Apache-2.0
// Exploration by a whole agent, with all errors of sensors and odometry.
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

TEST(Explore, SeesAllThatCanBeReachedAlthoughItsAgentDies) {
  const RunReport report = run_text(
      "world: {generate: blocks, size: 2}\nduration: 151\nlink: wifi\n"
      "robots: [{id: r1, platform: wheeled, pose: [1.6, 1.6, 0]}]\n"
      "basestations: [{id: op1, pose: [1.6, 1.6]}]\n"
      "script: [{at: 1, by: op1, do: take r1}, {at: 2, by: op1, do: explore r1 --after wait}]\n"
      "faults: [{at: 20, crash: r1}]\n"
      "expect:\n"
      "  - {by: 5, robot: r1, explore: exploring}\n"
      "  - {at: 30, robot: r1, explore: exploring, mode: explore}\n"
      "  - {by: 130, explored_at_least: 0.97}\n"
      "  - {at: 130, repeat_at_most: 0.35}\n"
      "  - {by: 150, robot: r1, explore: done}\n"
      "  - {at: 150.5, robot: r1, explore: done, mode: hold}\n"
      "  - {always: no_collision}\n",
      "explore.yaml");
  for (const std::string& line : report.complaints()) ADD_FAILURE() << line;
  ASSERT_TRUE(report.exploration);
  EXPECT_GT(report.exploration->share, 0.97) << "done is never said too early";
}

// The areas survive the death of the agent. Rule 10 is always expected.
TEST(AreasRehearsal, ARobotThatWasDrivenOutByHandComesBackAndStaysWithin) {
  const RunReport report = run_text(
      "world: {boxes: [], floor: 0, ceiling: 3}\nodometry: {noise: 0}\nduration: 48\nlink: wifi\n"
      "lidar: planar\nrobots: [{id: r1, platform: wheeled, pose: [0, 0, 0]}]\n"
      "basestations: [{id: op1, pose: [0, 3]}]\n"
      "script:\n"
      "  - {at: 1, by: op1, do: take r1}\n"
      "  - {at: 2, by: op1, do: area r1 add west keep_in -5 -5 5 5}\n"
      "  - {at: 2.5, by: op1, do: area r1 add here keep_out -1 -1 1 1}\n"
      "  - {at: 3, by: op1, do: drive r1 1 0 0 --for 8}\n"
      "  - {at: 12, by: op1, do: goto r1 8 0}\n"
      "  - {at: 13, by: op1, do: goto r1 0 0}\n"
      "  - {at: 26, by: op1, do: goto r1 4.9 0}\n"
      "  - {at: 27, by: op1, do: goto r1 4.4 0}\n"
      "  - {at: 36, by: op1, do: goto r1 9 0}\n"
      "  - {at: 38, by: op1, do: area r1 remove west}\n"
      "  - {at: 39, by: op1, do: goto r1 9 0}\n"
      "faults: [{at: 17, crash: r1}]\n"
      "expect:\n"
      "  - {at: 2.9, by_operator: op1, refused: outside_area}\n"
      "  - {at: 11.5, robot: r1, near: [8, 0, 1.5]}\n"
      "  - {by: 12, by_operator: op1, notified: outside_area, robot: r1}\n"
      "  - {at: 12.5, by_operator: op1, refused: outside_area}\n"
      "  - {by: 25, robot: r1, near: [0, 0, 0.4]}\n"
      "  - {at: 26.5, by_operator: op1, refused: outside_area}\n"
      "  - {by: 35, robot: r1, near: [4.4, 0, 0.4]}\n"
      "  - {at: 36.5, by_operator: op1, refused: outside_area}\n"
      "  - {by: 47, robot: r1, near: [9, 0, 0.5]}\n",
      "areas.yaml");
  for (const std::string& line : report.complaints()) ADD_FAILURE() << line;
}

}  // namespace
}  // namespace adit::sim
