#include "robot_agent/telemetry/telemetry.hpp"

namespace adit::agent {

void Telemetry::start(Time now, Time started) {
  started_ = started;
  send_authority(now);
  send_behaviour(now);
  report_driver(now);
}

void Telemetry::follow_link(Time now) {
  // The stick echoes our stamps, and at 600 ms an echo is stale.
  constexpr double kRateWithStick = 5.0;
  const wire::SenderState sender = parts_.wire.sender();
  parts_.rate.observe(now, sender.waiting(wire::status_priority), sender.lost(wire::status_priority));
  parts_.rate.set_floor(parts_.commands.stick_used(now) ? kRateWithStick : 0.0);
  if (const Frames& at = parts_.frames; at.initialised())
    parts_.wire.set_place(parts_.wire.id(), {at.T_map_base().x, at.T_map_base().y, at.height()});
}

void Telemetry::send_state(Time now, float charge) {
  follow_link(now);
  if (!parts_.rate.due(now)) return;
  const std::uint64_t stamp = to_stamp(now);
  parts_.commands.sent_stamp(stamp);
  const Frames& at = parts_.frames;
  parts_.radio.send_state({at.T_map_base(), at.height(), at.initialised() ? at.twist() : Twist2{}, charge},
                          stamp);
}

void Telemetry::send_periodic(Time now) {
  constexpr std::uint32_t kLinkSeconds = 2;  // between two link reports
  const std::uint32_t at = seconds_++;
  const auto stretch = static_cast<std::uint32_t>(parts_.rate.stretch());
  if (at % stretch == 0) {
    send_authority(now);
    send_behaviour(now);
  }
  if (at % (kLinkSeconds * stretch) == kLinkSeconds * stretch - 1)
    parts_.radio.send_link_report(now, parts_.driver.malformed(), parts_.rate.rate());
}

void Telemetry::send_authority(Time now) { parts_.radio.send_authority(parts_.commands, now); }

void Telemetry::send_behaviour(Time now) {
  parts_.radio.send_behaviour(parts_.behaviour.view(), parts_.behaviour.options(now));
}

bool Telemetry::driver_fell_silent(Time now) {
  const bool alive = parts_.frames.alive(now), was_alive = driver_was_alive_;
  if (alive == was_alive) return false;
  driver_was_alive_ = alive;
  report_driver(now);
  return was_alive;
}

void Telemetry::report_driver(Time now) {
  const bool alive = parts_.frames.alive(now);
  ComponentRow driver{};
  driver.name = "driver";
  driver.state = alive ? PartState::up : PartState::failed;
  driver.healthy = alive;
  if (!alive) driver.heard = now - parts_.frames.silence(now, started_);
  if (!alive) driver.text = "no odometry";
  parts_.watch.note(driver);
}

}  // namespace adit::agent
