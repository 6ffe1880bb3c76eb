// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"
#include "tests/folders/folders.hpp"

namespace adit::sim {

/// Ends a run one second after all its expectations are settled, and with all_seeds() never.
inline std::function<bool(const RunState&)> once_decided() {
  return [since = Duration::max()](const RunState& state) mutable {
    since = state.decided ? std::min(since, state.now) : Duration::max();
    return !all_seeds() && state.decided && state.now >= since + 1s;
  };
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

/// What a scenario written in a test comes to, once it is decided; `defect`: one of sim/defects, none when
/// empty.
inline RunReport run_text(const std::string& yaml, const char* file, const std::string& defect = "") {
  auto scenario = parse_scenario(yaml, file);
  EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().text);
  auto factory = make_agent_factory(defect);
  EXPECT_TRUE(factory.ok());
  RunParams params;
  params.make_agent = *factory;
  params.parent_wire = make_parent_decorator(defect);
  params.seed = scenario->seed;
  params.ended = once_decided();
  auto outcome = rehearse(*scenario, *make_world(scenario->world), params);
  EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
  return outcome->report;
}

}  // namespace adit::sim
