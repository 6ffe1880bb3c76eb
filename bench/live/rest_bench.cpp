// SPDX-License-Identifier: Apache-2.0
// What an agent costs at rest, in processes of their own on loopback: CPU and memory without and with a lidar
// running, and the radio's bytes with four agents and one station, as `basestation net` prints them.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/live/process.hpp"

namespace {

using adit::live::Folder;
using adit::live::Process;
using adit::live::Seconds;

constexpr int kSettle = 8;    // s: discovery, first scans
constexpr int kMeasure = 20;  // s

struct Usage {
  double cpu_s{};
  double rss_mb{};
};

/// User and system time so far, and resident memory.
Usage usage(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string text((std::istreambuf_iterator<char>(stat)), {});
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::vector<std::string> f{std::istream_iterator<std::string>(fields), {}};
  const double ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
  return {(std::stod(f.at(11)) + std::stod(f.at(12))) / ticks,
          std::stod(f.at(21)) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6};
}

std::string robot_file(const Folder& folder, unsigned index, unsigned base) {
  const std::string name = "r" + std::to_string(index);
  return folder.write(name + ".yaml",
                      "name: " + name + "\nplatform: wheeled\npose: [0, " + std::to_string(3 * index) +
                          ", 0]\nradio: {domain: " + std::to_string(base) + "}\nrobot_domain: " +
                          std::to_string(base + index) + "\ntree: trees/robot.xml\nlog: error\n");
}

std::unique_ptr<Process> agent(const Folder& folder, unsigned index, unsigned base) {
  return std::make_unique<Process>(
      std::vector<std::string>{"robot_agent", "--config", robot_file(folder, index, base)},
      folder.environment());
}

void wait(int seconds) { std::this_thread::sleep_for(std::chrono::seconds(seconds)); }

void at_rest(benchmark::State& state, bool lidar) {
  const Folder folder;
  const unsigned base = adit::live::domain();
  std::unique_ptr<Process> world;
  if (lidar) {
    const std::string scenario =
        folder.write("rest.yaml",
                     "world: {boxes: [[-6, 6, -6, -5.7, 0, 2], [-6, 6, 8, 8.3, 0, 2], [5.7, 6, -6, 8, 0, "
                     "2]], floor: 0, ceiling: 3}\n"
                     "duration: 600\nlidar: full\nrobots:\n  - {id: r1, platform: wheeled, pose: [0, 3, 0]}\n"
                     "basestations:\n  - {id: op1, pose: [0, 0]}\n");
    world = std::make_unique<Process>(
        std::vector<std::string>{"simulate", scenario, "--domain-base", std::to_string(base)},
        folder.environment());
    if (!world->wait_for_output("simulate: ready", Seconds(20))) return state.SkipWithError("no simulator");
  }
  auto robot = agent(folder, 1, base);
  for (auto _ : state) {
    wait(kSettle);
    const Usage before = usage(robot->pid());
    wait(kMeasure);
    const Usage after = usage(robot->pid());
    state.SetIterationTime(after.cpu_s - before.cpu_s);
    state.counters["cpu_percent_of_a_core"] = (after.cpu_s - before.cpu_s) / kMeasure * 100.0;
    state.counters["rss_MB"] = after.rss_mb;
  }
}

void radio_at_rest(benchmark::State& state) {
  const Folder folder;
  const unsigned base = adit::live::domain();
  std::vector<std::unique_ptr<Process>> robots;
  for (unsigned i = 1; i <= 4; ++i) robots.push_back(agent(folder, i, base));
  for (auto _ : state) {
    const std::vector<std::string> station{"basestation", "--name", "op1", "--domain", std::to_string(base)};
    auto command = [&](const std::string& word) {
      std::vector<std::string> all = station;
      all.push_back(word);
      return adit::live::run(all, folder.environment());
    };
    command("up");
    wait(kSettle + 10);
    const auto net = command("net");
    std::printf("%s%s", net.out.c_str(), net.err.c_str());
    command("down");
    state.SetIterationTime(1.0);
  }
}

BENCHMARK_CAPTURE(at_rest, no_lidar, false)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(at_rest, lidar, true)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(radio_at_rest)->Name("radio_at_rest/four_agents_one_station")->UseManualTime()->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
