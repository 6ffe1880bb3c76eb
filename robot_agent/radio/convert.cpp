// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/radio/convert.hpp"

#include <cmath>

#include "core/contract/camera.hpp"

namespace adit::agent {

Command received(contract::Command message, const wire::ParticipantId& sender) {
  return {std::move(message.robot),
          {std::move(message.station), message.station_id, sender},
          message.epoch,
          message.seq,
          std::move(message.request),
          {},
          std::move(message.invalid)};
}

contract::AuthorityStatus status_of(const CommandInterface& commands, const std::string& robot, Time now) {
  const Authority& authority = commands.authority();
  return {.robot = robot,
          .epoch = authority.epoch(),
          .holder = authority.holder(),
          .locked = authority.locked(),
          .lease_left = static_cast<float>(authority.lease_left(now)),
          .stops = commands.stops().all()};
}

contract::Capabilities capabilities_of(const Platform& platform, const std::string& robot, const Id& id,
                                       std::uint16_t protocol, const ModeTable& modes) {
  namespace service = contract::service;
  contract::Capabilities out{.name = robot,
                             .kind = contract::AgentKind::robot,
                             .id = id,
                             .protocol = protocol,
                             .software = ADIT_VERSION,
                             .platform = platform.name,
                             .holonomic = platform.sideways(),
                             .length = static_cast<float>(platform.length),
                             .width = static_cast<float>(platform.width),
                             .height = static_cast<float>(platform.height),
                             .max_speed = static_cast<float>(platform.max_speed),
                             .max_turn = static_cast<float>(platform.max_turn),
                             .max_acceleration = static_cast<float>(platform.max_acceleration),
                             .max_step = static_cast<float>(platform.step),
                             .max_slope = static_cast<float>(std::atan(platform.max_slope)),
                             .stairs = platform.stairs,
                             .sensors = {"lidar", "odometry", "battery"}};
  for (const CameraConfig& camera : platform.cameras)
    out.sensors.push_back(std::string(contract::kCameraSensor) + camera.name);
  if (platform.router != "none") out.services.push_back(service::kRoute);
  for (const char* word : {service::kTilt, service::kMapRevision}) out.services.push_back(word);
  if (platform.turns_on_spot()) out.services.push_back(service::kTurnOnSpot);
  if (platform.stairs) out.services.push_back(service::kStairs);
  if (platform.flies()) out.services.push_back(service::kFlight);
  for (const ModeRow& row : modes.rows()) out.modes.push_back(std::string(row.name));
  return out;
}

}  // namespace adit::agent
