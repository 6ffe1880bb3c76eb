#pragma once
// Included by .cpp files only.
#include <string>
#include <vector>

#include "adit/robot.h"
#include "robot_agent/supervisor/component_row.hpp"

namespace adit::agent {

/// The health report of a robot as it travels on the radio; longer texts are cut.
radio::Health to_radio(const std::vector<ComponentRow>& components, const std::string& robot);

}  // namespace adit::agent
