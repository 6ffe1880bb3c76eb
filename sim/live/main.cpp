// SPDX-License-Identifier: Apache-2.0
// simulate: a scenario's world in real time, on the robots' DDS domains.
#include <csignal>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <ctime>

#include "core/config/usage.hpp"
#include "sim/live/live_world.hpp"
#include "sim/rehearsal/program/report_error.hpp"
#include "sim/rehearsal/run_picture.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace {

using namespace adit;
using namespace adit::sim;

constexpr const char* kExamples =
    "Examples:\n"
    "  simulate config/scenarios/demo.yaml\n"
    "  simulate config/scenarios/demo.yaml --for 130 --report demo.json --picture demo.png\n"
    "Robot k of the scenario is on DDS domain BASE + k: start its agent with robot_agent --robot-domain.\n"
    "Ends by Ctrl-C, SIGTERM or --for. Exit status: 0 every place was reached and nothing was touched, 1 not "
    "so,\n"
    "2 the scenario cannot be read, the world not be opened, or another simulate serves one of its domains.";

/// Until Ctrl-C, SIGTERM or the time is up; SIGUSR1 begins the script.
void wait_for_the_end(const sigset_t& signals, double length, LiveWorld& world) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(length);
  for (;;) {
    int got = 0;
    if (length <= 0.0) {
      sigwait(&signals, &got);
    } else {
      const double left = std::chrono::duration<double>(end - Clock::now()).count();
      if (left <= 0.0) return;
      timespec wait{};
      wait.tv_sec = static_cast<std::time_t>(left);
      wait.tv_nsec = static_cast<long>((left - static_cast<double>(wait.tv_sec)) * 1e9);
      got = sigtimedwait(&signals, nullptr, &wait);
    }
    if (got != SIGUSR1) return;
    world.begin_script();
  }
}

int judge(const Scenario& scenario, const World& world, const RunOutcome& outcome,
          const std::string& report_file, const std::string& picture_file) {
  for (const auto& [id, robot] : outcome.report.robots)
    std::printf("%s: %.1f m, %d collisions, %s\n", id.c_str(), robot.distance, robot.collisions,
                robot.clearance().c_str());
  for (const std::string& line : outcome.report.complaints()) std::fprintf(stderr, "%s\n", line.c_str());
  if (!report_file.empty())
    if (auto written = write_json(outcome.report, report_file); !written)
      return report_error("simulate", written.error());
  if (!picture_file.empty())
    if (auto drawn = draw_run(scenario, world, outcome, picture_file); !drawn)
      return report_error("simulate", drawn.error());
  return outcome.report.ok() ? 0 : kExitFailed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "A scenario's world in real time: bodies, lidars and odometry on the robots' DDS domains (loopback).",
      "simulate"};
  app.footer(kExamples);
  std::string file, report_file, picture_file;
  LiveWorldParams params;
  double length = 0.0;
  app.add_option("scenario", file, "the scenario, SCENARIO.yaml")->required();
  app.add_option("--domain-base", params.domain_base, "robot k is on domain BASE + k")
      ->check(config::between(0, 200))
      ->capture_default_str();
  app.add_option("--seed", params.seed, "of the sensors' noise")
      ->check(config::between(std::uint64_t{0}))
      ->capture_default_str();
  app.add_option("--for", length, "s; without it until Ctrl-C")->check(config::between(0.1, 86400.0));
  app.add_flag("--await-script", params.await_script,
               "times of expectations count from SIGUSR1: the one who plays the script sends it");
  app.add_option("--report", report_file, "write what was true as JSON");
  app.add_option("--picture", picture_file, "write a picture (PNG)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return config::end_usage(app, error);
  }
  // Before any thread exists, so that the signals come to this one.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGUSR1);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  auto scenario = load_scenario(file);
  if (!scenario) return report_error("simulate", scenario.error());
  auto world = make_world(scenario->world);
  if (!world) return report_error("simulate", world.error());
  auto live = LiveWorld::open(*scenario, *world, params);
  if (!live) return report_error("simulate", live.error());
  if (auto started = (*live)->start(); !started) return report_error("simulate", started.error());
  for (std::size_t i = 0; i < scenario->robots.size(); ++i)
    std::printf("%s on domain %u\n", scenario->robots[i].id.c_str(),
                params.domain_base + 1 + static_cast<unsigned>(i));
  std::printf("simulate: ready\n");
  std::fflush(stdout);
  wait_for_the_end(signals, length, **live);
  scenario->link.name = "Fast DDS, live";  // the scenario's link is the rehearsal's
  return judge(*scenario, **world, (*live)->finish(), report_file, picture_file);
}
