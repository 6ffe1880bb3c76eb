// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/time/random.hpp"
#include "sim/rehearsal/scenario.hpp"

namespace adit::sim {

/// What random_faults can draw: the kinds of a scenario's faults, and finer ones (crash_agent, ...). Faults
/// of drivers only where perception is on: without it they have other effects than the rules assume.
std::vector<std::string> random_fault_kinds(const Scenario& scenario);
/// The components of a robot's agent that can crash and hang.
const std::vector<std::string>& component_names();

/// The faults that a seed stands for, by time, in whole milliseconds. With perception, a robot always has its
/// lidar or its odometry without a fault.
std::vector<Fault> draw_faults(const RandomFaults& spec, const Scenario& scenario, Random random);

}  // namespace adit::sim
