// SPDX-License-Identifier: Apache-2.0
// bench_team: convoys of 2, 4 and 6 robots of mixed platforms, as a table.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <thread>

#include "bench/team/convoy_figures.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace {

using namespace adit;
using namespace adit::bench;

Result<ConvoyFigures> run(const ConvoyCourse& course, std::uint64_t seed, const sim::AgentFactory& agents) {
  const auto scenario = sim::parse_scenario(course.scenario_text(), "convoy.yaml");
  if (!scenario) return scenario.error();
  const auto world = sim::make_world(scenario->world);
  if (!world) return world.error();
  sim::RunParams params{};
  params.seed = seed;
  params.workers = 1;
  params.make_agent = agents;
  const auto outcome = sim::rehearse(*scenario, *world, params);
  if (!outcome) return outcome.error();
  return figures_of(course, *outcome);
}

struct Limit {
  const char* name;
  double wanted;
  bool at_most;
  std::optional<double> (*of)(const ConvoyFigures&);
};
constexpr double kNever = 1e9;
const std::vector<Limit> kLimits{
    {"gap error rms, m", 0.4, true, [](const ConvoyFigures& f) { return std::optional(f.gap_error); }},
    {"smallest gap, m", 0.5, false, [](const ConvoyFigures& f) { return std::optional(f.smallest_gap); }},
    {"cross track rms, m", 0.25, true, [](const ConvoyFigures& f) { return std::optional(f.cross_track); }},
    {"cross track at most, m", kNever, true,
     [](const ConvoyFigures& f) { return std::optional(f.largest_cross_track); }},
    {"last stands after leader, s", 2.0, true, [](const ConvoyFigures& f) { return f.stop; }},
    {"amplification per link", 1.0, true,
     [](const ConvoyFigures& f) { return std::optional(f.amplification); }},
    {"splice after peel-off, s", 10.0, true, [](const ConvoyFigures& f) { return f.splice; }},
    {"contacts", 0.0, true, [](const ConvoyFigures& f) { return std::optional<double>(f.contacts); }},
};

/// Prints median and worst of one figure over all seeds; returns whether the worst is as wanted.
bool print(const Limit& limit, int robots, const std::vector<ConvoyFigures>& all) {
  if (limit.of == kLimits[6].of && robots < 3) return true;
  std::vector<double> values;
  for (const ConvoyFigures& f : all) values.push_back(limit.of(f).value_or(kNever));
  std::sort(values.begin(), values.end());
  if (!limit.at_most) std::reverse(values.begin(), values.end());
  const double median = values[values.size() / 2], worst = values.back();
  const bool ok = limit.at_most ? worst <= limit.wanted : worst >= limit.wanted;
  const auto text = [](double v) { return v >= kNever ? std::string("never") : fmt::format("{:.2f}", v); };
  const std::string wanted =
      limit.wanted >= kNever
          ? std::string()
          : fmt::format("{} {}{}", limit.at_most ? "<=" : ">=", limit.wanted, ok ? "" : ": MISSED");
  fmt::print("| {} | {} | {} | {} | {} |\n", robots, limit.name, text(median), text(worst), wanted);
  return ok;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Convoys of mixed platforms, measured by their true poses.", "bench_team"};
  ConvoyCourse course;
  std::vector<int> sizes{2, 4, 6};
  int seeds = 10;
  std::uint64_t first = 1;
  bool each = false;
  std::string save;
  app.add_option("--robots", sizes, "sizes of the convoys (default 2,4,6)")
      ->delimiter(',')
      ->check(CLI::Range(2, 8));
  app.add_option("--seeds", seeds, "runs of each size")->capture_default_str()->check(CLI::Range(1, 100000));
  app.add_option("--first", first, "the first seed")->capture_default_str();
  app.add_option("--noise", course.noise, "scale of the errors of odometry and sensors")
      ->capture_default_str();
  app.add_option("--link", course.link, "radio link")->capture_default_str();
  app.add_flag("--full", course.full, "full lidars: slower");
  app.add_flag("--each", each, "a line for each run");
  app.add_option("--save", save, "writes the scenario of the last size to this file, for rehearse");
  app.footer(
      "Examples:\n  ./run bench team --seeds 3\n  ./run bench team --robots 6 --noise 1 --link mesh_500k "
      "--each");
  CLI11_PARSE(app, argc, argv);

  const auto agents = sim::make_agent_factory();
  if (!agents) return std::fprintf(stderr, "bench_team: %s\n", agents.error().text.c_str()), 2;
  bool ok = true;
  fmt::print("| robots | figure | median | worst | wanted |\n| --- | --- | --- | --- | --- |\n");
  for (const int robots : sizes) {
    course.robots = robots;
    if (!save.empty()) std::ofstream(save) << course.scenario_text();
    std::vector<Result<ConvoyFigures>> results(static_cast<std::size_t>(seeds),
                                               Result<ConvoyFigures>{Reason::internal, ""});
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t n = next++; n < results.size(); n = next++)
        results[n] = run(course, first + n, *agents);
    };
    std::vector<std::thread> workers;
    for (unsigned n = 0; n < std::max(1u, std::thread::hardware_concurrency()); ++n)
      workers.emplace_back(work);
    for (std::thread& worker : workers) worker.join();
    std::vector<ConvoyFigures> all;
    for (std::size_t n = 0; n < results.size(); ++n) {
      if (!results[n])
        return std::fprintf(stderr, "bench_team: seed %zu: %s\n", n + first, results[n].error().text.c_str()),
               2;
      const ConvoyFigures& f = all.emplace_back(*results[n]);
      for (const std::string& complaint : f.complaints)
        fmt::print("{} robots, seed {}: {}\n", robots, first + n, complaint);
      if (each)
        fmt::print(
            "{} robots, seed {}: gap error {:.2f}, smallest {:.2f}, cross track {:.2f} (at most {:.2f}), "
            "stop {:.1f}, amplification {:.2f}, splice {:.1f}, contacts {}\n",
            robots, first + n, f.gap_error, f.smallest_gap, f.cross_track, f.largest_cross_track,
            f.stop.value_or(-1), f.amplification, f.splice.value_or(-1), f.contacts);
    }
    for (const Limit& limit : kLimits) ok = print(limit, robots, all) && ok;
    std::fflush(stdout);
  }
  return ok ? 0 : 1;
}
