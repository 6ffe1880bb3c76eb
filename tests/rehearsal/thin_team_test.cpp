// SPDX-License-Identifier: Apache-2.0
// Many on a thin link: rates follow it, and commands keep their latency.
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

RunReport run_thin_team(const Scenario& scenario) {
  RunParams params;
  params.make_agent = *make_agent_factory();
  auto outcome = rehearse(scenario, *make_world(scenario.world), params);
  EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
  return outcome->report;
}

constexpr double kRobots = 6, kStations = 3, kTime = 90;  // s

TEST(ThinTeam, StatesKeepToTheLinkAndStopsGetThrough) {
  const RunReport report = run_thin_team(load_shipped("thin_team.yaml"));
  EXPECT_TRUE(report.ok()) << (report.complaints().empty() ? "" : report.complaints().front());
  const auto& states = report.topics.at("adit/robot_state");
  EXPECT_LT(static_cast<double>(states.samples), 7.0 * kRobots * kTime);
  EXPECT_GT(static_cast<double>(states.samples), 0.95 * kRobots * kTime);
  // What is written passes: the air loses 10 %, start-up some, a queue that overflows would lose most.
  EXPECT_GT(static_cast<double>(states.delivered), 0.6 * kStations * static_cast<double>(states.samples));
}

TEST(ThinTeam, WithRoomForAllTheyComeTenTimesASecond) {
  const wire::LinkProfile room{.name = "room", .bandwidth = 10e6, .latency = 0.05};
  Scenario scenario = load_shipped("thin_team.yaml");
  scenario.link = room;
  scenario.duration = 30s;
  scenario.expectations.clear();  // A run lasts until the last of them.
  const RunReport report = run_thin_team(scenario);
  const auto& states = report.topics.at("adit/robot_state");
  constexpr double kStates = 10.0 * kRobots * 30;
  EXPECT_NEAR(static_cast<double>(states.samples), kStates, 0.03 * kStates);
}

}  // namespace
}  // namespace adit::sim
