// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>

#include "basestation/station.hpp"

namespace adit::station::cli {

/// The contents of the dashboard: the robots and stations of `list`, the newest notices, the traffic of each
/// agent, and this station's counts. Call it on the station's strand.
nlohmann::json snapshot_json(const Station& station);

}  // namespace adit::station::cli
