#pragma once
#include <nlohmann/json.hpp>

#include "basestation/station.hpp"

namespace adit::station::cli {

/// What a dashboard shows: the robots and stations of `list`, the newest notices, what each agent sends, and
/// this station's counts. Called on the station's strand.
nlohmann::json snapshot_json(const Station& station);

}  // namespace adit::station::cli
