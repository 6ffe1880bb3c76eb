// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/program/shrink_seeds.hpp"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <set>

#include "sim/rehearsal/program/interrupt.hpp"
#include "sim/rehearsal/shrink.hpp"

namespace adit::sim {
namespace {

constexpr std::size_t kMaxShrunk = 3;

std::string default_name(const Scenario& scenario, const Failure& failure) {
  return scenario.name + "-seed" + std::to_string(scenario.seed) +
         (failure.rule > 0 ? "-rule" + std::to_string(failure.rule) : "-expectation") + ".yaml";
}

Result<void> write(const std::string& text, const std::string& file) {
  std::ofstream stream(file);
  stream << text;
  stream.flush();
  if (!stream)
    return {Reason::cannot_write, file + ": cannot be written; check the folder and the space left"};
  return {};
}

Result<void> shrink_one(const Scenario& scenario, const Failure& failure, const RunScenario& run,
                        const std::string& file) {
  const bool tty = isatty(STDERR_FILENO) == 1;
  std::printf("shrinking seed %llu (%zu faults, %zu commands): %s\n",
              static_cast<unsigned long long>(scenario.seed), scenario.faults.size(), scenario.script.size(),
              failure.text.c_str());
  ShrinkParams params;
  params.stop = interrupted;
  if (tty)
    params.progress = [](const std::string& what, std::size_t runs) {
      std::fprintf(stderr, "\rrun %zu: %s          ", runs, what.c_str());
    };
  const ShrinkResult small = shrink(scenario, failure, run, params);
  if (tty) std::fprintf(stderr, "\r                              \r");
  const std::string to = file.empty() ? default_name(scenario, failure) : file;
  const auto text = to_text(small.scenario, small.failure, to);
  if (!text) return text.error();
  if (auto written = write(*text, to); !written) return written;
  std::printf("  %zu runs: %zu faults, %zu commands, %.0f s are left in %s\n", small.runs,
              small.scenario.faults.size(), small.scenario.script.size(), seconds(small.scenario.duration),
              to.c_str());
  for (const Fault& fault : small.scenario.faults) std::printf("    %s\n", to_yaml(fault).c_str());
  return {};
}

}  // namespace

Result<void> shrink_seeds(const Scenario& scenario, const std::shared_ptr<const World>& world,
                          const RunParams& params, const SeedsOutcome& outcome, const std::string& file) {
  const RunScenario run = [&](const Scenario& candidate) -> Result<RunReport> {
    RunParams own = params;
    own.seed = candidate.seed;
    own.progress = nullptr;
    auto result = rehearse(candidate, world, own);
    if (!result) return result.error();
    return std::move(result->report);
  };
  std::set<int> rules;
  for (const auto& [seed, report] : outcome.failed) {
    const auto failure = failure_of(scenario, report);
    if (!failure || rules.size() >= kMaxShrunk || !rules.insert(failure->rule).second) continue;
    const std::string to = rules.size() == 1 ? file : std::string();
    if (auto done = shrink_one(written_out(scenario, seed), *failure, run, to); !done) return done;
  }
  return {};
}

}  // namespace adit::sim
