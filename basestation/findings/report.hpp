// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "basestation/findings/desk.hpp"
#include "basestation/fleet/fleet.hpp"

namespace adit::station {

/// The findings of the named robots, or of all, as text; the most important first.
std::string findings_text(const FindingDesk& desk, const Fleet& fleet,
                          const std::vector<std::string>& robots);
nlohmann::json findings_json(const FindingDesk& desk, const Fleet& fleet,
                             const std::vector<std::string>& robots);

}  // namespace adit::station
