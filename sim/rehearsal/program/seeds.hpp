// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <optional>

#include "sim/rehearsal/program/options.hpp"
#include "sim/rehearsal/rehearsal.hpp"

namespace adit::sim {

/// What many runs of one scenario gave.
struct SeedsOutcome {
  std::uint64_t done{}, wanted{};
  std::map<std::uint64_t, RunReport> failed{};  ///< By seed.
  std::optional<Error> broken{};                ///< Error of a run that could not start.
  std::uint64_t fewest_commands{}, fewest_faults{}, commands{}, faults{};
  double virtual_s{}, wall_s{};  ///< `wall_s`: of all runs together.
};

/// One run for each seed, as many at a time as there are cores, and a line of a table for each. Ctrl-C ends
/// it after the runs under way. `until_failure`: no new run begins once one has failed.
SeedsOutcome run_seeds(const Scenario& scenario, const std::shared_ptr<const World>& world,
                       const RunParams& params, const SeedRange& seeds, bool until_failure);

/// One line on stderr for each thing that failed.
void print_complaints(const RunReport& report);

}  // namespace adit::sim
