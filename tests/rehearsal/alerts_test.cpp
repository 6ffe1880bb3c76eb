// SPDX-License-Identifier: Apache-2.0
// The alerts of an operator's window, judged by the truth of rehearsals.
#include "bench/alerts/judged_run.hpp"
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

TEST(Alerts, AreTrueAndMissNothingInChaos) {
  const Scenario scenario = load_shipped("team_chaos.yaml");
  const auto world = *make_world(scenario.world);
  int judged = 0, losses = 0;
  for (std::uint64_t seed = 1; seed <= seeds(2, 20); ++seed) {
    const auto operators = bench::judged_run(scenario, world, seed);
    ASSERT_TRUE(operators.ok()) << operators.error().text;
    for (const bench::JudgedOperator& one : *operators) {
      for (const std::string& complaint : one.judge->complaints())
        ADD_FAILURE() << "seed " << seed << " " << one.station << ": " << complaint;
      judged += one.judge->figures().judged;
      losses += one.judge->figures().losses;
    }
  }
  EXPECT_GE(judged, 5);
  EXPECT_GE(losses, 5);
}

}  // namespace
}  // namespace adit::sim
