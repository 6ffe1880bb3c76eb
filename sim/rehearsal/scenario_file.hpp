// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "core/result/result.hpp"
#include "sim/rehearsal/scenario.hpp"

namespace adit::sim {

/// Reads a scenario. Every wrong key, value, name or time is an error that names file, line and what was
/// expected; maps, link profiles and platforms are looked for beside the scenario first. Errors: as
/// core/config gives them, and not_supported for faults in components.
Result<Scenario> load_scenario(const std::string& file);
/// The same from memory; `file` is the name that messages show, and says where "beside" is.
Result<Scenario> parse_scenario(const std::string& text, const std::string& file);

/// Reads the world alone: that of a scenario, or of a file that has at its top level what a scenario has
/// under its key `world`. Errors as load_scenario().
Result<WorldSpec> load_world_spec(const std::string& file);

}  // namespace adit::sim
