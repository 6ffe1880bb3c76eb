// rehearse: runs a scenario on virtual time and judges it.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <mutex>
#include <thread>

#include "core/config/usage.hpp"
#include "sim/rehearsal/program/options.hpp"
#include "sim/rehearsal/run_picture.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace {

using namespace adit;
using namespace adit::sim;

constexpr int exit_failed = 1;
constexpr int exit_unreadable = 2;

constexpr const char* examples =
    "Examples:\n"
    "  rehearse config/scenarios/demo.yaml --picture demo.png\n"
    "  rehearse config/scenarios/handover.yaml --seed 7 --report handover.json\n"
    "  rehearse config/scenarios/handover.yaml --record handover.mcap\n"
    "  rehearse config/scenarios/authority_storm.yaml --seeds 1..200\n"
    "Exit status: 0 every expectation and every rule holds, 1 one does not, 2 the scenario cannot be read.";

int complain(const Error& error) {
  std::fprintf(stderr, "rehearse: %s\n", error.text.c_str());
  return exit_unreadable;
}

void show_progress(Duration now, Duration all) {
  std::fprintf(stderr, "\r%5.0f of %.0f s ", seconds(now), seconds(all));
}

void tell_complaints(const RunReport& report) {
  for (const std::string& line : report.complaints())
    std::fprintf(stderr, "seed %llu: %s\n", static_cast<unsigned long long>(report.seed), line.c_str());
}

int run_one(const Scenario& scenario, const std::shared_ptr<const World>& world, RunParams params,
            const std::string& report_file, const std::string& picture_file) {
  const bool tty = isatty(STDERR_FILENO) == 1;
  if (tty) params.progress = [&](Duration now) { show_progress(now, scenario.duration); };
  auto outcome = rehearse(scenario, world, params);
  if (tty) std::fprintf(stderr, "\r                      \r");
  if (!outcome) return complain(outcome.error());
  const RunReport& report = outcome->report;
  std::printf("%s seed %llu: %s, %.0f s in %.2f s (%.1f times real time), digest %s\n", scenario.name.c_str(),
              static_cast<unsigned long long>(report.seed), report.ok() ? "ok" : "FAILED", report.virtual_s,
              report.wall_s, report.virtual_s / report.wall_s, report.digest.c_str());
  for (const auto& [id, robot] : report.robots)
    std::printf("  %s: %.1f m, moving %.0f %% of the time, %d collisions, %s\n", id.c_str(), robot.distance,
                100.0 * robot.moving, robot.collisions, robot.clearance().c_str());
  std::printf("  commands: %llu sent, %llu accepted, %llu refused\n",
              static_cast<unsigned long long>(report.commands.sent),
              static_cast<unsigned long long>(report.commands.accepted),
              static_cast<unsigned long long>(report.commands.refused));
  tell_complaints(report);
  if (!report_file.empty())
    if (auto written = write_json(report, report_file); !written) return complain(written.error());
  if (!picture_file.empty())
    if (auto drawn = draw_run(scenario, *world, *outcome, picture_file); !drawn)
      return complain(drawn.error());
  return report.ok() ? 0 : exit_failed;
}

int run_many(const Scenario& scenario, const std::shared_ptr<const World>& world, const RunParams& params,
             const SeedRange& seeds) {
  std::atomic<std::uint64_t> next{seeds.first};
  std::mutex printing;
  std::uint64_t failed = 0, done = 0;
  std::optional<Error> broken;
  const std::uint64_t all = seeds.last - seeds.first + 1;
  const bool tty = isatty(STDERR_FILENO) == 1;
  std::printf("%8s %6s %9s %9s %9s %9s  %s\n", "seed", "ok", "commands", "accepted", "refused", "speed",
              "digest");
  const auto work = [&] {
    for (std::uint64_t seed = next++; seed <= seeds.last; seed = next++) {
      RunParams own = params;
      own.seed = seed;
      own.workers = 1;
      auto outcome = rehearse(scenario, world, own);
      const std::lock_guard lock(printing);
      if (!outcome) {
        broken = outcome.error();
        next = seeds.last + 1;
        return;
      }
      const RunReport& r = outcome->report;
      std::printf("%8llu %6s %9llu %9llu %9llu %8.0fx  %s\n", static_cast<unsigned long long>(seed),
                  r.ok() ? "yes" : "NO", static_cast<unsigned long long>(r.commands.sent),
                  static_cast<unsigned long long>(r.commands.accepted),
                  static_cast<unsigned long long>(r.commands.refused), r.virtual_s / r.wall_s,
                  r.digest.c_str());
      tell_complaints(r);
      failed += r.ok() ? 0 : 1;
      if (tty)
        std::fprintf(stderr, "\r%llu of %llu ", static_cast<unsigned long long>(++done),
                     static_cast<unsigned long long>(all));
    }
  };
  {
    const unsigned count =
        std::max(1U, std::min<unsigned>(std::thread::hardware_concurrency(), static_cast<unsigned>(all)));
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < count; ++i) threads.emplace_back(work);
  }
  if (tty) std::fprintf(stderr, "\r                \r");
  if (broken) return complain(*broken);
  std::printf("%llu seeds, %llu failed\n", static_cast<unsigned long long>(all),
              static_cast<unsigned long long>(failed));
  return failed == 0 ? 0 : exit_failed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Runs a scenario on virtual time and judges it: its expectations, and the rules that always hold.",
      "rehearse"};
  app.footer(examples);
  std::string file, seeds_text, report_file, picture_file;
  std::uint64_t seed = 1;
  RunParams params;
  app.add_option("scenario", file, "the scenario, SCENARIO.yaml")->required();
  auto* seed_option = app.add_option("--seed", seed, "of everything that is random (default 1)")
                          ->check(CLI::NonNegativeNumber);
  auto* seeds_option =
      app.add_option("--seeds", seeds_text, "A..B: one run for each, in parallel, and a table");
  auto* report_option = app.add_option("--report", report_file, "write the report as JSON");
  auto* picture_option = app.add_option("--picture", picture_file, "write a picture (PNG)");
  auto* record_option =
      app.add_option("--record", params.record, "write an MCAP recording of everything said");
  seeds_option->excludes(seed_option)
      ->excludes(report_option)
      ->excludes(picture_option)
      ->excludes(record_option);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return config::end_usage(app, error);
  }
  auto scenario = load_scenario(file);
  if (!scenario) return complain(scenario.error());
  auto world = make_world(scenario->world);
  if (!world) return complain(world.error());
  auto factory = make_agent_factory();
  if (!factory) return complain(factory.error());
  params.seed = seed;
  params.make_agent = *factory;
  if (seeds_text.empty()) return run_one(*scenario, *world, params, report_file, picture_file);
  auto seeds = parse_seeds(seeds_text);
  if (!seeds) return complain(seeds.error());
  return run_many(*scenario, *world, params, *seeds);
}
