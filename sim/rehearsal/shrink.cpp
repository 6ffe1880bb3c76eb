// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/shrink.hpp"

#include <algorithm>
#include <cmath>

#include "core/time/random.hpp"
#include "sim/rehearsal/ddmin.hpp"
#include "sim/rehearsal/random_faults.hpp"
#include "sim/rehearsal/random_script.hpp"
#include "sim/rehearsal/rehearsal.hpp"

namespace adit::sim {
namespace {

constexpr Duration kAfterFailure{500ms};
constexpr Duration kShortestWindow{100ms};

template <class T>
std::vector<T> only(const std::vector<T>& all, const Indices& remaining) {
  std::vector<T> out;
  for (std::size_t i : remaining) out.push_back(all[i]);
  return out;
}

/// One shrinking: the smallest scenario so far, and the runs that it took.
class Shrinking {
 public:
  Shrinking(const Scenario& scenario, const Failure& failure, const RunScenario& run,
            const ShrinkParams& params)
      : run_(run), params_(params), result_{scenario, failure, 0} {}

  ShrinkResult go() {
    truncate();
    faults();
    script();
    faults();
    windows();
    truncate();
    return std::move(result_);
  }

 private:
  // Takes the candidate when it fails as the first did.
  bool take(Scenario candidate, const char* what) {
    if (result_.runs >= params_.max_runs || (params_.stop && params_.stop())) return false;
    ++result_.runs;
    const auto report = run_(candidate);
    if (params_.progress) params_.progress(what, result_.runs);
    if (!report) return false;
    const auto failure = failure_of(candidate, *report);
    if (!failure || !failure->same(result_.failure)) return false;
    result_.scenario = std::move(candidate);
    result_.failure = *failure;
    return true;
  }

  void truncate() {
    // An expectation is judged at its own time, and needs the whole run.
    if (result_.failure.rule == 0) return;
    Scenario shorter = result_.scenario;
    const Duration end = std::chrono::ceil<std::chrono::seconds>(result_.failure.at + kAfterFailure);
    shorter.duration = std::min(shorter.duration, end);
    std::erase_if(shorter.script, [&](const ScriptLine& l) { return l.at > result_.failure.at; });
    std::erase_if(shorter.faults, [&](const Fault& f) { return f.at > result_.failure.at; });
    take(std::move(shorter), "time");
  }

  void faults() {
    const Scenario all = result_.scenario;
    const Fails fails = [&](const Indices& remaining) {
      Scenario candidate = all;
      candidate.faults = only(all.faults, remaining);
      return take(std::move(candidate), "faults");
    };
    // What fails becomes the result at once: the last that fails is the smallest.
    ddmin(all.faults.size(), fails);
    const Scenario less = result_.scenario;
    const Fails smaller = [&](const Indices& remaining) {
      Scenario candidate = all;
      candidate.faults = only(all.faults, remaining);
      candidate.script = less.script;
      return take(std::move(candidate), "fewer faults");
    };
    if (less.faults.size() > 1) (void)fewer(all.faults.size(), less.faults.size(), 2, most_choices, smaller);
  }

  void script() {
    const Scenario all = result_.scenario;
    ddmin(all.script.size(), [&](const Indices& remaining) {
      Scenario candidate = all;
      candidate.script = only(all.script, remaining);
      return take(std::move(candidate), "commands");
    });
  }

  void windows() {
    for (std::size_t i = 0; i < result_.scenario.faults.size(); ++i)
      for (bool shorter = true; shorter;) {
        Scenario candidate = result_.scenario;
        Duration* window = duration_of(candidate.faults[i]);
        if (window == nullptr || *window / 2 < kShortestWindow) break;
        *window = std::chrono::floor<std::chrono::milliseconds>(*window / 2);
        shorter = take(std::move(candidate), "windows");
      }
  }

  static constexpr std::size_t most_choices = 60;
  const RunScenario& run_;
  const ShrinkParams& params_;
  ShrinkResult result_;
};

}  // namespace

std::optional<Failure> failure_of(const Scenario& scenario, const RunReport& report) {
  std::optional<Failure> first;
  for (const RuleResult& rule : report.rules)
    if (rule.violations > 0 && !rule.first.empty() && (!first || rule.first.front().at < first->at))
      first = Failure{rule.number, 0, rule.first.front().at,
                      rule.first.front().robot + ": " + rule.first.front().text};
  if (first) return first;
  for (std::size_t i = 0; i < report.expectations.size(); ++i) {
    const ExpectationResult& e = report.expectations[i];
    if (!e.ok && !std::holds_alternative<AtLeast>(scenario.expectations[i].what))
      return Failure{0, e.line, scenario.duration, e.text + ": " + e.found};
  }
  if (report.failures > 0) return Failure{0, 0, scenario.duration, "an exception left a task"};
  return std::nullopt;
}

Scenario written_out(const Scenario& scenario, std::uint64_t seed) {
  Scenario out = scenario;
  out.seed = seed;
  const Draws drawn = draw(scenario, seed);
  out.script.insert(out.script.end(), drawn.script.begin(), drawn.script.end());
  out.faults.insert(out.faults.end(), drawn.faults.begin(), drawn.faults.end());
  const auto by_time = [](const auto& a, const auto& b) { return a.at < b.at; };
  std::stable_sort(out.script.begin(), out.script.end(), by_time);
  std::stable_sort(out.faults.begin(), out.faults.end(), by_time);
  out.random.reset();
  out.random_faults.reset();
  return out;
}

ShrinkResult shrink(const Scenario& scenario, const Failure& failure, const RunScenario& run,
                    const ShrinkParams& params) {
  return Shrinking(scenario, failure, run, params).go();
}

}  // namespace adit::sim
