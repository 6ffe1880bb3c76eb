// SPDX-License-Identifier: Apache-2.0
// goals: random goals in closed loop over generated worlds and platforms, as a table.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "bench/goals/course.hpp"
#include "bench/goals/knowable.hpp"
#include "core/config/platform_file.hpp"
#include "sim/rehearsal/rehearsal.hpp"

namespace {

using namespace adit;
using namespace adit::bench;

struct Outcome {
  Course course{};
  std::string error{};
  bool arrived{}, reported{};  ///< `reported`: it was reported unreachable.
  int collisions{};
  double clearance{}, seconds{}, told_after{};
  std::optional<double> reported_late{};  ///< Delay of the report, s; negative: early; empty: never provable.
};

constexpr double kArrived = 0.35;   // m: the goal's tolerance, and what a scan is off by
constexpr double kDrift = 0.03;     // of the way: what dead reckoning is off by, three deviations
constexpr double kLook = 1.0;       // s: as exact as the other time is known
constexpr double kSent = 4.0;       // s: when the goal is sent
constexpr double kReported = 10.0;  // s: delay within which an unreachable goal must be reported

/// From when the goal was sent until what the robot saw proves that it cannot get there, s.
std::optional<double> knowable_after(const Course& course, std::span<const Pose2> poses) {
  const auto made = sim::generate_world(course.kind, course.seed);
  const auto body = config::load_platform(course.platform, {});
  const auto world = sim::make_box_world(made->boxes, 0.0, 3.0);
  const sim::StandingMap map(*world, body->height, body->step);
  const auto at = knowable_at(course, map, 0.5 * body->width, poses);
  if (!at) return std::nullopt;
  return std::max(0.0, 0.1 * static_cast<double>(*at) - kSent);
}

Outcome run(const Course& course, const sim::AgentFactory& agents, double slowness, bool planar) {
  Outcome out{.course = course};
  const auto scenario = scenario_of(course, slowness, planar);
  if (!scenario) return out.error = scenario.error().text, out;
  const auto world = sim::make_world(scenario->world);
  if (!world) return out.error = world.error().text, out;
  sim::RunParams params{};
  params.seed = course.seed;
  params.workers = 1;
  params.make_agent = agents;
  const auto done = sim::rehearse(*scenario, *world, params);
  if (!done) return out.error = done.error().text, out;
  const auto& robot = done->report.robots.at("r1");
  out.collisions = robot.collisions;
  out.clearance = robot.min_clearance;
  const auto& poses = done->trails.at("r1").poses;
  // Arrived is who stands there at the end; the time is that of the first pose which was as near.
  const double near = kArrived + kDrift * robot.distance;
  const auto off = [&](const Pose2& pose) { return (pose.position() - course.goal).norm(); };
  out.arrived = !poses.empty() && off(poses.back()) < near;
  const auto first = std::find_if(poses.begin(), poses.end(), [&](const Pose2& p) { return off(p) < near; });
  out.seconds = 0.1 * static_cast<double>(first - poses.begin()) - kSent;
  for (const sim::TimedEvent& event : done->report.events) {
    if (out.reported || event.text.find("no way to its goal") == std::string::npos) continue;
    out.reported = true;
    out.told_after = std::chrono::duration<double>(event.at).count() - kSent;
  }
  if (!out.reported || course.reachable) return out;
  if (const auto known = knowable_after(course, poses)) out.reported_late = out.told_after - *known;
  return out;
}

bool as_it_should_be(const Outcome& o) {
  if (!o.error.empty() || o.collisions > 0) return false;
  return o.course.reachable ? o.arrived : o.reported && o.reported_late.value_or(0.0) <= kReported;
}

struct Row {
  int reachable{}, arrived{}, apart{}, reported{}, unproven{}, collided{}, broken{};
  double clearance{1e9}, ratio{}, latest{}, late{};
  void add(const Outcome& o) {
    broken += !o.error.empty();
    if (!o.error.empty()) return;
    collided += o.collisions > 0;
    clearance = std::min(clearance, o.clearance);
    if (!o.course.reachable) {
      ++apart;
      reported += o.reported;
      latest = std::max(latest, o.told_after);
      if (o.reported_late) late = std::max(late, *o.reported_late);
      unproven += o.reported && (!o.reported_late || *o.reported_late < -kLook);
      return;
    }
    ++reachable;
    if (!o.arrived) return;
    ++arrived;
    ratio += o.seconds / (o.course.straight / o.course.speed);
  }
  void print(const std::string& name) const {
    fmt::print("| {} | {} | {} | {} | {} | {:.1f} | {:.1f} | {} | {} | {:.2f} | {:.1f} | {} |\n", name,
               reachable, arrived, apart, reported, latest, late, unproven, collided,
               clearance > 1e8 ? 0.0 : clearance, arrived > 0 ? ratio / arrived : 0.0, broken);
  }
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Random goals in closed loop: generated worlds, every platform, noisy odometry and lidar."};
  std::vector<std::string> kinds(sim::navigation_kinds().begin(), sim::navigation_kinds().end());
  std::vector<std::string> platforms{"wheeled", "tracked", "legged", "car"};
  int goals = 500;
  std::uint64_t first = 1;
  double slowness = 4.0;
  bool planar = false, each = false;
  std::string save;
  app.add_option("--goals", goals, "how many (default 500)")->check(CLI::Range(1, 100000));
  app.add_option("--first", first, "the first seed (default 1)");
  app.add_option("--kinds", kinds, "worlds (default all)")->check(CLI::IsMember(kinds));
  app.add_option("--platforms", platforms, "platforms (default wheeled tracked legged car)");
  app.add_option("--slowness", slowness,
                 "time allowed, in drives of the shortest way at half speed (default 4)");
  app.add_flag("--planar", planar, "one ring instead of the full lidar: faster");
  app.add_option("--save", save,
                 "folder for the scenarios of those goals: KIND.yaml in one named after the seed");
  app.add_flag("--each", each, "a line for each goal that was not as it should be");
  app.footer("Examples:\n  goals --goals 500\n  goals --goals 20 --kinds cave maze --each");
  CLI11_PARSE(app, argc, argv);

  const auto agents = sim::make_agent_factory();
  if (!agents) return std::fprintf(stderr, "goals: %s\n", agents.error().text.c_str()), 1;
  std::vector<Outcome> outcomes(static_cast<std::size_t>(goals));
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t n = next++; n < outcomes.size(); n = next++) {
      const std::string& kind = kinds[n % kinds.size()];
      const std::string& platform = platforms[n / kinds.size() % platforms.size()];
      const auto course = draw_course(kind, platform, first + n);
      if (course)
        outcomes[n] = run(*course, *agents, slowness, planar);
      else
        outcomes[n] = {.course = {kind, platform, first + n, {0, 0}, {0, 0}, 0, 0, 1, true},
                       .error = course.error().text};
      std::fprintf(stderr, "\r%zu of %zu ", n + 1, outcomes.size());
    }
  };
  std::vector<std::thread> workers;
  for (unsigned n = 0; n < std::max(1u, std::thread::hardware_concurrency()); ++n) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  std::fprintf(stderr, "\r");

  std::map<std::string, Row> by_kind, by_platform;
  Row all;
  for (const Outcome& o : outcomes) {
    for (Row* row : {&by_kind[o.course.kind], &by_platform[o.course.platform], &all}) row->add(o);
    const bool good = as_it_should_be(o);
    if (!good && o.error.empty() && !save.empty()) {
      const std::filesystem::path folder = std::filesystem::path(save) / std::to_string(o.course.seed);
      std::filesystem::create_directories(folder);
      std::ofstream(folder / (o.course.kind + ".yaml")) << scenario_text(o.course, slowness, planar);
    }
    if (each && !good)
      fmt::print("{} {} seed {}: ({:.1f}, {:.1f}) to ({:.1f}, {:.1f}){}{}{} {}\n", o.course.kind,
                 o.course.platform, o.course.seed, o.course.start.x(), o.course.start.y(), o.course.goal.x(),
                 o.course.goal.y(), o.collisions > 0 ? ", collided" : "",
                 o.course.reachable && !o.arrived ? ", not reached" : "",
                 !o.course.reachable && !good && o.error.empty() && o.collisions == 0
                     ? ", out of reach and that was not reported in time"
                     : "",
                 o.error);
  }
  fmt::print(
      "| | goals | reached | out of reach | reported | at the latest after, s | after it could be known, s | "
      "reported "
      "without proof | with a collision | smallest clearance, m | time / straight drive | failed to run |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const auto& [name, row] : by_kind) row.print(name);
  for (const auto& [name, row] : by_platform) row.print(name);
  all.print("all");
  return 0;
}
