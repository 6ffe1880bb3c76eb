// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "core/result/result.hpp"
#include "nav/planners/falco/falco_planner.hpp"

namespace adit::nav {

/// Names of all planners, for configuration files and help; the first one is the default.
const std::vector<std::string>& planner_names();
/// The error for an unknown planner name: bad_argument, with the known names.
Error no_planner(const std::string& name);
/// Checks that the platform's planner exists and supports its drive. Errors: bad_argument, with the cause.
Result<void> fits(const Platform& platform);
/// Creates the planner that the platform names. `library` belongs to `trajectories`; it is built when null.
/// Errors: those of fits().
Result<std::unique_ptr<Planner>> make_planner(const Platform& platform,
                                              std::shared_ptr<const PlannerLibrary> library = nullptr);

}  // namespace adit::nav
