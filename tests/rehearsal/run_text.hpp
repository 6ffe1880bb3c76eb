#pragma once
#include <gtest/gtest.h>

#include <string>

#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace adit::sim {

/// What a scenario written in a test comes to; `defect`: one that is compiled into the agent, none when
/// empty.
inline RunReport run_text(const std::string& yaml, const char* file, const std::string& defect = "",
                          std::uint64_t seed = 1) {
  auto scenario = parse_scenario(yaml, file);
  EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().text);
  auto factory = make_agent_factory(defect);
  EXPECT_TRUE(factory.ok());
  RunParams params;
  params.seed = seed;
  params.make_agent = *factory;
  auto outcome = rehearse(*scenario, *make_world(scenario->world), params);
  EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
  return outcome->report;
}

}  // namespace adit::sim
