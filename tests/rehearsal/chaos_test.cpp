// SPDX-License-Identifier: Apache-2.0
// Faults and commands drawn from seeds; and that a seed that fails is shrunk to a scenario that fails by
// itself.
#include <atomic>
#include <thread>

#include "sim/rehearsal/shrink.hpp"
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

Scenario team() { return load_shipped("team_chaos.yaml"); }

/// Of the same kind, in a quarter of the time.
Scenario short_team() {
  Scenario scenario = team();
  scenario.duration = 15s;
  scenario.random->commands = 24;
  scenario.random_faults->faults = 6;
  scenario.random->to = scenario.random_faults->to = 13s;
  return scenario;
}

std::shared_ptr<const World> team_world() {
  static const auto world = *make_world(team().world);
  return world;
}

RunReport run_chaos(const Scenario& scenario, std::uint64_t seed, const std::string& defect = {},
                    const std::shared_ptr<const World>& world = team_world()) {
  RunParams params;
  params.seed = seed;
  params.workers = 1;
  params.make_agent = *make_agent_factory(defect);
  auto outcome = rehearse(scenario, world, params);
  EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
  return std::move(outcome->report);
}

void expect_no_rule_broken(const char* file, std::size_t count, std::size_t commands, std::size_t faults) {
  const Scenario scenario = load_shipped(file);
  const auto world = *make_world(scenario.world);
  std::vector<RunReport> reports(count);
  {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t i = next++; i < reports.size(); i = next++)
        reports[i] = run_chaos(scenario, i + 1, {}, world);
    };
    const std::jthread one(work), two(work);
  }
  for (const RunReport& report : reports) {
    for (const std::string& line : report.complaints())
      ADD_FAILURE() << "seed " << report.seed << ": " << line;
    EXPECT_GE(report.commands.sent, commands);
    EXPECT_GE(report.fault_count(), faults);
  }
}

TEST(Chaos, SeedsBreakNoRule) { expect_no_rule_broken("team_chaos.yaml", seeds(4, 20), 30, 5); }

TEST(Chaos, SeedsOfACorridorWithAreasBreakNoRule) {
  expect_no_rule_broken("fence_chaos.yaml", seeds(2, 20), 25, 3);
}

TEST(Chaos, SeedsOfDriversFaultsBreakNoRule) {
  expect_no_rule_broken("driver_chaos.yaml", seeds(1, 20), 20, 4);
}

TEST(Chaos, RandomFaultsWrittenToAFileGiveTheSameRun) {
  const Scenario scenario = short_team();
  const Scenario written = written_out(scenario, 5);
  EXPECT_FALSE(written.random);
  const std::string digest = run_chaos(scenario, 5).digest;
  EXPECT_EQ(run_chaos(written, 5).digest, digest);
  const auto text = to_text(written, {6, 0, 3s, "r1: x"}, "again.yaml");
  ASSERT_TRUE(text.ok()) << text.error().text;
  const auto again = parse_scenario(*text, "again.yaml");
  ASSERT_TRUE(again.ok()) << again.error().text;
  EXPECT_EQ(again->seed, 5U);
  EXPECT_EQ(run_chaos(*again, 5).digest, digest);
}

TEST(Chaos, AFailingSeedIsShrunkToAScenarioThatFailsByItself) {
  const std::string defect = "joystick_clears_stop";
  const Scenario scenario = short_team();
  std::optional<Failure> failure;
  std::uint64_t seed = 7;  // The next one fails after 4 s: the runs that shrink it are as short.
  while (!failure && seed < 200) failure = failure_of(scenario, run_chaos(scenario, ++seed, defect));
  ASSERT_TRUE(failure);
  const ShrinkResult small =
      shrink(written_out(scenario, seed), *failure,
             [&](const Scenario& s) -> Result<RunReport> { return run_chaos(s, s.seed, defect); }, {});
  EXPECT_LE(small.scenario.faults.size(), 3U);
  EXPECT_LE(small.scenario.script.size(), 10U);
  const auto text = to_text(small.scenario, small.failure, "small.yaml");
  ASSERT_TRUE(text.ok()) << text.error().text;
  const auto again = parse_scenario(*text, "small.yaml");
  ASSERT_TRUE(again.ok()) << again.error().text;
  const auto same = failure_of(*again, run_chaos(*again, again->seed, defect));
  ASSERT_TRUE(same);
  EXPECT_TRUE(same->same(*failure)) << same->text;
  EXPECT_FALSE(failure_of(*again, run_chaos(*again, again->seed))) << "the defect is what fails";
}

TEST(Chaos, TextThatIsNotLaidOutInLinesIsNotWritten) {
  auto scenario = parse_scenario(
      "{world: {boxes: []}, duration: 5, robots: [{id: r1, platform: wheeled, pose: [0, 0, 0]}]}",
      "flow.yaml");
  ASSERT_TRUE(scenario.ok()) << scenario.error().text;
  EXPECT_EQ(to_text(*scenario, {6, 0, 3s, "x"}, "again.yaml").reason(), Reason::not_supported);
}

}  // namespace
}  // namespace adit::sim
