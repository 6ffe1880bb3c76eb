// SPDX-License-Identifier: Apache-2.0
// What a robot does, and reports, that is blocked on its way through a door between two rooms.
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

/// r1 is sent from one room to the other, through a door 1 m wide. `rest`: more of the scenario.
RunReport run_door(const std::string& robots, const std::string& rest, std::uint64_t seed) {
  return run_text(
      "world: {boxes: [[-6, 14, 4, 4.3, 0, 3], [-6, 14, -4.3, -4, 0, 3], [-6.3, -6, -4.3, 4.3, 0, 3], "
      "[14, 14.3, -4.3, 4.3, 0, 3], [5, 5.3, 0.5, 4, 0, 3], [5, 5.3, -4, -0.5, 0, 3]], floor: 0, ceiling: "
      "3}\n"
      "seed: " +
          std::to_string(seed) +
          "\nlink: wifi\nlidar: planar\nrobots:\n  - {id: r1, platform: wheeled, "
          "pose: [0, 0, 0]}\n" +
          robots +
          "basestations:\n  - {id: op1, pose: [0, 0]}\nscript:\n  - {at: 2, by: op1, do: take r1}\n"
          "  - {at: 3, by: op1, do: goto r1 9 0}\n" +
          rest + "  - {always: no_collision}\n",
      "blocked.yaml");
}

void expect_no_complaints(const RunReport& report, std::uint64_t seed) {
  for (const std::string& line : report.complaints()) ADD_FAILURE() << "seed " << seed << ": " << line;
}

TEST(Blocked, SomebodyInTheOnlyDoorIsReportedWaitedForAndThenPassed) {
  for (std::uint64_t seed = 1; seed <= seeds(1, 20); ++seed) {
    const RunReport report = run_door(
        "",
        "duration: 90\nfaults:\n  - {at: 4, close: [4.9, 5.35, -0.22, 0.22, 0, 1.75], for: 60}\n"
        "expect:\n  - {by: 10, robot: r1, told: goal_unreachable}\n"
        "  - {from: 11, to: 63, robot: r1, still: 0.3}\n  - {by: 80, robot: r1, near: [9, 0, 0.5]}\n",
        seed);
    expect_no_complaints(report, seed);
    EXPECT_LT(report.robots.at("r1").distance, 10.0) << "never a metre at the wall";
  }
}

TEST(Blocked, AnotherRobotInTheDoorIsReportedAndWaitedFor) {
  for (std::uint64_t seed = 1; seed <= seeds(1, 20); ++seed) {
    const RunReport report =
        run_door("  - {id: r2, platform: wheeled, pose: [5.1, 0, 0]}\n",
                 "  - {at: 40, by: op1, do: take r2}\n  - {at: 41, by: op1, do: goto r2 9 -2}\n"
                 "duration: 65\nexpect:\n  - {by: 11, robot: r1, told: blocked}\n"
                 "  - {from: 14, to: 40, robot: r1, still: 1}\n  - {by: 62, robot: r1, near: [9, 0, 0.5]}\n",
                 seed);
    expect_no_complaints(report, seed);
    EXPECT_LT(report.robots.at("r1").distance, 13.0);
  }
}

TEST(Blocked, ARouterThatRestartsAtAShutDoorChangesNothing) {
  const RunReport report =
      run_door("",
               "duration: 60\nfaults:\n  - {at: 4, close: [5.05, 5.25, -0.55, 0.55, 0, 2], for: 30}\n"
               "  - {at: 12, crash: r1/router}\nexpect:\n  - {by: 10, robot: r1, told: goal_unreachable}\n"
               "  - {from: 11, to: 34, robot: r1, still: 0.5}\n  - {by: 55, robot: r1, near: [9, 0, 0.5]}\n",
               1);
  expect_no_complaints(report, 1);
  EXPECT_LT(report.robots.at("r1").distance, 11.0);
}

TEST(Blocked, AnAreaThatIsAddedOnTheRobotDoesNotHoldItForEver) {
  const RunReport report = run_door("",
                                    "  - {at: 4.5, by: op1, do: area r1 add wet keep_out 1 -1 3 -1 3 1 1 1}\n"
                                    "  - {at: 20, by: op1, do: area r1 remove wet}\n"
                                    "duration: 40\nexpect:\n  - {by: 38, robot: r1, near: [9, 0, 0.5]}\n",
                                    1);
  expect_no_complaints(report, 1);
}

}  // namespace
}  // namespace adit::sim
