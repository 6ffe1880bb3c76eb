// SPDX-License-Identifier: Apache-2.0
// How much processor time a rehearsal takes: the demo, with each level of perception and both lidars.
#include <fmt/core.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "core/config/search.hpp"
#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace {

using namespace adit;
using namespace adit::sim;

/// What a row runs.
struct Course {
  const char* lidar;
  LidarKind kind;
  const char* perception;
  PerceptionLevel level;
};

constexpr Course kCourses[] = {
    {"full", LidarKind::full, "off", PerceptionLevel::off},
    {"full", LidarKind::full, "odometry", PerceptionLevel::odometry},
    {"full", LidarKind::full, "slam", PerceptionLevel::slam},
    {"planar", LidarKind::planar, "off", PerceptionLevel::off},
    {"planar", LidarKind::planar, "odometry", PerceptionLevel::odometry},
};

/// Processor time of this process so far, s.
double processor_s() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds_of = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
}

int fail(const Error& error) {
  std::fprintf(stderr, "bench_rehearsal: %s\n", error.text.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Processor time of a rehearsal, by lidar and perception."};
  std::string file;
  RunParams params;
  int repeats = 3;
  app.add_option("scenario", file, "the scenario (default scenarios/demo.yaml)");
  app.add_option("--threads", params.workers, "of a run (default 2)")->check(CLI::Range(1, 64));
  app.add_option("--repeats", repeats, "runs of each row, of which the quickest counts (default 3)")
      ->check(CLI::Range(1, 100));
  CLI11_PARSE(app, argc, argv);
  if (file.empty()) {
    const auto found = config::find_file("scenarios/demo.yaml");
    if (!found) return fail(found.error());
    file = *found;
  }
  auto scenario = load_scenario(file);
  if (!scenario) return fail(scenario.error());
  const auto world = make_world(scenario->world);
  if (!world) return fail(world.error());
  const auto agents = make_agent_factory();
  if (!agents) return fail(agents.error());
  params.make_agent = *agents;
  params.seed = scenario->seed;
  // What the run found is not judged here.
  scenario->expectations.clear();
  fmt::print("| lidar | perception | CPU per virtual second, s | times real time, {} threads | digest |\n",
             params.workers);
  fmt::print("| --- | --- | --- | --- | --- |\n");
  for (const Course& course : kCourses) {
    scenario->lidar = course.kind;
    scenario->perception = course.level;
    for (RobotSpec& robot : scenario->robots) robot.settings.perception = course.level;
    double least_cpu = 0, least_wall = 0;
    std::string digest;
    for (int n = 0; n < repeats; ++n) {
      const double before = processor_s();
      const auto outcome = rehearse(*scenario, *world, params);
      if (!outcome) return fail(outcome.error());
      const double cpu = processor_s() - before;
      least_cpu = n == 0 ? cpu : std::min(least_cpu, cpu);
      least_wall = n == 0 ? outcome->report.wall_s : std::min(least_wall, outcome->report.wall_s);
      digest = outcome->report.digest;
    }
    const double virtual_s = seconds(scenario->duration);
    fmt::print("| {} | {} | {:.4f} | {:.1f} | {} |\n", course.lidar, course.perception, least_cpu / virtual_s,
               virtual_s / least_wall, digest);
    std::fflush(stdout);
  }
  return 0;
}
