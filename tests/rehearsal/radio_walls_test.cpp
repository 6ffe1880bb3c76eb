// SPDX-License-Identifier: Apache-2.0
// Walls between the machines of a rehearsal: what they take from the radio, and a robot that is lost behind
// one.
#include "sim/rehearsal/radio_walls.hpp"

#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

TEST(RadioWalls, TakeSoMuchAMetreBothWaysAndNotMoreThanMatters) {
  const World world = *make_box_world(std::vector<Box>{{4, 6, -5, 5, 0, 3}, {20, 90, -5, 5, 0, 3}}, 0.0, 3.0);
  RadioWalls walls(world, 10.0);
  EXPECT_EQ(walls({0, 0, 0}, {3, 0, 0}), 0.0);
  EXPECT_NEAR(walls({0, 0, 0}, {8, 0, 0}), 20.0, 1e-9);
  EXPECT_EQ(walls({8, 0, 0}, {0, 0, 0}), walls({0, 0, 0}, {8, 0, 0}));
  EXPECT_EQ(walls({0, 0, 0}, {95, 0, 0}), RadioWalls::kMaxAttenuation);
}

TEST(RadioWalls, StaysCorrectWhenItsCacheIsCleared) {
  const World world = *make_box_world(std::vector<Box>{{4, 6, -5, 5, 0, 3}}, 0.0, 3.0);
  RadioWalls walls(world, 10.0);
  for (int i = 0; i < 5000; ++i) (void)walls({0, 0, 0}, {8.0 + 0.3 * (i % 70), 0.3 * (i / 70), 0});
  EXPECT_NEAR(walls({0, 0, 0}, {8, 0, 0}), 20.0, 1e-9);
}

Scenario pillar() { return load_shipped("behind_the_wall.yaml"); }

RunReport run(const Scenario& scenario) {
  RunParams params;
  params.make_agent = *make_agent_factory();
  auto outcome = rehearse(scenario, *make_world(scenario.world), params);
  EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
  return outcome->report;
}

TEST(RadioWalls, ARobotIsLostBehindAPillarAndBackInSight) {
  const RunReport report = run(pillar());
  EXPECT_TRUE(report.ok()) << (report.complaints().empty() ? "" : report.complaints().front());
}

TEST(RadioWalls, WithoutWallsItIsHeardAllTheTime) {
  Scenario scenario = pillar();
  scenario.link.wall = 0.0;
  const RunReport report = run(scenario);
  EXPECT_FALSE(report.ok());  // the command that the pillar kept from it was answered
}

}  // namespace
}  // namespace adit::sim
