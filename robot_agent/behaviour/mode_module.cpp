// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/mode_module.hpp"

namespace adit::agent {

Result<void> ModeModule::check_goal(const Eigen::Vector3d&, Facts&) const {
  return {Reason::not_supported, "goto: the mode takes no goal"};
}

}  // namespace adit::agent
