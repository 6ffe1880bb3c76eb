// SPDX-License-Identifier: Apache-2.0
#include "basestation/input/key_stick.hpp"

#include <algorithm>

#include "basestation/input/keys.hpp"

namespace adit::station::input {

using namespace std::chrono_literals;

void KeyStick::set_limits(double speed, double turn) {
  if (speed > 0.0) speed_ = speed;
  if (turn > 0.0) turn_ = turn;
}

void KeyStick::push(Axis& axis, double value, Clock::time_point now) {
  const bool repeated = axis.value == value && now < axis.until;
  axis.value = value;
  axis.until = now + (repeated ? 250ms : 600ms);
}

bool KeyStick::press(int key, Clock::time_point now) {
  struct Push {
    int arrow{}, letter{};
    Axis KeyStick::*axis{};
    double value{};
  };
  static constexpr std::array kPushes{
      Push{key_up, 'w', &KeyStick::forward_, 1.0},   Push{key_down, 's', &KeyStick::forward_, -1.0},
      Push{key_left, 'a', &KeyStick::turning_, 1.0}, Push{key_right, 'd', &KeyStick::turning_, -1.0},
      Push{'q', 'q', &KeyStick::sideways_, 1.0},     Push{'e', 'e', &KeyStick::sideways_, -1.0}};
  for (const Push& row : kPushes) {
    if (key != row.arrow && key != row.letter) continue;
    push(this->*row.axis, row.value, now);
    return true;
  }
  if (key == ' ') forward_ = sideways_ = turning_ = {};
  if (key == '+') scale_ = std::min(1.0, scale_ + 0.1);
  if (key == '-') scale_ = std::max(0.1, scale_ - 0.1);
  return key == ' ' || key == '+' || key == '-';
}

std::array<double, 3> KeyStick::velocity(Clock::time_point now) const {
  const auto value = [now](const Axis& axis) { return now < axis.until ? axis.value : 0.0; };
  return {value(forward_) * speed_ * scale_, value(sideways_) * speed_ * scale_,
          value(turning_) * turn_ * scale_};
}

}  // namespace adit::station::input
