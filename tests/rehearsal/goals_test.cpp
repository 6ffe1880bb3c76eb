// SPDX-License-Identifier: Apache-2.0
// What operators read about goals that a robot cannot reach, and what the robot then does.
#include <algorithm>

#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

struct GoalsRun {
  RunReport report{};
  std::vector<TimedEvent> notices{};  ///< Notifications by their codes.
  std::vector<Pose2> trail{};         ///< True poses of r1, every 0.1 s.

  /// When an operator was first notified of it; nothing: never.
  std::optional<Duration> notified(const std::string& robot, const std::string& code) const {
    const auto it = std::find_if(notices.begin(), notices.end(), [&](const TimedEvent& notice) {
      return notice.robot == robot && notice.text == code;
    });
    return it == notices.end() ? std::nullopt : std::optional(it->at);
  }
  /// Metres that r1 drove between two times.
  double driven(Duration from, Duration to) const {
    double metres = 0;
    for (std::size_t i = 1; i < trail.size(); ++i)
      if (const auto at = Trail::kPeriod * i; at > from && at <= to)
        metres += (trail[i].position() - trail[i - 1].position()).norm();
    return metres;
  }
};

/// Runs a scenario, with `decided` no longer than until its expectations are settled.
GoalsRun run_goals(const std::string& yaml, bool decided = false) {
  GoalsRun run;
  const auto scenario = parse_scenario(yaml, "goals.yaml");
  EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().text);
  if (!scenario) return run;
  RunParams params;
  params.make_agent = make_agent_factory("").value();
  params.seed = scenario->seed;
  params.ended = [&run, once = decided ? once_decided() : nullptr](const RunState& state) {
    run.notices = state.witness.notifications();
    return once && once(state);
  };
  auto outcome = rehearse(*scenario, *make_world(scenario->world), params);
  EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
  if (!outcome) return run;
  run.report = outcome->report;
  run.trail = outcome->trails.at("r1").poses;
  for (const std::string& line : run.report.complaints()) ADD_FAILURE() << line;
  if (testing::Test::HasFailure())
    for (const TimedEvent& notice : run.notices)
      std::printf("%6.1f %s %s\n", seconds(notice.at), notice.robot.c_str(), notice.text.c_str());
  return run;
}

/// A room with a wall from its lower side, behind which a block stands; one planar robot.
std::string behind_a_wall(const std::string& rest) {
  return "world: {boxes: [[3, 3.2, -8, 1, 0, 2], [6, 6.3, -4.2, -3.8, 0, 1], [-3, 12, -8.2, -8, 0, 2], "
         "[-3, 12, 4, 4.2, 0, 2], [12, 12.2, -8, 4, 0, 2], [-3.2, -3, -8, 4, 0, 2]], floor: 0, ceiling: 3}\n"
         "link: wifi\nlidar: planar\nrobots:\n  - {id: r1, platform: wheeled, pose: [0, 0, 0]}\n"
         "basestations:\n  - {id: op1, pose: [0, 0]}\n" +
         rest;
}

TEST(Goals, EachReasonIsAnsweredAtOnceAndNothingMoves) {
  // A floor of blocks with a pit; a table, a gap of 0.4 m, and a closed room on the right.
  const GoalsRun run = run_goals(
      "world:\n  boxes: [[-6, 3, -6, 6, -1, 0], [3, 8, -2, 6, -1, 0], [3, 8, -6, -4, -1, 0], "
      "[8, 16, -6, 6, -1, 0], [-6, 16, 6, 6.2, 0, 2], [-6, 16, -6.2, -6, 0, 2], [-6.2, -6, -6.2, 6.2, 0, 2], "
      "[8, 8.2, -6, 6, 0, 2], [16, 16.2, -6.2, 6.2, 0, 2], [3, 3.6, 1.2, 1.8, 0, 1], "
      "[-3, -2, 1.2, 2, 0, 1], [-3, -2, 0.4, 0.8, 0, 1]]\n  floor: -1\n  ceiling: 3\nduration: 7\nlink: "
      "wifi\nlidar: full\nrobots:\n"
      "  - {id: r1, platform: wheeled, pose: [1, 1.5, 0]}\n"
      "  - {id: r2, platform: wheeled, pose: [1, -3, 0]}\n"
      "  - {id: r3, platform: wheeled, pose: [-0.5, 1, 3.14]}\n"
      "  - {id: r5, platform: wheeled, pose: [11, 0, 0]}\n"
      "basestations:\n  - {id: op1, pose: [0, 0]}\nscript:\n"
      "  - {at: 1.6, by: op1, do: take r1}\n  - {at: 1.7, by: op1, do: take r2}\n"
      "  - {at: 1.8, by: op1, do: take r3}\n  - {at: 2, by: op1, do: take r5}\n"
      "  - {at: 3, by: op1, do: goto r1 3.2 1.5}\n  - {at: 3.5, by: op1, do: goto r2 3.2 -3}\n"
      "  - {at: 4, by: op1, do: goto r3 -2.5 1}\n"
      "  - {at: 5, by: op1, do: goto r5 20 0}\n  - {at: 5.5, by: op1, do: plan r1 3.2 1.5}\nexpect:\n"
      "  - {at: 3.4, by_operator: op1, refused: goal_occupied}\n"
      "  - {at: 3.9, by_operator: op1, refused: goal_no_floor}\n"
      "  - {at: 4.4, by_operator: op1, refused: goal_too_narrow}\n"
      "  - {at: 5.4, by_operator: op1, refused: goal_not_connected}\n"
      "  - {at: 5.9, by_operator: op1, refused: goal_occupied}\n  - {always: no_collision}\n");
  for (const auto& [robot, result] : run.report.robots) EXPECT_EQ(result.distance, 0.0) << robot;
}

TEST(Goals, StepsAreTooSteep) {
  // Sixteen steps of 0.05 m, 0.1 m deep: none is too high, and all together are too steep.
  std::string steps;
  for (int i = 0; i < 16; ++i)
    steps += (i ? ", [" : "[") + std::to_string(-2.9 - 0.1 * i) + ", " + std::to_string(-2.8 - 0.1 * i) +
             ", -6, -3, 0, " + std::to_string(0.05 + 0.05 * i) + "]";
  const GoalsRun run =
      run_goals("world: {boxes: [" + steps +
                ", [-6.2, -6, -7, 7, 0, 2]], floor: 0, ceiling: 3}\nduration: 7\nlink: wifi\nlidar: full\n"
                "robots:\n  - {id: r1, platform: wheeled, pose: [-1, -4.5, 3.14]}\n"
                "basestations:\n  - {id: op1, pose: [0, 0]}\nscript:\n  - {at: 2, by: op1, do: take r1}\n"
                "  - {at: 4, by: op1, do: goto r1 -3.4 -4.5}\nexpect:\n"
                "  - {at: 4.9, by_operator: op1, refused: goal_too_steep}\n  - {always: no_collision}\n");
  EXPECT_EQ(run.driven(0s, 7s), 0.0);
}

TEST(Goals, AnUnseenGoalHasABudgetAndIsJudgedOnceItIsSeen) {
  const GoalsRun run = run_goals(behind_a_wall(
      "duration: 40\nscript:\n  - {at: 2, by: op1, do: take r1}\n"
      "  - {at: 3, by: op1, do: goto r1 6.1 -4 --budget 2}\n  - {at: 12, by: op1, do: mode r1 waypoint}\n"
      "  - {at: 22, by: op1, do: goto r1 6.1 -4 --budget none}\n"
      "expect:\n  - {at: 3.5, by_operator: op1, refused: none}\n  - {at: 39, robot: r1, mode: waypoint}\n"
      "  - {always: no_collision}\n"));
  EXPECT_TRUE(run.notified("r1", "goal_unseen"));
  const auto used_up = run.notified("r1", "unknown_budget");
  ASSERT_TRUE(used_up);
  EXPECT_LT(*used_up, 12s);
  EXPECT_NEAR(run.driven(0s, 12s), 1.9, 0.4);
  EXPECT_EQ(run.driven(10s, 12s), 0.0);
  EXPECT_GT(run.driven(12s, 20s), 1.0) << "mode waypoint renews the budget";
  // Whether it was seen on the way or only at its end, a block stands at the goal. From 6 m away, where the
  // heading's errors move the rays past its corners, it looks like a gap.
  const auto& reasons = run.report.commands.reasons;
  EXPECT_TRUE(run.notified("r1", "unreachable") || reasons.contains("goal_occupied") ||
              reasons.contains("goal_too_narrow"));
  EXPECT_EQ(run.driven(36s, 40s), 0.0);
}

TEST(Goals, TheNearestPlaceReplacesAGoalAndARobotThatCannotMoveIsStuck) {
  const GoalsRun run = run_goals(
      "world: {boxes: [[4, 4.4, -1, 1, 0, 1]], floor: 0, ceiling: 3}\nduration: 70\nlink: wifi\n"
      "lidar: planar\nrobots:\n  - {id: r1, platform: wheeled, pose: [0, 0, 0]}\n"
      "basestations:\n  - {id: op1, pose: [0, 0]}\nscript:\n  - {at: 2, by: op1, do: take r1}\n"
      "  - {at: 3, by: op1, do: goto r1 4.1 0.2 --nearest}\n  - {at: 15, by: op1, do: goto r1 0 0}\n"
      "faults:\n  - {at: 15, stuck: r1, for: 60}\n"
      "expect:\n  - {by: 14, robot: r1, near: [3.65, 0.2, 0.35]}\n  - {always: no_collision}\n");
  EXPECT_TRUE(run.notified("r1", "goal_moved"));
  const auto stuck = run.notified("r1", "stuck");
  ASSERT_TRUE(stuck);
  EXPECT_NEAR(seconds(*stuck), 60, 2);
}

TEST(Goals, ARobotThatStartsNearlyInContactLeavesOrNamesIt) {
  // Without errors of sensors, as centimetres decide. r1 stands 4 cm beside a wall; r2 2 cm, where the
  // collision monitor holds it; r3 has 5 cm on both sides and a wall before it; r4 has 5 cm on three sides
  // and 0.6 m to its right, where it cannot turn to.
  const GoalsRun run = run_goals(
      "world: {boxes: [[-1, 1, 0.30, 0.4, 0, 1], [-1, 1, 10.3, 10.4, 0, 1], [-1, 1, 20.3, 20.4, 0, 1], "
      "[-1, 1, 19.6, 19.7, 0, 1], [0.4, 0.5, 19.6, 20.4, 0, 1], [-1, 1, 30.3, 30.4, 0, 1], "
      "[0.35, 0.45, 29.4, 30.4, 0, 1], [-0.45, -0.35, 29.4, 30.4, 0, 1]], "
      "floor: 0, ceiling: 3}\nduration: 25\nlink: wifi\nlidar: full\nrobots:\n"
      "  - {id: r1, platform: wheeled, pose: [0, 0.01, 0]}\n"
      "  - {id: r2, platform: wheeled, pose: [0, 10.03, 0]}\n"
      "  - {id: r3, platform: wheeled, pose: [0.05, 20, 0]}\n"
      "  - {id: r4, platform: wheeled, pose: [0, 30, 0]}\n"
      "basestations:\n  - {id: op1, pose: [0, 15]}\nscript:\n"
      "  - {at: 1.6, by: op1, do: take r1}\n  - {at: 1.7, by: op1, do: take r2}\n"
      "  - {at: 1.8, by: op1, do: take r3}\n  - {at: 1.9, by: op1, do: take r4}\n"
      "  - {at: 3, by: op1, do: goto r1 -3 1}\n  - {at: 3, by: op1, do: goto r2 -3 9.5}\n"
      "  - {at: 3, by: op1, do: goto r3 -3 19}\n  - {at: 3, by: op1, do: goto r4 0 28}\nexpect:\n"
      "  - {by: 25, robot: r1, near: [-3, 1, 0.5]}\n"
      "  - {by: 25, robot: r3, near: [-3, 19, 0.5]}\n  - {always: no_collision}\n",
      true);
  EXPECT_TRUE(run.notified("r2", "start_in_collision"));
  EXPECT_TRUE(run.notified("r4", "start_in_collision"));
}

TEST(Goals, ARobotWaitsForOneInADoorAndReportsIt) {
  // r2 stands in the only door for a minute. r1 stops before it, instead of driving to and fro.
  const GoalsRun run = run_goals(
      "world: {boxes: [[-6, 14, 4, 4.3, 0, 3], [-6, 14, -4.3, -4, 0, 3], [-6.3, -6, -4.3, 4.3, 0, 3], "
      "[14, 14.3, -4.3, 4.3, 0, 3], [5, 5.3, 0.5, 4, 0, 3], [5, 5.3, -4, -0.5, 0, 3]], floor: 0, ceiling: "
      "3}\n"
      "duration: 50\nseed: 2\nlink: wifi\nrobots:\n  - {id: r1, platform: wheeled, pose: [0, 0, 0]}\n"
      "  - {id: r2, platform: wheeled, pose: [5.1, 0, 1.57]}\n"
      "basestations:\n  - {id: op1, pose: [0, 1]}\nscript:\n  - {at: 2, by: op1, do: take r1 r2}\n"
      "  - {at: 3, by: op1, do: goto r1 9 0}\nexpect:\n  - {always: no_collision}\n");
  ASSERT_TRUE(run.notified("r1", "blocked"));
  EXPECT_LT(*run.notified("r1", "blocked"), 15s);
  EXPECT_LT(run.driven(0s, 50s), 9.0);
}

}  // namespace
}  // namespace adit::sim
