// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/radio/convert.hpp"

#include <algorithm>
#include <cmath>

#include "robot_agent/common/clipped.hpp"

namespace adit::agent {
namespace {

// A message that is too large for its topic is not sent, and a refusal would be lost without notice. A
// complete notification stays below 1 kB.
constexpr std::size_t kNoticeText = 500;

radio::Severity to_radio(Severity severity) {
  switch (severity) {
    case Severity::info:
      return radio::SEVERITY_INFO;
    case Severity::warning:
      return radio::SEVERITY_WARNING;
    case Severity::error:
      return radio::SEVERITY_ERROR;
  }
  return radio::SEVERITY_ERROR;
}

radio::GoalState to_radio(GoalState state) {
  switch (state) {
    case GoalState::none:
      return radio::GOAL_NONE;
    case GoalState::kept:
      return radio::GOAL_KEPT;
    case GoalState::active:
      return radio::GOAL_ACTIVE;
    case GoalState::blocked:
      return radio::GOAL_BLOCKED;
    case GoalState::reached:
      return radio::GOAL_REACHED;
  }
  return radio::GOAL_NONE;
}

}  // namespace

Command received(contract::Command message, const wire::ParticipantId& sender) {
  return {std::move(message.robot),
          {std::move(message.station), message.station_id, sender},
          message.epoch,
          message.seq,
          std::move(message.request),
          {},
          std::move(message.invalid)};
}

radio::Notification to_radio(const Notice& notice, const std::string& robot) {
  radio::Notification out;
  out.robot(robot);
  out.operator_name(notice.operator_name);
  out.severity(to_radio(notice.severity));
  out.code(notice.code);
  out.reason(static_cast<std::uint16_t>(notice.reason));
  out.text(clipped(notice.text, kNoticeText));
  return out;
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

static radio::Exploration to_radio(const ExplorationView& view) {
  radio::Exploration out;
  out.phase(static_cast<radio::ExplorationPhase>(view.state));
  out.reason(static_cast<std::uint16_t>(view.reason));
  out.volume(view.volume);
  out.share(view.share);
  out.open(view.open);
  out.unreachable(view.unreachable);
  return out;
}

static radio::Area to_radio(const nav::Area& area) {
  radio::Area out;
  out.name(area.name);
  out.kind(static_cast<radio::AreaKind>(area.kind));
  out.z_min(static_cast<float>(area.z_min));
  out.z_max(static_cast<float>(area.z_max));
  out.weight(static_cast<float>(area.weight));
  for (const Eigen::Vector2d& corner : area.corners)
    for (const double metres : {corner.x(), corner.y()}) out.corners().push_back(static_cast<float>(metres));
  return out;
}

radio::Route to_radio(const FollowedRoute& route, const std::string& robot) {
  constexpr double kDecimetres = 10.0;
  radio::Route out;
  out.robot(robot);
  out.goal_id(route.goal_id);
  out.unknown(route.unknown);
  out.corners(static_cast<std::uint16_t>(std::min<std::size_t>(route.corners, 65535)));
  if (route.points.empty()) return out;
  const Eigen::Vector3f from = route.points.front().cast<float>();
  out.from({from.x(), from.y(), from.z()});
  for (std::size_t i = 1; i < std::min(route.points.size(), FollowedRoute::kMaxCorners); ++i) {
    const Eigen::Vector3d offset = kDecimetres * (route.points[i] - from.cast<double>());
    if (!(offset.cwiseAbs().maxCoeff() < 32767.0)) break;
    for (const double length : {offset.x(), offset.y(), offset.z()})
      out.points().push_back(static_cast<std::int16_t>(std::lround(length)));
  }
  return out;
}

radio::BehaviourState to_radio(const BehaviourView& view, const std::vector<ModeOption>& options,
                               const std::string& robot) {
  radio::BehaviourState out;
  out.robot(robot);
  out.mode(std::string(view.mode));
  out.stopped(view.stopped);
  out.moving_allowed(view.moving_allowed);
  out.reason(static_cast<std::uint16_t>(view.reason));
  out.goal_state(to_radio(view.goal_state));
  out.goal_id(view.goal_id);
  out.goal({view.goal.x(), view.goal.y(), view.goal.z()});
  out.convoy(view.convoy);
  out.yields(view.yields);
  out.yields_to(view.yields_to);
  if (view.exploration.state != ExplorationState::none)
    out.exploration().push_back(to_radio(view.exploration));
  for (const nav::Area& area : view.areas.all()) out.areas().push_back(to_radio(area));
  for (const ModeOption& option : options) {
    radio::ModeOption mode;
    mode.mode(std::string(option.mode));
    mode.available(option.reason == Reason::none);
    mode.reason(static_cast<std::uint16_t>(option.reason));
    out.modes().push_back(mode);
  }
  return out;
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
  if (platform.router != "none") out.services.push_back(service::kRoute);
  for (const char* word : {service::kTilt, service::kMapRevision}) out.services.push_back(word);
  if (platform.turns_on_spot()) out.services.push_back(service::kTurnOnSpot);
  if (platform.stairs) out.services.push_back(service::kStairs);
  if (platform.flies()) out.services.push_back(service::kFlight);
  for (const ModeRow& row : modes.rows()) out.modes.push_back(std::string(row.name));
  return out;
}

}  // namespace adit::agent
