// SPDX-License-Identifier: Apache-2.0
#include "core/contract/robot.hpp"

#include <algorithm>
#include <cmath>

#include "adit/robot.h"
#include "core/command/words.hpp"

namespace adit::contract {
namespace {

using command::valid_name;

std::int16_t tilt_of(double angle) {
  constexpr double kMax = RobotState::kMaxTilt;
  const double bounded = finite(angle) ? std::clamp(angle, -kMax, kMax) : 0.0;
  return static_cast<std::int16_t>(std::lround(RobotState::kTiltPerRadian * bounded));
}

double angle_of(std::int16_t tilt) {
  const double angle = static_cast<float>(tilt) * static_cast<float>(1.0 / RobotState::kTiltPerRadian);
  return std::clamp(angle, -RobotState::kMaxTilt, RobotState::kMaxTilt);
}

radio::Exploration to_radio(const Exploration& exploration) {
  radio::Exploration out;
  out.phase(static_cast<radio::ExplorationPhase>(exploration.phase));
  out.reason(static_cast<std::uint16_t>(exploration.reason));
  out.volume(exploration.volume);
  out.share(exploration.share);
  out.open(exploration.open);
  out.unreachable(exploration.unreachable);
  return out;
}

Exploration from_radio(const radio::Exploration& sample) {
  return {.phase = known_or(sample.phase(), ExplorationPhase::ended, ExplorationPhase::none),
          .reason = static_cast<Reason>(sample.reason()),
          .volume = amount(sample.volume()),
          .share = std::min(amount(sample.share()), 1.0F),
          .open = sample.open(),
          .unreachable = sample.unreachable()};
}

radio::Area to_radio(const Area& area) {
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

std::optional<Area> from_radio(const radio::Area& sample) {
  const std::vector<float>& numbers = sample.corners();
  const bool complete =
      numbers.size() >= 6 && numbers.size() <= 2 * Area::kMaxCorners && numbers.size() % 2 == 0;
  if (!complete || !valid_name(sample.name()) || sample.kind() > radio::AREA_PREFER) return std::nullopt;
  if (std::isnan(sample.z_min()) || std::isnan(sample.z_max())) return std::nullopt;
  Area area{.name = sample.name(),
            .kind = static_cast<AreaKind>(sample.kind()),
            .z_min = sample.z_min(),
            .z_max = sample.z_max(),
            .weight = amount(sample.weight())};
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    if (!finite(numbers[i], numbers[i + 1])) return std::nullopt;
    area.corners.emplace_back(numbers[i], numbers[i + 1]);
  }
  return area;
}

radio::ModeOption to_radio(const ModeOption& option) {
  radio::ModeOption out;
  out.mode(option.mode);
  out.available(option.available);
  out.reason(static_cast<std::uint16_t>(option.reason));
  return out;
}

radio::ComponentHealth to_radio(const ComponentHealth& component) {
  radio::ComponentHealth out;
  out.name(component.name);
  out.state(static_cast<radio::ComponentState>(component.state));
  out.healthy(component.healthy);
  out.automatic(component.automatic);
  out.silent_for(component.silent_for);
  out.restarts(component.restarts);
  out.hung(component.hung);
  out.text(clipped(component.text, ComponentHealth::kMaxSentText));
  return out;
}

ComponentHealth from_radio(const radio::ComponentHealth& sample) {
  return {.name = cleaned_name(sample.name()),
          .state = known_or(sample.state(), PartState::hung, PartState::failed),
          .healthy = sample.healthy(),
          .automatic = sample.automatic(),
          .silent_for = amount(sample.silent_for()),
          .restarts = sample.restarts(),
          .hung = sample.hung(),
          .text = command::clean(sample.text(), kMaxText)};
}

}  // namespace

radio::RobotState encode(const RobotState& state) {
  radio::RobotState out;
  out.robot(state.robot);
  out.stamp(state.stamp);
  out.x(state.x);
  out.y(state.y);
  out.z(state.z);
  out.yaw(state.yaw);
  out.vx(state.vx);
  out.vy(state.vy);
  out.wz(state.wz);
  out.battery(state.battery);
  const bool bounded = state.sigma < RobotState::kMaxSigma;  // False for NaN, too.
  const double sigma = bounded ? std::max(state.sigma, 0.0) : RobotState::kMaxSigma;
  out.sigma(static_cast<std::uint16_t>(std::lround(sigma * RobotState::kSigmaPerMetre)));
  out.tilt({tilt_of(state.roll), tilt_of(state.pitch)});
  out.localisation(static_cast<std::uint8_t>(state.localisation));
  out.map_revision(state.map_revision);
  return out;
}

std::optional<RobotState> decode(const radio::RobotState& sample) {
  if (!valid_name(sample.robot())) return std::nullopt;
  // Drivers overshoot a full battery. False for NaN, too.
  const bool known = sample.battery() >= 0.0F && sample.battery() <= 1.05F;
  return RobotState{.robot = sample.robot(),
                    .stamp = sample.stamp(),
                    .x = sample.x(),
                    .y = sample.y(),
                    .z = sample.z(),
                    .yaw = sample.yaw(),
                    .vx = sample.vx(),
                    .vy = sample.vy(),
                    .wz = sample.wz(),
                    .battery = known ? std::min(sample.battery(), 1.0F) : -1.0F,
                    .sigma = sample.sigma() * (1.0 / RobotState::kSigmaPerMetre),
                    .roll = angle_of(sample.tilt()[0]),
                    .pitch = angle_of(sample.tilt()[1]),
                    .localisation = known_or(sample.localisation(), Localisation::lost, Localisation::lost),
                    .map_revision = sample.map_revision()};
}

radio::Route encode(const Route& route) {
  radio::Route out;
  out.robot(route.robot);
  out.goal_id(route.goal_id);
  out.unknown(route.unknown);
  out.corners(static_cast<std::uint16_t>(std::min<std::size_t>(route.corners, UINT16_MAX)));
  if (route.points.empty()) return out;
  const Eigen::Vector3f from = route.points.front().cast<float>();
  out.from({from.x(), from.y(), from.z()});
  for (std::size_t i = 1; i < std::min(route.points.size(), Route::kMaxCorners); ++i) {
    const Eigen::Vector3d offset = Route::kOffsetsPerMetre * (route.points[i] - from.cast<double>());
    if (!(offset.cwiseAbs().maxCoeff() < INT16_MAX)) break;
    for (const double length : {offset.x(), offset.y(), offset.z()})
      out.points().push_back(static_cast<std::int16_t>(std::lround(length)));
  }
  return out;
}

std::optional<Route> decode(const radio::Route& sample) {
  if (!valid_name(sample.robot())) return std::nullopt;
  const Eigen::Vector3f from(sample.from()[0], sample.from()[1], sample.from()[2]);
  if (!from.allFinite()) return Route{.robot = sample.robot()};
  Route route{.robot = sample.robot(),
              .goal_id = sample.goal_id(),
              .corners = sample.corners(),
              .unknown = sample.unknown()};
  if (route.corners == 0) return route;
  constexpr auto kMetres = static_cast<float>(1.0 / Route::kOffsetsPerMetre);
  const std::vector<std::int16_t>& offsets = sample.points();
  route.points.push_back(from.cast<double>());
  for (std::size_t i = 0; i + 2 < offsets.size() && route.points.size() < Route::kMaxCorners; i += 3) {
    const Eigen::Vector3f offset = Eigen::Vector3<std::int16_t>(&offsets[i]).cast<float>();
    route.points.push_back((from + kMetres * offset).cast<double>());
  }
  return route;
}

radio::BehaviourState encode(const BehaviourState& state) {
  radio::BehaviourState out;
  out.robot(state.robot);
  out.mode(state.mode);
  out.stopped(state.stopped);
  out.moving_allowed(state.moving_allowed);
  out.reason(static_cast<std::uint16_t>(state.reason));
  out.recovery(static_cast<radio::RecoveryState>(state.recovery));
  out.goal_state(static_cast<radio::GoalState>(state.goal_state));
  out.goal_id(state.goal_id);
  out.goal({state.goal.x(), state.goal.y(), state.goal.z()});
  for (const ModeOption& option : state.options) out.modes().push_back(to_radio(option));
  out.convoy(state.convoy);
  out.yields(state.yields);
  out.yields_to(state.yields_to);
  if (state.exploration.phase != ExplorationPhase::none) out.exploration({to_radio(state.exploration)});
  for (const Area& area : state.areas) out.areas().push_back(to_radio(area));
  return out;
}

std::optional<BehaviourState> decode(const radio::BehaviourState& sample) {
  if (!valid_name(sample.robot())) return std::nullopt;
  BehaviourState state{.robot = sample.robot(),
                       .mode = cleaned_name(sample.mode()),
                       .stopped = sample.stopped(),
                       .moving_allowed = sample.moving_allowed(),
                       .reason = static_cast<Reason>(sample.reason()),
                       .recovery = known_or(sample.recovery(), RecoveryState::give_up, RecoveryState::drive),
                       .goal_state = known_or(sample.goal_state(), GoalState::reached, GoalState::none),
                       .goal_id = sample.goal_id(),
                       .goal = Eigen::Vector3d(sample.goal().data()),
                       .yields = sample.yields()};
  for (const radio::ModeOption& option : sample.modes())
    if (state.options.size() < BehaviourState::kMaxOptions)
      state.options.push_back(
          {cleaned_name(option.mode()), option.available(), static_cast<Reason>(option.reason())});
  for (const std::string& member : sample.convoy())
    if (state.convoy.size() < BehaviourState::kMaxConvoy && valid_name(member))
      state.convoy.push_back(member);
  if (valid_name(sample.yields_to())) state.yields_to = sample.yields_to();
  if (!sample.exploration().empty()) state.exploration = from_radio(sample.exploration().front());
  for (const radio::Area& sent : sample.areas())
    if (auto area = from_radio(sent); area && state.areas.size() < BehaviourState::kMaxAreas)
      state.areas.push_back(std::move(*area));
  return state;
}

radio::Notification encode(const Notification& notification) {
  radio::Notification out;
  out.robot(notification.robot);
  out.stamp(notification.stamp);
  out.operator_name(notification.operator_name);
  out.severity(static_cast<radio::Severity>(notification.severity));
  out.code(notification.code);
  out.reason(static_cast<std::uint16_t>(notification.reason));
  out.text(clipped(notification.text, Notification::kMaxSentText));
  return out;
}

std::optional<Notification> decode(const radio::Notification& sample) {
  if (!valid_name(sample.robot())) return std::nullopt;
  return Notification{.operator_name = cleaned_name(sample.operator_name()),
                      .severity = known_or(sample.severity(), Severity::error, Severity::error),
                      .code = cleaned_name(sample.code()),
                      .reason = static_cast<Reason>(sample.reason()),
                      .text = command::clean(sample.text(), kMaxText),
                      .robot = sample.robot(),
                      .stamp = sample.stamp()};
}

radio::Health encode(const Health& health) {
  radio::Health out;
  out.robot(health.robot);
  for (const ComponentHealth& component : health.components) out.components().push_back(to_radio(component));
  return out;
}

std::optional<Health> decode(const radio::Health& sample) {
  if (!valid_name(sample.robot())) return std::nullopt;
  Health health{.robot = sample.robot()};
  for (const radio::ComponentHealth& component : sample.components())
    if (health.components.size() < Health::kMaxComponents) health.components.push_back(from_radio(component));
  return health;
}

}  // namespace adit::contract
