// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/telemetry/telemetry.hpp"

#include <cmath>

namespace adit::agent {

void Telemetry::start(Time now, Time started) {
  started_ = started;
  send_authority(now);
  send_behaviour(now);
  report_driver(now);
}

void Telemetry::follow_link(Time now) {
  // The stick echoes the stamps of RobotState, and an echo is stale after 600 ms.
  constexpr double kRateWithStick = 5.0;
  const wire::SenderState sender = dependencies_.wire.sender();
  dependencies_.rate.observe(now, sender.waiting(wire::kStatusPriority), sender.lost(wire::kStatusPriority));
  dependencies_.rate.set_floor(dependencies_.commands.stick_used(now) ? kRateWithStick : 0.0);
  if (const Frames& at = dependencies_.frames; at.initialised())
    dependencies_.wire.set_place(dependencies_.wire.id(),
                                 {at.T_map_base().x, at.T_map_base().y, at.height()});
}

void Telemetry::send_state(Time now, float charge, Localisation localisation, double sigma) {
  follow_link(now);
  if (!dependencies_.rate.due(now)) return;
  const std::uint64_t stamp = to_stamp(now);
  dependencies_.commands.sent_stamp(stamp);
  const Frames& at = dependencies_.frames;
  // Odometry frame and map are level to each other.
  const Eigen::Vector3d up = at.T_odom_base().orientation.conjugate() * Eigen::Vector3d::UnitZ();
  const Pose2 pose = at.T_map_base();
  const Twist2 twist = at.initialised() ? at.twist() : Twist2{};
  dependencies_.radio.send_state({.stamp = stamp,
                                  .x = static_cast<float>(pose.x),
                                  .y = static_cast<float>(pose.y),
                                  .z = static_cast<float>(at.height()),
                                  .yaw = static_cast<float>(pose.yaw),
                                  .vx = static_cast<float>(twist.vx),
                                  .vy = static_cast<float>(twist.vy),
                                  .wz = static_cast<float>(twist.wz),
                                  .battery = charge,
                                  .sigma = sigma,
                                  .roll = std::atan2(up.y(), up.z()),
                                  .pitch = std::atan2(-up.x(), std::hypot(up.y(), up.z())),
                                  .localisation = localisation,
                                  .map_revision = static_cast<std::uint8_t>(at.map_epoch())});
}

void Telemetry::send_route(Time now, const contract::Route& route) {
  if (route_report_.due(route, now, dependencies_.rate.stretch())) dependencies_.radio.send_route(route);
}

void Telemetry::send_periodic(Time now) {
  constexpr std::uint32_t kLinkSeconds = 2;  // Period of the link reports, s.
  const std::uint32_t at = seconds_++;
  const auto stretch = static_cast<std::uint32_t>(dependencies_.rate.stretch());
  if (at % stretch == 0) {
    send_authority(now);
    send_behaviour(now);
  }
  if (at % (kLinkSeconds * stretch) == kLinkSeconds * stretch - 1)
    dependencies_.radio.send_link_report(now, dependencies_.driver.malformed(), dependencies_.rate.rate());
}

void Telemetry::send_authority(Time now) { dependencies_.radio.send_authority(dependencies_.commands, now); }

void Telemetry::send_behaviour(Time now) {
  contract::BehaviourState state = dependencies_.behaviour.view();
  state.options = dependencies_.behaviour.options(now);
  dependencies_.radio.send_behaviour(std::move(state));
}

bool Telemetry::driver_fell_silent(Time now) {
  const bool alive = dependencies_.frames.alive(now), was_alive = driver_was_alive_;
  if (alive == was_alive) return false;
  driver_was_alive_ = alive;
  report_driver(now);
  return was_alive;
}

void Telemetry::report_driver(Time now) {
  const bool alive = dependencies_.frames.alive(now);
  contract::ComponentHealth driver{
      .name = "driver", .state = PartState::up, .healthy = alive, .automatic = true};
  std::optional<Time> heard{};
  if (!alive) {
    // A driver that was never present has not failed.
    const bool was_present = dependencies_.frames.initialised();
    driver.state = was_present ? PartState::failed : PartState::starting;
    heard = now - dependencies_.frames.silence(now, started_);
    driver.text = was_present ? "no usable odometry" : "no usable odometry since the start of the agent";
  }
  dependencies_.watch.note(driver, heard);
}

}  // namespace adit::agent
