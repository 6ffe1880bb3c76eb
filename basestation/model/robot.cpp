// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/robot.hpp"

#include "basestation/model/world.hpp"

namespace adit::station {

bool is_by_hand(std::string_view mode) { return mode == "manual" || mode == "smart_joystick"; }

const Robot* World::robot(const std::string& name) const {
  for (const Robot& robot : robots)
    if (robot.name == name) return &robot;
  return nullptr;
}

}  // namespace adit::station
