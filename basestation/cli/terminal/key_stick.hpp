#pragma once
#include <array>
#include <chrono>

namespace adit::station::cli {

/// A joystick made of keys. A terminal tells of presses and repeats, never of a release: a key that does not
/// repeat counts as released, after 0.6 s at its first press (longer than a keyboard waits before it
/// repeats), after 0.25 s from then on.
class KeyStick {
 public:
  using Clock = std::chrono::steady_clock;

  /// The robot's limits: m/s, rad/s.
  void set_limits(double speed, double turn);
  /// True when the key was one of the stick's: arrows, w a s d, q e (sideways), space (zero), + and -.
  bool press(int key, Clock::time_point now);
  /// vx vy in m/s, wz in rad/s.
  std::array<double, 3> velocity(Clock::time_point now) const;
  /// Share of the limits that a pressed key gives, (0, 1].
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

}  // namespace adit::station::cli
