// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "basestation/model/found.hpp"

/// Findings as files for other programs.
namespace adit::station {

/// CSV (RFC 4180), a line for each finding; cells that a spreadsheet would compute begin with an apostrophe.
std::string found_csv(const FoundReport& report);

/// GeoJSON (RFC 7946), a feature for each finding. Coordinates are of the map frame, m, not degrees; the
/// member `frame` of the collection says so. Findings whose place is not finite have no geometry.
std::string found_geojson(const FoundReport& report);

}  // namespace adit::station
