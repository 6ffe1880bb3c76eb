// SPDX-License-Identifier: Apache-2.0
// The global planner in the agent: out of dead ends, round places that turn out blocked, and with a report of
// goals that cannot be reached.
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

RunReport run(const std::string& boxes, int duration, const std::string& script,
              const std::string& rest = "") {
  return run_text(
      "world: {boxes: [" + boxes + "], floor: 0, ceiling: 3}\nduration: " + std::to_string(duration) +
          "\nlink: wifi\nlidar: planar\nrobots:\n  - {id: r1, platform: wheeled, pose: [0, 0, 0]}\n"
          "basestations:\n  - {id: op1, pose: [0, 0]}\nscript:\n  - {at: 2, by: op1, do: take r1}\n" +
          script + rest,
      "route.yaml");
}
// A pocket that is open behind the robot, and walls around it all.
constexpr const char* kPocket =
    "[4, 4.3, -3, 3, 0, 2], [-3, 4.3, 3, 3.3, 0, 2], [-3, 4.3, -3.3, -3, 0, 2], "
    "[-9, 13, -8, -7.7, 0, 2], [-9, 13, 7.7, 8, 0, 2], [-9, -8.7, -8, 8, 0, 2], [12.7, 13, -8, 8, 0, 2]";

TEST(Route, LeavesADeadEnd) {
  expect_ok(run(kPocket, 60, "  - {at: 3, by: op1, do: goto r1 8 0}\n",
                "expect:\n  - {by: 55, robot: r1, near: [8, 0, 0.5]}\n  - {always: no_collision}\n"));
}

TEST(Route, AHungRouterIsMadeAnewOnTheWayAndLeadsOutAllTheSame) {
  expect_ok(run(kPocket, 70, "  - {at: 3, by: op1, do: goto r1 8 0}\n",
                "faults:\n  - {at: 6, hang: r1/router}\n  - {at: 15, crash: r1/router}\n"
                "expect:\n  - {by: 65, robot: r1, near: [8, 0, 0.5]}\n  - {always: no_collision}\n"));
}

TEST(Route, ClosedRoomIsReportedUnreachableWithinTenSeconds) {
  const RunReport report = run(
      "[-9, 13, -8, -7.7, 0, 2], [-9, 13, 7.7, 8, 0, 2], [-9, -8.7, -8, 8, 0, 2], [12.7, 13, -8, 8, 0, 2]",
      20, "  - {at: 3, by: op1, do: goto r1 20 0}\n",
      "expect:\n  - {at: 13, robot: r1, mode: waypoint}\n  - {always: no_collision}\n");
  expect_ok(report);
  bool reported = false;
  for (const TimedEvent& event : report.events)
    reported = reported || (event.text == "no way to its goal" && event.at < 13s);
  EXPECT_TRUE(reported);
}

}  // namespace
}  // namespace adit::sim
