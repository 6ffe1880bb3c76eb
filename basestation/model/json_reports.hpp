// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>

#include "basestation/model/found.hpp"
#include "basestation/model/health.hpp"
#include "basestation/model/network.hpp"

/// The reports of queries as JSON, as model/json.hpp for the rest of the model.
namespace adit::station {

nlohmann::json json_of(const RobotHealth& health);
nlohmann::json json_of(const HealthReport& report);
nlohmann::json json_of(const NetworkReport& report);
nlohmann::json json_of(const FoundReport& report);

}  // namespace adit::station
