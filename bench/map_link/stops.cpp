// SPDX-License-Identifier: Apache-2.0
// How long stops take while robots send their map, or live pictures, against the same rehearsal without.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "adit/command.h"
#include "core/config/search.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace {

using namespace adit;
using namespace adit::sim;

constexpr int kRobots = 3;
constexpr double kFirst = 45.0;  // s: on a thin link, discovery takes a while.
constexpr double kPeriod = 1.0;  // s between two stops.
constexpr int kStopsInRun = 100;

/// Three robots explore; one after the other is stopped, and goes on.
std::string scenario_text(const std::string& link, bool with, bool camera) {
  std::string out = fmt::format(
      "world: {{generate: blocks, size: 4}}\nodometry: {{noise: 0}}\nduration: {}\nlink: {}\nperception: "
      "{}\nrobots:\n",
      kFirst + kPeriod * (kStopsInRun + 10), link, with && !camera ? "slam" : "odometry");
  for (int i = 1; i <= kRobots; ++i)
    out += fmt::format("  - {{id: r{}, platform: wheeled, pose: [{}, 1.6, 0]{}}}\n", i, 1.6 * i,
                       camera ? ", camera: {}" : "");
  out += "basestations:\n  - {id: op1, pose: [1.6, 1.6]}\nscript:\n";
  std::vector<std::pair<double, std::string>> lines;
  for (int i = 1; i <= kRobots; ++i) {
    lines.emplace_back(30.0 + 0.5 * i, fmt::format("take r{}", i));
    lines.emplace_back(33.0 + 0.5 * i, fmt::format("explore r{}", i));
    if (camera && with) lines.emplace_back(36.0 + 0.5 * i, fmt::format("camera r{} on", i));
  }
  for (int n = 0; n < kStopsInRun; ++n) {
    const double at = kFirst + kPeriod * n;
    const std::string robot = fmt::format("r{}", 1 + n % kRobots);
    lines.emplace_back(at, "stop " + robot);
    lines.emplace_back(at + 0.9, "reset " + robot);
    lines.emplace_back(at + 1.5, "explore " + robot);
  }
  std::sort(lines.begin(), lines.end());
  for (const auto& [at, line] : lines) out += fmt::format("  - {{at: {:.2f}, by: op1, do: {}}}\n", at, line);
  return out;
}

/// When each stop was written first, came to its robot, and was answered.
class Stops {
 public:
  void see(const wire::SampleEvent& event) {
    if (event.topic == wire::topics::kCommand.name) return see_command(event);
    if (event.topic != wire::topics::kAcknowledgement.name ||
        event.kind != wire::SampleEvent::Kind::delivered)
      return;
    radio::Acknowledgement ack;
    if (!wire::decode(event.bytes, ack)) return;
    const auto stop = stops_.find({std::string(ack.robot()), ack.seq()});
    if (stop != stops_.end() && !stop->second.answered) stop->second.answered = event.at;
  }
  /// Appends the times of this run, s; those of stops that never came count as infinite.
  void add_to(std::vector<double>& came, std::vector<double>& answered) const {
    const auto took = [](const std::optional<Duration>& end, Duration from) {
      return end ? seconds(*end - from) : std::numeric_limits<double>::infinity();
    };
    for (const auto& [key, stop] : stops_) {
      came.push_back(took(stop.came, stop.written));
      answered.push_back(took(stop.answered, stop.written));
    }
  }

 private:
  struct Stop {
    Duration written{};
    std::optional<Duration> came{}, answered{};
  };
  void see_command(const wire::SampleEvent& event) {
    radio::Command command;
    if (!wire::decode(event.bytes, command) || command.kind() != radio::CMD_STOP) return;
    const std::pair key{std::string(command.robot()), command.seq()};
    if (event.kind == wire::SampleEvent::Kind::sent) {
      stops_.try_emplace(key, Stop{event.at, {}, {}});
    } else if (event.kind == wire::SampleEvent::Kind::delivered && event.to_name == command.robot()) {
      const auto stop = stops_.find(key);
      if (stop != stops_.end() && !stop->second.came) stop->second.came = event.at;
    }
  }
  std::map<std::pair<std::string, std::uint64_t>, Stop> stops_{};
};

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

struct Measured {
  std::vector<double> came{}, answered{};  ///< s
  std::uint64_t bytes{};                   ///< Of pieces of maps and their acknowledgements.
};

Result<Measured> measure(const std::string& link, bool with, bool camera, int runs, std::uint64_t seed) {
  Measured out;
  const auto beside =
      config::find_file("scenarios/demo.yaml");  // Links and platforms are looked for beside it.
  if (!beside) return beside.error();
  for (int n = 0; n < runs; ++n) {
    std::fprintf(stderr, "%s, %s: run %d of %d\n", link.c_str(), with ? "with" : "without", n + 1, runs);
    const auto scenario = parse_scenario(scenario_text(link, with, camera), *beside);
    if (!scenario) return scenario.error();
    const auto world = make_world(scenario->world);
    if (!world) return world.error();
    const auto agents = make_agent_factory();
    if (!agents) return agents.error();
    Stops stops;
    RunParams params{.seed = seed + static_cast<std::uint64_t>(n), .make_agent = *agents};
    params.on_frame = [&stops](const wire::SampleEvent& event) { stops.see(event); };
    const auto outcome = rehearse(*scenario, *world, params);
    if (!outcome) return outcome.error();
    stops.add_to(out.came, out.answered);
    if (outcome->report.map) out.bytes += outcome->report.map->bytes;
  }
  return out;
}

void print(const std::string& link, const char* what, const std::vector<double>& with,
           const std::vector<double>& without) {
  const double p99 = quantile(with, 0.99), before = quantile(without, 0.99);
  fmt::print("| {} | {} | {} | {:.0f} / {:.0f} | {:.0f} / {:.0f} | {:.0f} / {:.0f} | {:.2f} |{}\n", link,
             what, with.size(), quantile(with, 0.5) * 1e3, quantile(without, 0.5) * 1e3, p99 * 1e3,
             before * 1e3, quantile(with, 1.0) * 1e3, quantile(without, 1.0) * 1e3, p99 / before,
             p99 <= 1.1 * before ? "" : " missed");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "What a stop takes while three exploring robots send their map, or with --camera live pictures, "
      "against "
      "the same without.\n"
      "Example: bench_map_link_stops --stops 1000 --link mesh_100k --camera"};
  int stops = 1000;
  std::uint64_t seed = 1;
  std::vector<std::string> links{"mesh_500k", "mesh_100k"};
  app.add_option("--stops", stops, "stops of each kind and link (default 1000)")
      ->check(CLI::Range(1, 100'000));
  app.add_option("--seed", seed, "of the first run (default 1)");
  app.add_option("--link", links, "profiles of links (default mesh_500k and mesh_100k)");
  bool camera = false;
  app.add_flag("--camera", camera, "with live pictures of each robot in place of the map");
  CLI11_PARSE(app, argc, argv);
  const int runs = (stops + kStopsInRun - 1) / kStopsInRun;
  fmt::print("Milliseconds from the first time that a stop was written, with / without {}.\n\n",
             camera ? "live pictures" : "the map");
  fmt::print("| link | stop | stops | median | p99 | max | p99 with / without (<= 1.1) |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- |\n");
  std::string sent;
  for (const std::string& link : links) {
    const auto with = measure(link, true, camera, runs, seed);
    const auto without = measure(link, false, camera, runs, seed);
    if (!with || !without) {
      std::fprintf(stderr, "bench_map_link_stops: %s\n", (with ? without : with).error().text.c_str());
      return 1;
    }
    print(link, "at the robot", with->came, without->came);
    print(link, "answered", with->answered, without->answered);
    if (!camera)
      sent += fmt::format("{}: {:.1f} kB of map and acknowledgements in a run\n", link,
                          static_cast<double>(with->bytes) / runs / 1e3);
    std::fflush(stdout);
  }
  fmt::print("\n{}", sent);
  return 0;
}
