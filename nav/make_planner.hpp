// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "core/result/result.hpp"
#include "nav/local_planner.hpp"

namespace adit::nav {

/// Every planner there is, for configuration files and help; the first one is the default.
const std::vector<std::string>& planner_names();
/// What is told of a name that no planner has: bad_argument, with those there are.
Error no_planner(const std::string& name);
/// Whether the planner that the platform asks for exists and is one for its drive: bad_argument, and why not.
Result<void> fits(const Platform& platform);
/// The planner that the platform asks for. `params` and `library` are those of `trajectories`; the library is
/// built when null. Errors: fits().
Result<std::unique_ptr<Planner>> make_planner(const Platform& platform, const LocalPlannerParams& params = {},
                                              std::shared_ptr<const PlannerLibrary> library = nullptr);

}  // namespace adit::nav
