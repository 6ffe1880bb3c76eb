// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>

#include "basestation/model/map_tiles.hpp"
#include "basestation/model/outcome.hpp"
#include "basestation/model/world.hpp"
#include "core/result/result.hpp"

/// The model as JSON and back: x == read(json_of(x)) for every x that a station reports. Keys and units are
/// those of `--json`: m, rad, m/s, s, bytes/s; unknown values are omitted or null.
///
/// Reading takes a default where a key is missing, as with a station of an older version, and ignores unknown
/// keys. A value of the wrong type or out of range is an error (malformed) that names its key.
namespace adit::station {

/// A value as one line without the newline; bytes that are no UTF-8 are replaced.
std::string line_of(const nlohmann::json& value);

/// For Counts, Robot, Notice, StationSummary, AgentRate, World, CommandEvent, and the reports of queries:
/// HealthReport, NetworkReport, FoundReport, StairsReport.
template <class T>
nlohmann::json json_of(const T& value);
nlohmann::json json_of(const MapUpdate& update);
/// `script`: the outcome's object for scripts.
nlohmann::json outcome_json(int exit_code, const std::string& text, const std::string& error,
                            const nlohmann::json& script);

Result<Robot> robot_from(const nlohmann::json& object);
Result<Notice> notice_from(const nlohmann::json& object);
Result<World> world_from(const nlohmann::json& object);
Result<CommandEvent> event_from(const nlohmann::json& object);
Result<CommandOutcome> outcome_from(const nlohmann::json& object);
Result<MapUpdate> map_update_from(const nlohmann::json& object);

}  // namespace adit::station
