// SPDX-License-Identifier: Apache-2.0
// Trees that contradict the mode table, in rehearsal with the check at load switched off: no rule is broken,
// because the guard in front of the mux enforces the table. ADIT_HOSTILE_SEEDS: seeds for each tree, 1 unless
// given.
#include "tests/rehearsal/hostile_trees.hpp"

#include <cstdlib>

#include "robot_agent/agent.hpp"
#include "robot_agent/behaviour/decider.hpp"
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

constexpr const char* kChaos = R"(world:
  boxes:
    - [-6, 6, 6, 6.3, 0, 2.5]
    - [-6, 6, -6.3, -6, 0, 2.5]
    - [-6.3, -6, -6.3, 6.3, 0, 2.5]
    - [6, 6.3, -6.3, 6.3, 0, 2.5]
  floor: 0
  ceiling: 3
duration: 20
link: {name: mine, bandwidth: 2e6, latency: 0.03, loss: 0.1}
lidar: planar
lock_lease: 8
robots:
  - {id: r1, platform: wheeled, pose: [0, 0, 0]}
basestations:
  - {id: op1, pose: [-5, 3]}
  - {id: op2, pose: [-5, -3]}
script:
  - {at: 2, by: op1, do: take r1}
  - {at: 2.5, by: op1, do: goto r1 4 0}
  - {at: 4, by: op1, do: stop r1}
  - {at: 5, by: op1, do: reset r1}
  - {at: 5.5, by: op1, do: drive r1 0.5 0 0 --for 3}
  - {at: 6.5, by: op2, do: stop r1}
  - {at: 7.5, by: op1, do: reset r1 --override}
random_script:
  commands: 30
  from: 8
  to: 19
  verbs: [take, grant, release, goto, goto, drive, drive, drive, stop, reset, reset, mode, mode]
  reach: 4
random_faults:
  faults: 4
  from: 3
  to: 18
  kinds: [crash, cut, degrade, reorder, duplicate, clock_jump, sensor_silent, stuck_stick, crash_component, hang]
)";

std::uint64_t hostile_seeds() {
  const char* given = std::getenv("ADIT_HOSTILE_SEEDS");
  return given ? std::strtoull(given, nullptr, 10) : 1;
}

class HostileTreeRun : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Trees, HostileTreeRun, testing::ValuesIn(hostile_trees()),
                         [](const auto& each) { return tree_name(each.param); });

TEST_P(HostileTreeRun, BreaksNoRule) {
  const auto scenario = parse_scenario(kChaos, "chaos.yaml");
  ASSERT_TRUE(scenario.ok()) << scenario.error().text;
  const auto world = *make_world(scenario->world);
  RunParams params;
  params.workers = 1;
  params.make_agent = *make_agent_factory({}, [](agent::AgentParams& agent) {
    agent.tree = GetParam();
    agent.load_tree = [](const std::string& file) { return agent::Decider::load_unchecked(file); };
  });
  for (params.seed = 1; params.seed <= hostile_seeds(); ++params.seed) {
    const auto outcome = rehearse(*scenario, world, params);
    ASSERT_TRUE(outcome.ok()) << outcome.error().text;
    for (const std::string& line : outcome->report.complaints())
      ADD_FAILURE() << "seed " << params.seed << ": " << line;
    EXPECT_GE(outcome->report.commands.sent, 20U);
  }
}

// A user's tree that lists the conditions of the modes runs as the shipped one, byte for byte.
TEST(TreeByConditions, GivesTheDigestOfTheShippedTree) {
  const auto scenario = parse_scenario(kChaos, "chaos.yaml");
  ASSERT_TRUE(scenario.ok()) << scenario.error().text;
  const auto world = *make_world(scenario->world);
  const auto run_with = [&](const std::string& tree) {
    RunParams params;
    params.workers = 1;
    params.make_agent =
        *make_agent_factory({}, [&](agent::AgentParams& agent) { agent.tree = source_folder() + tree; });
    const auto outcome = rehearse(*scenario, world, params);
    EXPECT_TRUE(outcome.ok()) << outcome.error().text;
    return outcome->report;
  };
  const RunReport shipped = run_with("/config/trees/robot.xml");
  EXPECT_GT(shipped.robots.at("r1").distance, 1.0);
  EXPECT_EQ(run_with("/tests/agent/robot_by_conditions.xml").digest, shipped.digest);
  EXPECT_NE(run_with("/tests/rehearsal/hostile_trees/without_not_stopped.xml").digest, shipped.digest);
}

}  // namespace
}  // namespace adit::sim
