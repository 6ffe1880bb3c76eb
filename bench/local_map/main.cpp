// SPDX-License-Identifier: Apache-2.0
// bench_local_map: the local map beside the other maps of the same ground, cell by cell, in rehearsals.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <map>

#include "bench/local_map/comparison.hpp"
#include "robot_agent/agent.hpp"
#include "sim/rehearsal/agent_factory.hpp"
#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace {

using namespace adit;
using namespace adit::bench;

int fail(const std::string& text) {
  std::fprintf(stderr, "bench_local_map: %s\n", text.c_str());
  return 2;
}

/// Rehearses one scenario; the sum over its robots.
Result<Counts> compare(const std::string& file, std::uint64_t seed) {
  const auto scenario = sim::load_scenario(file);
  if (!scenario) return scenario.error();
  const auto world = sim::make_world(scenario->world);
  if (!world) return world.error();
  std::map<std::string, std::shared_ptr<Comparison>> robots;
  const auto adjust = [&](agent::AgentParams& params) {
    if (params.platform.flies()) return;
    auto& comparison = robots[params.name];
    if (!comparison) comparison = std::make_shared<Comparison>(params.platform);
    params.watch_maps.local = [comparison](const agent::PlanJob& job, const nav::LocalNavigation& local) {
      comparison->look(job, local);
    };
    params.watch_maps.route = [comparison](const agent::RouteJob& job, const nav::RoutePlanner& planner) {
      comparison->look(job, planner);
    };
  };
  sim::RunParams params;
  params.seed = seed;
  params.workers = 1;  // The maps of a robot are looked at by one thread.
  params.make_agent = sim::make_agent_factory("", adjust).value();
  const auto outcome = sim::rehearse(*scenario, *world, params);
  if (!outcome) return outcome.error();
  Counts sum;
  for (const auto& [name, comparison] : robots) sum += comparison->counts();
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Rehearses scenarios and compares the local map of each robot with its map of the routes and "
      "what its collision monitor saw, cell by cell."};
  std::vector<std::string> files{"config/scenarios/demo.yaml", "bench/local_map/ring.yaml",
                                 "config/scenarios/stairs.yaml", "config/scenarios/waypoint_corridor.yaml"};
  std::uint64_t seeds = 1, first = 1;
  app.add_option("scenario", files, "files (.yaml); default: demo, ring, stairs and waypoint_corridor");
  app.add_option("--seeds", seeds, "how many of each (default 1)")->check(CLI::Range(1, 1000));
  app.add_option("--first", first, "the first seed (default 1)");
  app.footer("Example:\n  bench_local_map config/scenarios/demo.yaml config/scenarios/stairs.yaml");
  CLI11_PARSE(app, argc, argv);
  for (const std::string& file : files) {
    Counts sum;
    for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
      const auto counts = compare(file, seed);
      if (!counts) return fail(counts.error().text);
      sum += *counts;
    }
    fmt::print("{}", tables_of(std::filesystem::path(file).stem().string(), sum));
    std::fflush(stdout);
  }
  return 0;
}
