// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "sim/rehearsal/report.hpp"
#include "sim/rehearsal/scenario.hpp"

namespace adit::sim {

/// What a run failed by, of several the one that came first.
struct Failure {
  int rule{};  ///< 0: no rule
  int line{};  ///< Line of the failed expectation, when no rule was broken.
  Duration at{};
  std::string text{};
  /// The same rule, or the same expectation.
  bool same(const Failure& other) const { return rule == other.rule && line == other.line; }
};

/// Nothing when the run is ok, or misses only what is counted over the whole of it (`..._at_least`).
std::optional<Failure> failure_of(const Scenario& scenario, const RunReport& report);

/// The scenario with everything that its seed draws written out: script and faults, and the seed itself.
Scenario written_out(const Scenario& scenario, std::uint64_t seed);

/// Runs a scenario under its own seed.
using RunScenario = std::function<Result<RunReport>(const Scenario&)>;

struct ShrinkParams {
  std::size_t max_runs{600};
  std::function<void(const std::string& what, std::size_t runs)> progress{};
  std::function<bool()> stop{};  ///< Called before each run; true ends the search with its best result.
};

struct ShrinkResult {
  Scenario scenario{};  ///< Fails as the first one did.
  Failure failure{};
  std::size_t runs{};
};

/// Takes away faults, then command lines, then time, as long as the run fails by the same rule: first what
/// comes after the failure, then by ddmin(), then every smaller choice of at most two faults is tried.
/// `scenario` is written out, and fails by `failure`.
ShrinkResult shrink(const Scenario& scenario, const Failure& failure, const RunScenario& run,
                    const ShrinkParams& params);

/// The scenario as a file: its own text, with script, faults, duration and seed in place of what drew them,
/// and no expectation but the one that fails. Errors: not_supported when the text is not laid out with its
/// keys at the beginnings of lines, so that the result would not be read as what it should be.
Result<std::string> to_text(const Scenario& scenario, const Failure& failure, const std::string& file);

}  // namespace adit::sim
