// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/robot.hpp"

#include "basestation/model/world.hpp"

namespace adit::station {

bool is_by_hand(std::string_view mode) { return mode == "manual" || mode == "smart_joystick"; }

const char* to_string(GoalPhase phase) {
  constexpr std::array kNames{"none", "kept", "active", "blocked", "reached"};
  const auto index = static_cast<std::size_t>(phase);
  return index < kNames.size() ? kNames[index] : "unknown";
}

const char* to_string(ExplorationPhase phase) {
  constexpr std::array kNames{"none", "starting", "exploring", "travelling", "reporting", "done", "ended"};
  const auto index = static_cast<std::size_t>(phase);
  return index < kNames.size() ? kNames[index] : "unknown";
}

const char* to_string(Level level) {
  constexpr std::array kNames{"info", "warning", "error"};
  const auto index = static_cast<std::size_t>(level);
  return index < kNames.size() ? kNames[index] : "unknown";
}

const Robot* World::robot(const std::string& name) const {
  for (const Robot& robot : robots)
    if (robot.name == name) return &robot;
  return nullptr;
}

}  // namespace adit::station
