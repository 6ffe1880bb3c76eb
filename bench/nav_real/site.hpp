// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "bench/nav_real/goal_run.hpp"
#include "bench/nav_real/rows.hpp"
#include "bench/nav_real/true_map.hpp"

namespace adit::bench {

/// The building that is driven in, and what makes its agents.
struct Site {
  std::shared_ptr<const sim::World> world{};
  sim::AgentFactory agents{};
};
/// geb079.bt, from where `./run setup` puts it. Errors of the file.
Result<Site> open_site();
/// What it is to a platform. Errors of the platform's file.
Result<TrueMap> map_of(const Site& site, const std::string& platform);

/// Of a run that was not as it should be: saves its scenario and prints it, as the options say.
void print_run(const RowOptions& options, const std::string& row, const GoalRun& run,
               const GoalResult& result, double shortest);

}  // namespace adit::bench
