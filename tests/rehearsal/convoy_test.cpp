// SPDX-License-Identifier: Apache-2.0
// Convoys of whole agents: they follow, stop, peel off, refuse, and survive restarts and changes of holder.
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

/// Three robots in a row in a wide corridor; planar lidars.
std::string in_a_row(const std::string& rest) {
  return "world: {boxes: [[-8, 40, 3, 3.3, 0, 3], [-8, 40, -3.3, -3, 0, 3]], floor: 0, ceiling: 3}\n"
         "link: mesh_500k\nlidar: planar\nrobots:\n"
         "  - {id: r1, platform: wheeled, pose: [2.4, 0, 0]}\n"
         "  - {id: r2, platform: wheeled, pose: [0, 0, 0]}\n"
         "  - {id: r3, platform: wheeled, pose: [-2.4, 0, 0]}\n"
         "basestations:\n  - {id: op1, pose: [0, 2]}\n  - {id: op2, pose: [0, -2]}\n" +
         rest;
}

void holds(const RunReport& report) {
  for (const std::string& line : report.complaints()) ADD_FAILURE() << line;
}

/// A scenario of config/scenarios, with a planar lidar unless all_seeds().
Scenario load_planar(const std::string& file) {
  Scenario scenario = load_shipped(file);
  if (!all_seeds()) scenario.lidar = LidarKind::planar;
  return scenario;
}

class ConvoyScenarios : public testing::TestWithParam<const char*> {};

TEST_P(ConvoyScenarios, Hold) {
  if (GetParam() == std::string("convoy_cut") && !all_seeds())
    GTEST_SKIP()
        << "long: set ADIT_ALL_SEEDS; Convoy.ACutLinkHoldsThoseBehindItUntilItHeals is the short one";
  const Scenario scenario = load_planar(std::string(GetParam()) + ".yaml");
  RunParams params;
  params.make_agent = *make_agent_factory("");
  params.seed = scenario.seed;
  params.ended = once_decided();
  const auto outcome = rehearse(scenario, *make_world(scenario.world), params);
  ASSERT_TRUE(outcome.ok()) << outcome.error().text;
  holds(outcome->report);
}

INSTANTIATE_TEST_SUITE_P(Config, ConvoyScenarios, testing::Values("convoy_two", "convoy_peel", "convoy_cut"),
                         [](const auto& which) { return std::string(which.param); });

TEST(RightOfWay, ARobotClearsACorridorOnceItsHolderAllowsIt) {
  const Scenario scenario = load_planar("yield_pocket.yaml");
  RunParams params;
  params.make_agent = *make_agent_factory("");
  params.seed = 1;
  params.ended = once_decided();
  const auto outcome = rehearse(scenario, *make_world(scenario.world), params);
  ASSERT_TRUE(outcome.ok()) << outcome.error().text;
  holds(outcome->report);
}

TEST(Convoy, IsAllOrNone) {
  holds(run_text(in_a_row(R"(duration: 14
script:
  - {at: 1, by: op1, do: take r1 r2}
  - {at: 1, by: op2, do: take r3}
  - {at: 2, by: op1, do: convoy start r1 r2 r3}        # r3 is op2's
  - {at: 4, by: op2, do: stop r2}
  - {at: 5, by: op1, do: convoy start r1 r2}           # r2 is stopped
  - {at: 7, by: op1, do: reset r2 --override}
  - {at: 8, by: op1, do: mode r2 convoy_follow}        # no place was kept
  - {at: 9, by: op1, do: goto r1 8 0}
expect:
  - {at: 3.5, by_operator: op1, refused: not_holder}
  - {at: 3.5, robot: r2, mode: hold}
  - {at: 6.5, by_operator: op1, refused: stopped}
  - {at: 8.5, by_operator: op1, refused: not_in_convoy}
  - {from: 2, to: 14, robot: r2, still: 0.05}
  - {from: 2, to: 14, robot: r3, still: 0.05}
  - {always: no_collision}
)"),
                 "all_or_none.yaml"));
}

TEST(Convoy, AFollowerKeepsItsPlaceOverARestartAndLosesItWithItsHolder) {
  holds(run_text(in_a_row(R"(duration: 50
script:
  - {at: 1, by: op1, do: take r1 r2 r3}
  - {at: 2, by: op1, do: convoy start r1 r2 r3 --speed 0.6}
  - {at: 3, by: op1, do: goto r1 24 0}
  - {at: 28, by: op2, do: take r3}
faults: [{at: 12, crash: r2}]
expect:
  - {at: 20, robot: r2, mode: convoy_follow}
  - {at: 20, convoy: r1, order: [r1, r2, r3]}
  - {from: 8, to: 28, gap: [r1, r2], between: [0.5, 7]}
  - {at: 29, robot: r3, mode: hold, holder: op2}
  - {from: 29.5, to: 50, robot: r3, still: 0.3}
  - {by: 34, convoy: r1, order: [r1, r2]}
  - {by: 48, robot: r1, near: [24, 0, 0.6]}
  - {by: 50, robot: r2, near: [21.9, -0.4, 1.0]}
  - {always: no_collision}
)"),
                 "restart.yaml"));
}

TEST(Convoy, ACutLinkHoldsThoseBehindItUntilItHeals) {
  holds(run_text(in_a_row(R"(duration: 75
script:
  - {at: 1, by: op1, do: take r1 r2 r3}
  - {at: 2, by: op1, do: convoy start r1 r2 r3 --speed 0.6}
  - {at: 3, by: op1, do: goto r1 24 0}
faults: [{at: 12, partition: [[r1, r2], [r3, op1, op2]], for: 25}]
expect:
  - {from: 27, to: 36, robot: r3, still: 0.1}
  - {at: 36, robot: r3, mode: convoy_follow}
  - {by: 40, by_operator: op1, notified: convoy_lost, robot: r3}
  - {by: 74, robot: r3, near: [19.8, 0, 1.2]}
  - {always: no_collision}
)"),
                 "cut.yaml"));
}

TEST(Convoy, FollowerWithoutContactReportsItAndComesLater) {
  holds(run_text(in_a_row(R"(duration: 50
script:
  - {at: 1, by: op1, do: take r1 r2}
  - {at: 3, by: op1, do: convoy start r1 r2 --speed 0.6}
  - {at: 22, by: op1, do: goto r1 14 0}
faults: [{at: 1.5, cut: [r1, r2], for: 18}]
expect:
  - {at: 5, robot: r2, mode: convoy_follow}
  - {from: 3, to: 20, robot: r2, still: 0.05}
  - {by: 16, by_operator: op1, notified: convoy_waits, robot: r2}
  - {by: 48, robot: r2, near: [11.9, 0, 1.0]}
  - {always: no_collision}
)"),
                 "unheard.yaml"));
}

// The leader is narrower than the gap in the wall, and its follower is not; the way round is 20 m longer.
TEST(Convoy, AFollowerDoesNotLeaveThePathForALongWayRound) {
  holds(run_text(R"(
world:
  boxes: [[-4, 20, 6, 6.3, 0, 3], [-4, 20, -3.3, -3, 0, 3], [-4.3, -4, -3.3, 6.3, 0, 3], [20, 20.3, -3.3, 6.3, 0, 3],
          [6, 6.3, 0.31, 4.5, 0, 3], [6, 6.3, -3, -0.31, 0, 3]]
  floor: 0
  ceiling: 3
odometry: {noise: 0}
duration: 65
link: wifi
lidar: planar
robots:
  - {id: r1, platform: legged, pose: [2, 0, 0]}
  - {id: r2, platform: tracked, pose: [-0.4, 0, 0]}
basestations: [{id: op1, pose: [0, 2]}]
script:
  - {at: 1, by: op1, do: take r1 r2}
  - {at: 3, by: op1, do: convoy start r1 r2}
  - {at: 5, by: op1, do: goto r1 14 0}
expect:
  - {by: 58, robot: r1, near: [14, 0, 0.6]}
  - {by: 55, by_operator: op1, notified: trail_impassable, robot: r2}
  - {at: 64, robot: r2, near: [4.5, 0, 1.8], mode: convoy_follow}
  - {always: no_collision}
)",
                 "narrow.yaml"));
}

}  // namespace
}  // namespace adit::sim
