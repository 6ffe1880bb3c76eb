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

// Four smooth level corridors, 80 m and 60 m long and 2.6 m wide. Heights that scans saw wrong by half a
// degree made steps in the middle of a corridor, and the robot turned back to drive all the way round.
std::string ring(const std::string& perception, int seed, bool all_round) {
  std::string text =
      "world:\n  boxes: [[-1.6, 81.6, -1.6, -1.3, 0, 3], [-1.6, 81.6, 61.3, 61.6, 0, 3], [-1.6, -1.3, -1.6, "
      "61.6, 0, "
      "3], [81.3, 81.6, -1.6, 61.6, 0, 3], [1.3, 78.7, 1.3, 1.6, 0, 3], [1.3, 78.7, 58.4, 58.7, 0, 3], [1.3, "
      "1.6, "
      "1.3, 58.7, 0, 3], [78.4, 78.7, 1.3, 58.7, 0, 3]]\n  floor: 0\n  ceiling: 3\nlink: wifi\n"
      "robots: [{id: r1, platform: wheeled, pose: [0, 0, 0]}]\nbasestations: [{id: op1, pose: [0, 0]}]\n"
      "seed: " +
      std::to_string(seed) + "\nperception: " + perception + "\nduration: " + (all_round ? "330" : "56") +
      "\nscript:\n"
      "  - {at: 2, by: op1, do: take r1}\n  - {at: 3, by: op1, do: goto r1 79.7 0 --budget none}\n";
  if (all_round)
    text +=
        "  - {at: 58, by: op1, do: goto r1 80 59.7 --budget none}\n"
        "  - {at: 102, by: op1, do: goto r1 0.3 60 --budget none}\n"
        "  - {at: 156, by: op1, do: goto r1 0 0.4 --budget none}\n"
        "  - {at: 264, by: op1, do: goto r1 79.7 0 --budget none}\n";
  // Without an odometry of its own the robot is where its wheels say, up to 3 m off after a round.
  text += "expect:\n  - {always: no_collision}\n  - {by: 54, robot: r1, near: [79.7, 0, 3]}\n";
  if (all_round)
    text +=
        "  - {by: 98, robot: r1, near: [80, 59.7, 3]}\n  - {by: 152, robot: r1, near: [0.3, 60, 3]}\n"
        "  - {by: 200, robot: r1, near: [0, 0.4, 3]}\n  - {by: 320, robot: r1, near: [79.7, 0, 3]}\n";
  return text;
}

TEST(Route, ALevelCorridorHasNoSteps) {
  for (const std::string perception : {"slam", "odometry", "off"})
    for (int seed = 1; seed <= 20; ++seed) {
      if (!all_seeds() && !(perception == "slam" && seed == 7) && !(perception == "off" && seed == 8))
        continue;
      SCOPED_TRACE(perception + " " + std::to_string(seed));
      expect_ok(run_text(ring(perception, seed, all_seeds()), "ring.yaml"));
    }
}

}  // namespace
}  // namespace adit::sim
