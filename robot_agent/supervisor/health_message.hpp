// SPDX-License-Identifier: Apache-2.0
#pragma once
// Included by .cpp files only.
#include <string>
#include <vector>

#include "adit/robot.h"
#include "robot_agent/supervisor/component_row.hpp"

namespace adit::agent {

/// Makes the health report that a robot sends on the radio domain; long texts are cut.
radio::Health to_radio(const std::vector<ComponentRow>& components, const std::string& robot);

}  // namespace adit::agent
