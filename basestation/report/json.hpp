// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>

#include "basestation/fleet/fleet.hpp"
#include "basestation/model/action.hpp"
#include "basestation/send/answer.hpp"

/// Reports of the station as JSON, for scripts: each function returns one value; unknown values are omitted
/// or null. Units as in the views: m, rad, m/s, s, bytes/s.
namespace adit::station {

/// Returns an array of the notices of one robot, oldest first; an empty name: all notices.
nlohmann::json notices_json(const Fleet& fleet, const std::string& robot, Time now);
nlohmann::json answer_json(const Answer& answer);
nlohmann::json actions_json(const std::vector<Action>& actions);
NetworkReport network_report(const Fleet& fleet, Time now);
HealthReport health_report(const std::vector<const RobotView*>& robots);

/// Returns {"robots": [...], "stations": [...]}.
nlohmann::json list_json(const Fleet& fleet, Time now);

}  // namespace adit::station
