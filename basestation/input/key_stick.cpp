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
  switch (key) {
    case key_up:
    case 'w':
      push(forward_, 1.0, now);
      return true;
    case key_down:
    case 's':
      push(forward_, -1.0, now);
      return true;
    case key_left:
    case 'a':
      push(turning_, 1.0, now);
      return true;
    case key_right:
    case 'd':
      push(turning_, -1.0, now);
      return true;
    case 'q':
      push(sideways_, 1.0, now);
      return true;
    case 'e':
      push(sideways_, -1.0, now);
      return true;
    case ' ':
      forward_ = sideways_ = turning_ = {};
      return true;
    case '+':
      scale_ = std::min(1.0, scale_ + 0.1);
      return true;
    case '-':
      scale_ = std::max(0.1, scale_ - 0.1);
      return true;
    default:
      return false;
  }
}

std::array<double, 3> KeyStick::velocity(Clock::time_point now) const {
  const auto value = [now](const Axis& axis) { return now < axis.until ? axis.value : 0.0; };
  return {value(forward_) * speed_ * scale_, value(sideways_) * speed_ * scale_,
          value(turning_) * turn_ * scale_};
}

}  // namespace adit::station::input
