// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "basestation/map/map_receiver.hpp"

namespace adit::station {

/// What this station has of each robot's map, as aligned text.
std::string map_status_text(const MapReceiver& map, Time now);
nlohmann::json map_status_json(const MapReceiver& map, Time now);

}  // namespace adit::station
