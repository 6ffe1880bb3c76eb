// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

namespace adit::nav {

/// Measures how long the collision monitor has kept a robot on the spot. Interruptions shorter than 0.5 s do
/// not count. A robot that moved more than 0.3 m meanwhile is only slow.
class HeldWatch {
 public:
  /// Records a command. `stopped`: the monitor stopped it; `at`: position of the robot, odometry frame, m;
  /// `now_s`: s.
  void look(bool stopped, const Eigen::Vector2d& at, double now_s) {
    constexpr double kFreeAgain = 0.5;   // s
    constexpr double kHeldWithin = 0.3;  // m
    if (since_ && (now_s - last_ > kFreeAgain || (at - at_).norm() > kHeldWithin)) since_.reset();
    if (!stopped) return;
    last_ = now_s;
    if (since_) return;
    since_ = now_s;
    at_ = at;
  }
  /// Whether the robot has been held for at least `long_s`, s.
  bool held(double now_s, double long_s) const { return since_ && now_s - *since_ >= long_s; }
  void clear() { since_.reset(); }

 private:
  std::optional<double> since_{};
  double last_{0};                // Time of the last stopped command, s.
  Eigen::Vector2d at_{0.0, 0.0};  // Position at the first stopped command, odometry frame, m.
};

}  // namespace adit::nav
