// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "sim/rehearsal/rehearsal.hpp"

namespace adit::sim {

/// Draws a run: the world from above, each robot's way, the goals it accepted, and what happened where.
/// Errors: cannot_write; as Simulation::create.
Result<void> draw_run(const Scenario& scenario, const World& world, const RunOutcome& outcome,
                      const std::filesystem::path& file);

}  // namespace adit::sim
