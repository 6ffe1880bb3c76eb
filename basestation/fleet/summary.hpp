// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "basestation/fleet/fleet.hpp"
#include "basestation/model/world.hpp"

/// What front ends receive of the fleet.
namespace adit::station {

/// All robots by name.
std::vector<Robot> robots_of(const Fleet& fleet, Time now);
/// This station, then the others by name.
std::vector<StationSummary> stations_of(const Fleet& fleet, Time now);
/// The newest notices, at most `most`, oldest first.
std::vector<Notice> notices_of(const Fleet& fleet, std::size_t most, Time now);
std::map<std::string, AgentRate> rates_of(const Fleet& fleet, Time now);

}  // namespace adit::station
