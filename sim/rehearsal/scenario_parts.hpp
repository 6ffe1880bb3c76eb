// SPDX-License-Identifier: Apache-2.0
#pragma once
// Parts of the scenario reader, private to sim/rehearsal. Each notes what is wrong at the node.
#include <string>
#include <vector>

#include "core/config/node.hpp"
#include "sim/rehearsal/scenario.hpp"

namespace adit::sim {

inline constexpr double kLongestTime = 86400.0;  ///< Of a scenario and of a fault, s.

/// 1 to 32 of [A-Za-z0-9_-].
std::string read_name(const config::Node& node, const char* key);
std::string read_robot(const config::Node& node, const char* key, const Scenario& scenario);
std::string read_station(const config::Node& node, const char* key, const Scenario& scenario);
/// Seconds from 0 to the scenario's duration.
Duration read_time(const config::Node& node, const char* key, const Scenario& scenario);

/// Robots and basestations, with the robots' files and trees.
void read_machines(const config::Node& root, Scenario& out);
/// The name of a profile in config/links/, or a mapping with the profile itself.
wire::LinkProfile read_link(const config::Node& node, const std::string& file);
std::vector<ScriptLine> read_script(const config::Node& root, const Scenario& scenario);
RandomScript read_random(const config::Node& node, const Scenario& scenario);
/// Time for which a fault lasts, key `for`.
Duration read_length(const config::Node& fault);
/// Kinds of faults of a robot's drive and sensors.
const std::vector<std::string>& driver_fault_kinds();
/// Reads one of them.
void read_driver_fault(const config::Node& node, const std::string& kind, const Scenario& scenario,
                       Fault& out);
std::vector<Fault> read_faults(const config::Node& root, const Scenario& scenario);
RandomFaults read_random_faults(const config::Node& node, const Scenario& scenario);
std::vector<Expectation> read_expectations(const config::Node& root, const Scenario& scenario);

}  // namespace adit::sim
