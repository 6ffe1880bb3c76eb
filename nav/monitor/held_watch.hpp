// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

namespace adit::nav {

/// How long the collision monitor has kept a robot on the spot. Breaks shorter than 0.5 s do not end that;
/// who came farther than 0.3 m meanwhile is not held, only slow.
class HeldWatch {
 public:
  /// After each velocity: whether the monitor stopped it, where the robot was, m, odometry frame, and when,
  /// s.
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
  /// Whether it has been held for so long, s.
  bool held(double now_s, double long_s) const { return since_ && now_s - *since_ >= long_s; }
  void clear() { since_.reset(); }

 private:
  std::optional<double> since_{};
  double last_{0};                // s: when it was last stopped
  Eigen::Vector2d at_{0.0, 0.0};  // where it was first stopped
};

}  // namespace adit::nav
