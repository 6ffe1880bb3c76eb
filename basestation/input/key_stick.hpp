// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <chrono>

namespace adit::station::input {

/// A joystick emulated with keys. A terminal reports presses and repeats, but no releases: a key that does
/// not repeat counts as released, 0.6 s after its first press (longer than a keyboard's repeat delay), and
/// 0.25 s after a repeat.
class KeyStick {
 public:
  using Clock = std::chrono::steady_clock;

  /// Sets the robot's limits, m/s and rad/s.
  void set_limits(double speed, double turn);
  /// Processes a key; returns whether it belongs to the stick: arrows, w a s d, q e (sideways), space (zero),
  /// + and -.
  bool press(int key, Clock::time_point now);
  /// The velocity: vx, vy in m/s, wz in rad/s.
  std::array<double, 3> velocity(Clock::time_point now) const;
  /// Fraction of the limits that a pressed key commands, (0, 1].
  double scale() const { return scale_; }

 private:
  struct Axis {
    double value{};
    Clock::time_point until{};
  };
  void push(Axis& axis, double value, Clock::time_point now);

  double speed_{0.5};
  double turn_{0.5};
  double scale_{0.5};
  Axis forward_{}, sideways_{}, turning_{};
};

}  // namespace adit::station::input
