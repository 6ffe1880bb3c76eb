// SPDX-License-Identifier: Apache-2.0
// rehearse: runs a scenario on virtual time and judges it.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "core/config/search.hpp"
#include "core/config/usage.hpp"
#include "perception/vision/vision_detector.hpp"
#include "robot_agent/agent.hpp"
#include "sim/defects/defect.hpp"
#include "sim/rehearsal/program/interrupt.hpp"
#include "sim/rehearsal/program/report_error.hpp"
#include "sim/rehearsal/program/shrink_seeds.hpp"
#include "sim/rehearsal/random_faults.hpp"
#include "sim/rehearsal/random_script.hpp"
#include "sim/rehearsal/run_picture.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace {

using namespace adit;
using namespace adit::sim;

constexpr int kExitInterrupted = 130;
constexpr const char* kChaosScenario = "scenarios/team_chaos.yaml";

constexpr const char* kExamples =
    "Examples:\n"
    "  rehearse config/scenarios/demo.yaml --picture demo.png\n"
    "  rehearse config/scenarios/handover.yaml --seed 7 --report handover.json\n"
    "  rehearse config/scenarios/handover.yaml --record handover.mcap\n"
    "  rehearse config/scenarios/authority_storm.yaml --seeds 1..200\n"
    "  rehearse --chaos --seeds 1..2000\n"
    "Exit status: 0 every expectation and every rule holds, 1 one does not, 2 the scenario cannot be read, "
    "130 Ctrl-C.";

void show_progress(Duration now, Duration all) {
  std::fprintf(stderr, "\r%5.0f of %.0f s ", seconds(now), seconds(all));
}

int run_one(const Scenario& scenario, const std::shared_ptr<const World>& world, RunParams params,
            const std::string& report_file, const std::string& picture_file) {
  const bool tty = isatty(STDERR_FILENO) == 1;
  if (tty) params.progress = [&](Duration now) { show_progress(now, scenario.duration); };
  auto outcome = rehearse(scenario, world, params);
  if (tty) std::fprintf(stderr, "\r                      \r");
  if (!outcome) return report_error("rehearse", outcome.error());
  const RunReport& report = outcome->report;
  std::printf("%s seed %llu: %s, %.0f s in %.2f s (%.1f times real time), digest %s\n", scenario.name.c_str(),
              static_cast<unsigned long long>(report.seed), report.ok() ? "ok" : "FAILED", report.virtual_s,
              report.wall_s, report.virtual_s / report.wall_s, report.digest.c_str());
  for (const auto& [id, robot] : report.robots)
    std::printf("  %s: %.1f m, moving %.0f %% of the time, %d collisions (%d caused), %s\n", id.c_str(),
                robot.distance, 100.0 * robot.moving, robot.collisions, robot.caused,
                robot.clearance().c_str());
  if (report.exploration) {
    std::printf("  explored %.1f %% of what can be seen, %.0f %% of the way driven again;",
                100 * report.exploration->share, 100 * report.exploration->repeat);
    for (std::size_t n = 0; n < ExplorationResult::kShares.size(); ++n)
      if (const auto& reached = report.exploration->reached[n])
        std::printf(" %s %.1f s", ExplorationResult::name(n).c_str(), reached->time_s);
    std::printf("\n");
  }
  if (report.map)
    std::printf("  the map at the station: %.0f m2, %llu bytes on the air, %.1f per m2\n", report.map->m2,
                static_cast<unsigned long long>(report.map->bytes), report.map->bytes_per_m2());
  std::printf("  commands: %llu sent, %llu accepted, %llu refused\n",
              static_cast<unsigned long long>(report.commands.sent),
              static_cast<unsigned long long>(report.commands.accepted),
              static_cast<unsigned long long>(report.commands.refused));
  print_complaints(report);
  if (!report_file.empty())
    if (auto written = write_json(report, report_file); !written)
      return report_error("rehearse", written.error());
  if (!picture_file.empty())
    if (auto drawn = draw_run(scenario, *world, *outcome, picture_file); !drawn)
      return report_error("rehearse", drawn.error());
  return report.ok() ? 0 : kExitFailed;
}

struct ManyOptions {
  bool chaos{}, until_failure{};
  std::string shrink_to{};
};

int run_many(const Scenario& scenario, const std::shared_ptr<const World>& world, const RunParams& params,
             const SeedRange& seeds, const ManyOptions& options) {
  note_interrupts();
  const SeedsOutcome out = run_seeds(scenario, world, params, seeds, options.until_failure);
  if (out.broken) return report_error("rehearse", *out.broken);
  std::printf("%llu of %llu seeds, %zu failed, %.0f s in %.1f s (%.0f times real time)\n",
              static_cast<unsigned long long>(out.done), static_cast<unsigned long long>(out.wanted),
              out.failed.size(), out.virtual_s, out.wall_s, out.virtual_s / out.wall_s);
  if (out.done > 0)
    std::printf(
        "commands: %llu, at least %llu a seed; faults: %llu, at least %llu a seed\n",
        static_cast<unsigned long long>(out.commands), static_cast<unsigned long long>(out.fewest_commands),
        static_cast<unsigned long long>(out.faults), static_cast<unsigned long long>(out.fewest_faults));
  if (options.chaos && !out.failed.empty())
    if (auto done = shrink_seeds(scenario, world, params, out, options.shrink_to); !done)
      return report_error("rehearse", done.error());
  if (interrupted()) return kExitInterrupted;
  return out.failed.empty() ? 0 : kExitFailed;
}

std::string defect_list() {
  std::string list;
  for (const Defect& defect : defects())
    list += "\n  " + std::string(defect.name) + ": " + std::string(defect.what);
  return list;
}

void set_perception(Scenario& scenario, const std::string& level) {
  scenario.perception = perception_level(level);
  for (RobotSpec& robot : scenario.robots) robot.settings.perception = scenario.perception;
}

// Chaos needs something to draw: what a scenario does not say is as in team_chaos.yaml.
void add_chaos(Scenario& scenario) {
  const Duration from = scenario.duration / 20, to = scenario.duration * 19 / 20;
  if (!scenario.random_faults) scenario.random_faults = RandomFaults{8, from, to};
  if (scenario.random || !scenario.script.empty()) return;
  RandomScript script{70, from, to, {}, {}, all_random_verbs(), {4.0, 4.0}};
  for (const StationSpec& station : scenario.stations) script.by.push_back(station.id);
  for (const RobotSpec& robot : scenario.robots) script.robots.push_back(robot.id);
  if (!script.by.empty()) scenario.random = script;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Runs a scenario on virtual time and judges it: its expectations, and the rules that always hold.",
      "rehearse"};
  app.footer(kExamples);
  std::string file, seeds_text, report_file, picture_file;
  std::uint64_t seed = 1;
  RunParams params;
  bool chaos = false, until_failure = false;
  std::string shrink_to, defect, perception;
  app.add_option("scenario", file, "the scenario, SCENARIO.yaml (with --chaos: scenarios/team_chaos.yaml)");
  auto* seed_option =
      app.add_option("--seed", seed, "of everything that is random (default: the scenario's, or 1)")
          ->check(config::between(std::uint64_t{0}));
  auto* seeds_option =
      app.add_option("--seeds", seeds_text, "A..B: one run for each, in parallel, and a table");
  auto* report_option = app.add_option("--report", report_file, "write the report as JSON");
  auto* picture_option = app.add_option("--picture", picture_file, "write a picture (PNG)");
  auto* trajectories_option =
      app.add_option("--trajectories", params.trajectories,
                     "write truth, odometry and the robots' own poses into this folder (TUM files)");
  auto* record_option =
      app.add_option("--record", params.record, "write an MCAP recording of everything said");
  seeds_option->excludes(seed_option)
      ->excludes(report_option)
      ->excludes(picture_option)
      ->excludes(trajectories_option)
      ->excludes(record_option);
  auto* threads_option = app.add_option("--threads", params.workers,
                                        "for the heavy work of the run, 1 to 64 (2 if left out); the run is "
                                        "the same with any number")
                             ->check(config::between(1, 64));
  threads_option->excludes(seeds_option);
  auto* chaos_option =
      app.add_flag("--chaos", chaos,
                   "faults (and commands) drawn from the seed; a seed that fails is shrunk to the "
                   "fewest faults, and written as a scenario that fails by itself");
  chaos_option->excludes(report_option)
      ->excludes(picture_option)
      ->excludes(trajectories_option)
      ->excludes(record_option)
      ->excludes(threads_option);
  app.add_option("--shrink-to", shrink_to, "the file it is written to (default NAME-seedN-ruleM.yaml)")
      ->needs(chaos_option);
  app.add_option("--perception", perception, "of all robots, in place of what the scenario says")
      ->check(CLI::IsMember(kPerceptionWords));
  app.add_flag("--until-failure", until_failure, "begin no further seed once one has failed");
  app.add_option("--defect", defect, "break a rule on purpose, to see who finds it; one of:" + defect_list());
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return config::end_usage(app, error);
  }
  if (file.empty() && !chaos)
    return report_error("rehearse", {Reason::bad_argument, "expected a scenario, SCENARIO.yaml, or --chaos"});
  if (until_failure && seeds_text.empty())
    return report_error("rehearse", {Reason::bad_argument, "--until-failure goes with --seeds A..B"});
  const auto seeds = seeds_text.empty() ? Result<SeedRange>(SeedRange{}) : parse_seeds(seeds_text);
  if (!seeds) return report_error("rehearse", seeds.error());
  if (file.empty()) {
    const auto found = config::find_file(kChaosScenario);
    if (!found) return report_error("rehearse", found.error());
    file = *found;
  }
  auto scenario = load_scenario(file);
  if (!scenario) return report_error("rehearse", scenario.error());
  auto world = make_world(scenario->world);
  if (!world) return report_error("rehearse", world.error());
  auto factory = make_agent_factory(
      defect, [](agent::AgentParams& agent) { agent.make_detector = perception::make_vision_detector; });
  if (!factory) return report_error("rehearse", factory.error());
  if (chaos) add_chaos(*scenario);
  if (!perception.empty()) set_perception(*scenario, perception);
  params.seed = seed_option->count() > 0 ? seed : scenario->seed;
  params.make_agent = *factory;
  params.parent_wire = make_parent_decorator(defect);
  if (seeds_text.empty() && !chaos) return run_one(*scenario, *world, params, report_file, picture_file);
  const SeedRange range = seeds_text.empty() ? SeedRange{params.seed, params.seed} : *seeds;
  return run_many(*scenario, *world, params, range, {chaos, until_failure, shrink_to});
}
