// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/time/random.hpp"
#include "sim/rehearsal/scenario.hpp"

namespace adit::sim {

/// What random_faults can draw: the kinds of a scenario's faults, and finer ones (crash_agent, ...).
const std::vector<std::string>& random_fault_kinds();
/// The components of a robot's agent that can crash and hang.
const std::vector<std::string>& component_names();

/// The faults that a seed stands for, by time, in whole milliseconds.
std::vector<Fault> draw_faults(const RandomFaults& spec, const Scenario& scenario, Random random);

}  // namespace adit::sim
