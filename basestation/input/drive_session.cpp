// SPDX-License-Identifier: Apache-2.0
#include "basestation/input/drive_session.hpp"

#include <algorithm>
#include <cmath>

namespace adit::station::input {
namespace {

constexpr double kUsual = 0.5, kFast = 1.0, kPrecise = 0.25;  // Shares of the limits.

bool zero(const std::array<double, 3>& axes) { return axes[0] == 0.0 && axes[1] == 0.0 && axes[2] == 0.0; }

/// What the hands ask for, in shares of the limits; `why` says why it is nothing.
std::array<double, 3> asked(const Hands& hands, std::string& why) {
  if (hands.touching) return hands.touched;
  if (!zero(hands.keys)) {
    std::array<double, 3> axes = hands.keys;
    for (double& axis : axes) axis *= kUsual;
    return axes;
  }
  if (!hands.pad.present) return {};
  if (!hands.pad.shoulder) {
    if (!zero(hands.pad.stick)) why = "hold the left shoulder button to drive";
    return {};
  }
  const double share = hands.pad.precise ? kPrecise : hands.pad.fast ? kFast : kUsual;
  std::array<double, 3> axes = hands.pad.stick;
  for (double& axis : axes) axis *= share;
  return axes;
}

}  // namespace

DriveSession::Step DriveSession::step(const Hands& hands, const DriveView& view, double now) {
  const auto end = [](std::string why) { return Step{.ends = true, .why = std::move(why)}; };
  const Robot* robot = view.robot;
  if (!robot) return end("the robot is not known any more");
  if (robot->lost) return end("the robot is lost");
  if (!robot->mine)
    return end(robot->holder.empty() ? "you do not hold the robot any more"
                                     : robot->holder + " holds the robot now");
  if (had_pad_ && !hands.pad.present) return end("the game controller is gone");
  had_pad_ = hands.pad.present;
  const bool by_hand = is_by_hand(robot->mode);
  entered_ = entered_ || by_hand;
  if (entered_ && !by_hand && now - begun_ > 1.0) return end("the robot is in " + robot->mode + " now");
  if (!entered_ && now - begun_ > kEnterLimit)
    return end("the robot does not drive by hand: it is in " + robot->mode);

  Step step;
  std::array<double, 3> axes = asked(hands, step.why);
  bool halted = false;
  const auto halt = [&](const char* why) {
    axes = {};
    halted = true;
    step.why = why;
  };
  if (robot->stopped || !robot->stops.empty()) halt("a stop is set: reset it first");
  if (robot->age + view.silent > kOldState) halt("the robot's state is old");
  if (view.since_beat > kFrozen) halt("the window hangs");
  if (!view.focused) halt("another window has the keyboard");
  const bool at_rest = zero(axes) && !halted;
  rest_first_ = halted || (rest_first_ && !at_rest);
  if (rest_first_ && !halted) halt("let go once, then drive on");

  const double speed = robot->max_speed > 0.0F ? robot->max_speed : kUnknownLimit;
  const double turn = robot->max_turn > 0.0F ? robot->max_turn : kUnknownLimit;
  for (double& axis : axes) axis = std::isfinite(axis) ? std::clamp(axis, -1.0, 1.0) : 0.0;
  step.velocity = {axes[0] * speed, robot->holonomic ? axes[1] * speed : 0.0, axes[2] * turn};

  const double change =
      std::max({std::abs(step.velocity.vx - sent_.vx) / speed, std::abs(step.velocity.vy - sent_.vy) / speed,
                std::abs(step.velocity.wz - sent_.wz) / turn});
  const bool halts = zero({step.velocity.vx, step.velocity.vy, step.velocity.wz}) && change > 0.0;
  // Half a millisecond less, as the caller's clock does not fall on the period.
  step.send = sent_at_ < 0.0 || now - sent_at_ >= kPeriod - 5e-4 || halts || change > kJump;
  if (step.send) {
    sent_at_ = now;
    sent_ = step.velocity;
  }
  return step;
}

}  // namespace adit::station::input
