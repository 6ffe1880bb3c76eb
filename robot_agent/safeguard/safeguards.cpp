// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/safeguard/safeguards.hpp"

#include <algorithm>
#include <cmath>

namespace adit::agent {
namespace {

constexpr auto kLastLevel = static_cast<std::uint8_t>(BatteryLevel::last);

std::string place_text(const Eigen::Vector2d& place) {
  return std::to_string(std::lround(place.x())) + " " + std::to_string(std::lround(place.y()));
}

LinkLossParams starting_at(const Pose2& start, LinkLossParams params) {
  params.start = {start.x, start.y};
  return params;
}

}  // namespace

Safeguards::Safeguards(SafeguardParams params, std::string robot, const Pose2& start,
                       const Dependencies& dependencies)
    : params_(params),
      robot_(std::move(robot)),
      start_(start),
      dependencies_(dependencies),
      link_loss_(starting_at(start, params.link_loss)),
      battery_watch_(params_.battery),
      battery_return_(params_.return_retry) {}

void Safeguards::restore(std::uint8_t stored, Time now) {
  battery_watch_.restore(static_cast<BatteryLevel>(std::min(stored, kLastLevel)));
  if (stored > kLastLevel) battery_return_.begin(dependencies_.behaviour.holder_requests(), now);
}

std::uint8_t Safeguards::stored() const {
  const auto level = static_cast<std::uint8_t>(battery_watch_.level());
  return level == kLastLevel && battery_return_.pending(dependencies_.behaviour.holder_requests())
             ? kLastLevel + 1
             : level;
}

void Safeguards::tick(Time now) {
  watch_link(now);
  watch_return(now);
}

void Safeguards::watch_link(Time now) {
  const Authority& authority = dependencies_.authority;
  const Frames& at = dependencies_.frames;
  LinkLoss::Inputs in{};
  in.held = authority.holder().has_value();
  // A restart of the command component starts the lease again, but it is no heartbeat of the holder.
  const Peer* peer = dependencies_.peers.holder();
  in.heard = peer ? peer->last_seen : authority.heard();
  in.autonomous = dependencies_.behaviour.mode().autonomous();
  in.arrived = dependencies_.behaviour.view().goal_state == GoalState::reached;
  if (at.initialised()) in.place = Eigen::Vector2d(at.T_map_base().x, at.T_map_base().y);
  const LinkLoss::Step step = link_loss_.tick(in, now);
  const std::string holder = authority.holder_name();
  if (step.lost)
    dependencies_.notices.to_all(Severity::warning, "link_lost", Reason::no_answer,
                                 robot_ + " has not heard " + holder + " for " +
                                     std::to_string(std::lround(seconds(step.silence))) + " s");
  if (step.found)
    dependencies_.notices.to_all(Severity::info, "link_back", Reason::none,
                                 robot_ + " hears " + holder + " again");
  if (step.hold) {
    dependencies_.behaviour.hold(Reason::no_answer, now);
    dependencies_.notices.to_all(
        Severity::warning, "mode_changed", Reason::no_answer,
        robot_ + " holds until it hears " + holder + " again and is told to go on; its goal is kept");
  }
  if (step.go_to && !go_back(*step.go_to, "its holder is not heard", now)) link_loss_.refused(now);
}

Result<void> Safeguards::go_back(const Eigen::Vector2d& place, const std::string& why, Time now) {
  auto asked =
      dependencies_.behaviour.request_goal({place.x(), place.y(), std::nan("")}, Commander::agent, now);
  if (asked)
    dependencies_.notices.to_all(Severity::warning, "returning", Reason::none,
                                 robot_ + " goes back to " + place_text(place) + ": " + why);
  return asked;
}

void Safeguards::watch_return(Time now) {
  const Behaviour& behaviour = dependencies_.behaviour;
  if (behaviour.listens()) return;  // A stop given during a restart comes first.
  const BatteryReturn::Inputs in{.autonomous = behaviour.mode().autonomous(),
                                 .nearly_empty = battery_watch_.level() == BatteryLevel::last,
                                 .requests = behaviour.holder_requests()};
  if (!battery_return_.due(in, now)) return;
  const Eigen::Vector2d start(start_.x, start_.y);
  const auto asked = go_back(start, "its battery is nearly empty", now);
  if (asked) return battery_return_.accepted();
  if (!battery_return_.refused(asked.reason(), now)) return;
  dependencies_.notices.to_all(Severity::error, "return_refused", asked.reason(),
                               robot_ + " cannot go back to " + place_text(start) + " yet (" +
                                   asked.error().text + "); it tries again until you request something else");
}

void Safeguards::battery(float charge, Time now) {
  charge_ = std::isfinite(charge) ? charge : -1.0f;
  if (const auto level = battery_watch_.update(charge_)) battery_fell(*level, now);
}

void Safeguards::battery_fell(BatteryLevel level, Time now) {
  const char* code = level == BatteryLevel::last  ? "battery_last"
                     : level == BatteryLevel::low ? "battery_low"
                                                  : "battery_warning";
  dependencies_.notices.to_all(
      level == BatteryLevel::last ? Severity::error : Severity::warning, code, Reason::none,
      robot_ + " has " + std::to_string(std::lround(charge_ * 100)) + " % of its battery left");
  // An operator who drives manually sees the charge, and decides.
  if (level != BatteryLevel::last || !dependencies_.behaviour.mode().autonomous()) return;
  if (params_.return_at_last_battery) {
    battery_return_.begin(dependencies_.behaviour.holder_requests(), now);
    return watch_return(now);
  }
  dependencies_.behaviour.hold(Reason::none, now);
  dependencies_.notices.to_all(Severity::warning, "mode_changed", Reason::none,
                               robot_ + " holds: its battery is nearly empty; its goal is kept");
}

}  // namespace adit::agent
