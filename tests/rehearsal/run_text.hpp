// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"
#include "tests/folders/folders.hpp"

namespace adit::sim {

/// Number of seeds of a case: `few`, or with ADIT_ALL_SEEDS in the environment (tests of label long) `all`.
inline std::uint64_t seeds(std::uint64_t few, std::uint64_t all) {
  return std::getenv("ADIT_ALL_SEEDS") != nullptr ? all : few;
}

/// A scenario of config/scenarios.
inline Scenario load_shipped(const std::string& file) {
  auto scenario = load_scenario(source_folder() + "/config/scenarios/" + file);
  EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().text);
  return *scenario;
}

/// That all expectations and rules hold; the events are printed when they do not.
inline void expect_ok(const RunReport& report) {
  for (const std::string& line : report.complaints()) ADD_FAILURE() << "seed " << report.seed << ": " << line;
  for (const TimedEvent& event : report.events)
    if (testing::Test::HasFailure())
      std::printf("%6.1f %s %s\n", seconds(event.at), event.robot.c_str(), event.text.c_str());
}

/// What a scenario written in a test comes to; `defect`: one of sim/defects, none when empty.
inline RunReport run_text(const std::string& yaml, const char* file, const std::string& defect = "") {
  auto scenario = parse_scenario(yaml, file);
  EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().text);
  auto factory = make_agent_factory(defect);
  EXPECT_TRUE(factory.ok());
  RunParams params;
  params.make_agent = *factory;
  params.parent_wire = make_parent_decorator(defect);
  params.seed = scenario->seed;
  auto outcome = rehearse(*scenario, *make_world(scenario->world), params);
  EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
  return outcome->report;
}

}  // namespace adit::sim
