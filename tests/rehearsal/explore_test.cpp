// SPDX-License-Identifier: Apache-2.0
// Exploration by a whole agent, with all errors of sensors and odometry.
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

TEST(Explore, SeesAllThatCanBeReachedAlthoughItsAgentDies) {
  const RunReport report = run_text(
      "world: {generate: blocks, size: 2}\nduration: 116\nlink: wifi\n"
      "robots: [{id: r1, platform: wheeled, pose: [1.6, 1.6, 0]}]\n"
      "basestations: [{id: op1, pose: [1.6, 1.6]}]\n"
      "script: [{at: 1, by: op1, do: take r1}, {at: 2, by: op1, do: explore r1 --after wait}]\n"
      "faults: [{at: 20, crash: r1}]\n"
      "expect:\n"
      "  - {by: 5, robot: r1, explore: exploring}\n"
      "  - {at: 30, robot: r1, explore: exploring, mode: explore}\n"
      "  - {by: 100, explored_at_least: 0.97}\n"
      "  - {at: 100, repeat_at_most: 0.35}\n"
      "  - {by: 115, robot: r1, explore: done}\n"
      "  - {at: 115.5, robot: r1, explore: done, mode: hold}\n"
      "  - {always: no_collision}\n",
      "explore.yaml");
  for (const std::string& line : report.complaints()) ADD_FAILURE() << line;
  ASSERT_TRUE(report.exploration);
  EXPECT_GT(report.exploration->share, 0.97) << "done is never said too early";
}

}  // namespace
}  // namespace adit::sim
