// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bench/alerts/alert_count.hpp"
#include "bench/alerts/alert_judge.hpp"
#include "sim/rehearsal/rehearsal.hpp"

namespace adit::bench {

/// One operator in one run, who looks at each alert for AlertCount::kHandled.
struct JudgedOperator {
  std::uint64_t seed{};
  std::string station{};
  AlertCount alerts{};
  std::unique_ptr<AlertJudge> judge{};
  double minutes{};
  std::size_t faults{};
  bool drives{};  ///< He holds a robot at some time.
};

/// Rehearses a scenario and runs the alerts of each of its operators. Errors: those of rehearse().
Result<std::vector<JudgedOperator>> judged_run(const sim::Scenario& scenario,
                                               const std::shared_ptr<const sim::World>& world,
                                               std::uint64_t seed);

}  // namespace adit::bench
