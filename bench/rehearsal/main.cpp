// SPDX-License-Identifier: Apache-2.0
// How much processor time a rehearsal takes: the demo, with each level of perception and both lidars.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
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

/// Parts of the processor time, see part_of().
enum Part { simulation, sensors, navigation, perception, wire, rest, kParts };
constexpr std::array<const char*, kParts> kPartNames{
    "simulation", "input and odometry", "navigation", "maps, stairs, objects", "wire", "rest"};

/// The part that a strand, by the last part of its name, and its computation belong to.
Part part_of(std::string_view strand, std::string_view job) {
  if (strand == "world" || strand == "driver") return simulation;
  if (strand == "events") return wire;  // The simulated network.
  if (strand == "sensors") return sensors;
  if (strand == "planner" || strand == "router" || job == "obstacles") return navigation;
  // Other computations of the command strand are about submaps and keyframes.
  if (strand == "map" || strand == "stairs" || strand == "objects" || !job.empty()) return perception;
  return rest;
}

/// Sums up what a run uses.
class Uses {
 public:
  /// To be called from any thread.
  OnUse adder() {
    return [this](const std::string& strand, const std::string& job, Duration used) {
      const std::string name = strand.substr(strand.rfind('/') + 1);
      const std::lock_guard lock(mutex_);
      parts_[part_of(name, job)] += seconds(used);
      strands_[job.empty() ? name : name + ": " + job] += seconds(used);
    };
  }
  const std::array<double, kParts>& parts() const { return parts_; }  ///< s
  /// By strand and computation, s.
  const std::map<std::string, double>& strands() const { return strands_; }

 private:
  std::mutex mutex_{};
  std::array<double, kParts> parts_{};
  std::map<std::string, double> strands_{};
};

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
  bool each = false;
  app.add_flag("--each", each, "print the time of each strand and computation, too, on stderr");
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
  std::string split, rule;
  for (int n = 0; n < kParts; ++n) rule += " --- |";
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
    // One more run: what reads the clock costs time itself.
    Uses uses;
    params.on_use = uses.adder();
    const auto outcome = rehearse(*scenario, *world, params);
    params.on_use = {};
    if (!outcome) return fail(outcome.error());
    split += fmt::format("| {} | {} |", course.lidar, course.perception);
    for (const double used : uses.parts()) split += fmt::format(" {:.1f} |", 1e3 * used / virtual_s);
    split += '\n';
    if (!each) continue;
    for (const auto& [strand, used] : uses.strands())
      std::fprintf(stderr, "%s %s, %s: %.2f ms\n", course.lidar, course.perception, strand.c_str(),
                   1e3 * used / virtual_s);
  }
  fmt::print("\nms of CPU per virtual second:\n\n| lidar | perception | {} |\n| --- | --- |{}\n{}",
             fmt::join(kPartNames, " | "), rule, split);
  return 0;
}
