// SPDX-License-Identifier: Apache-2.0
// How often the operator's window calls its operator, measured on virtual time.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>

#include "basestation/model/text.hpp"
#include "bench/alerts/judged_run.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace {

using namespace adit;

using Sample = bench::JudgedOperator;

void print(const std::string& name, const std::vector<Sample>& samples, bool all_calls) {
  int urgent = 0, soon = 0;
  double minutes = 0.0, worst = 0.0, faults = 0.0;
  std::map<std::string, int> by_code;
  for (const Sample& sample : samples) {
    const int calls = sample.alerts.urgent() + sample.alerts.soon();
    urgent += sample.alerts.urgent();
    soon += sample.alerts.soon();
    minutes += sample.minutes;
    faults += static_cast<double>(sample.faults);
    worst = std::max(worst, 10.0 * calls / std::max(sample.minutes, 1e-9));
    for (const auto& [code, count] : sample.alerts.by_code()) by_code[code] += count;
    if (all_calls)
      for (const std::string& call : sample.alerts.calls())
        fmt::print("  seed {} {}: {}\n", sample.seed, sample.station, call);
  }
  const double calls = urgent + soon;
  fmt::print("{:<24} {:>8.1f} {:>8.1f} {:>8.1f} {:>7.0f} % {:>8.1f} {:>9}\n", name, minutes,
             10.0 * calls / std::max(minutes, 1e-9), worst, calls > 0 ? 100.0 * urgent / calls : 0.0,
             10.0 * faults / std::max(minutes, 1e-9),
             faults > 0 ? fmt::format("{:.2f}", calls / faults) : "-");
  std::vector<std::pair<int, std::string>> codes;
  for (const auto& [code, count] : by_code) codes.emplace_back(-count, code);
  std::ranges::sort(codes);
  std::string line;
  for (const auto& [count, code] : codes)
    line += fmt::format("{}{} {}", line.empty() ? "" : ", ", -count, code);
  fmt::print("    {}\n", line.empty() ? "none" : line);
  bench::AlertJudge::Figures all;
  for (const Sample& sample : samples) {
    const bench::AlertJudge::Figures& one = sample.judge->figures();
    all.judged += one.judged;
    all.wrong += one.wrong;
    all.other += one.other;
    all.losses += one.losses;
    all.missed += one.missed;
    all.silent_stands += one.silent_stands;
    all.slowest = std::max(all.slowest, one.slowest);
    for (const std::string& complaint : sample.judge->complaints())
      fmt::print("    seed {} {}: {}\n", sample.seed, sample.station, complaint);
  }
  fmt::print(
      "    judged by the truth: {} of {} alerts false ({} of what it does not know), {} of {} losses missed, "
      "shown within {:.1f} s, {} silent stands\n",
      all.wrong, all.judged, all.other, all.missed, all.losses, all.slowest, all.silent_stands);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"How often the window calls an operator: alerts that need an action, in rehearsals.",
               "bench_alerts"};
  std::vector<std::string> files{"config/scenarios/team_chaos.yaml"};
  int seeds = 20, jobs = 2;
  bool all_calls = false;
  app.add_option("scenario", files, "scenarios")->capture_default_str();
  app.add_option("--seeds", seeds, "runs of each")->capture_default_str()->check(CLI::Range(1, 100000));
  app.add_option("--jobs", jobs, "runs at a time")->capture_default_str()->check(CLI::Range(1, 64));
  app.add_flag("--calls", all_calls, "list each call");
  app.footer("Example: build/release/bin/bench_alerts config/scenarios/demo.yaml --seeds 5 --calls");
  CLI11_PARSE(app, argc, argv);
  fmt::print("{:<24} {:>8} {:>8} {:>8} {:>9} {:>8} {:>9}\n", "per operator", "minutes", "/10 min", "worst",
             "urgent", "faults/10", "per fault");
  bool failed = false;
  for (const std::string& file : files) {
    const auto scenario = sim::load_scenario(file);
    if (!scenario) {
      fmt::print(stderr, "{}\n", scenario.error().text);
      return 2;
    }
    const auto world = sim::make_world(scenario->world);
    if (!world) {
      fmt::print(stderr, "{}\n", world.error().text);
      return 2;
    }
    std::vector<Sample> samples;
    std::mutex mutex;
    std::atomic<int> next{1};
    const auto work = [&] {
      for (int seed = next++; seed <= seeds; seed = next++) {
        auto result = bench::judged_run(*scenario, *world, static_cast<std::uint64_t>(seed));
        const std::lock_guard guard(mutex);
        if (!result) {
          fmt::print(stderr, "{}: {}\n", file, result.error().text);
          failed = true;
          continue;
        }
        for (Sample& sample : *result)
          if (sample.drives) samples.push_back(std::move(sample));
      }
    };
    {
      std::vector<std::jthread> threads;
      for (int i = 0; i < jobs; ++i) threads.emplace_back(work);
    }
    std::ranges::sort(samples, {},
                      [](const Sample& sample) { return std::pair(sample.seed, sample.station); });
    print(std::filesystem::path(file).stem().string(), samples, all_calls);
  }
  return failed ? 1 : 0;
}
