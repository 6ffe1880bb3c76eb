// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/supervisor/health_message.hpp"

#include "robot_agent/common/clipped.hpp"

namespace adit::agent {
namespace {

constexpr std::size_t kHealthText = 200;

radio::ComponentState to_radio(PartState state) {
  switch (state) {
    case PartState::starting:
      return radio::COMPONENT_STARTING;
    case PartState::up:
      return radio::COMPONENT_UP;
    case PartState::waiting:
      return radio::COMPONENT_WAITING;
    case PartState::failed:
      return radio::COMPONENT_FAILED;
    case PartState::hung:
      return radio::COMPONENT_HUNG;
  }
  return radio::COMPONENT_FAILED;
}

}  // namespace

radio::Health to_radio(const std::vector<ComponentRow>& components, const std::string& robot) {
  radio::Health out;
  out.robot(robot);
  for (const ComponentRow& c : components) {
    radio::ComponentHealth part;
    part.name(c.name);
    part.state(to_radio(c.state));
    part.healthy(c.healthy);
    part.automatic(c.automatic);
    part.silent_for(static_cast<float>(seconds(c.silent)));
    part.restarts(c.restarts);
    part.hung(c.hung);
    part.text(clipped(c.text, kHealthText));
    out.components().push_back(part);
  }
  return out;
}

}  // namespace adit::agent
