// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>

namespace adit::nav {

struct ProgressParams {
  double gain{0.5};   ///< The route left must get shorter by this, m, [0.1, 5] ...
  double time{45.0};  ///< ... within this time, s, [1, 600].
  int detours{3};     ///< As often the time starts again because a longer route was taken, [0, 100].
};

/// Watches whether a robot makes progress towards its goal, by the length of the route that is left: the
/// distance to the goal may grow on a detour, and the distance to a point of the route that moves ahead of
/// the robot says nothing.
class ProgressChecker {
 public:
  explicit ProgressChecker(const ProgressParams& params = {}) : params_(params) {}

  /// True when there was no progress for ProgressParams::time. `left`: of the route, m; `longer`: it is
  /// another one than before, and longer.
  bool stuck(double left, bool longer, double now_s) {
    const bool nearer = left < nearest_ - params_.gain;
    // On a detour what is left of it counts, until the goal is nearer than ever.
    const bool detour = longer && detours_ < params_.detours;
    if (nearer) {
      nearest_ = left;
      detours_ = 0;
    } else if (detour) {
      ++detours_;
    }
    if (nearer || detour || left < shortest_ - params_.gain) {
      shortest_ = left;
      since_ = now_s;
    }
    return now_s - since_ >= params_.time;
  }

 private:
  ProgressParams params_;
  double nearest_{std::numeric_limits<double>::infinity()};   // to the goal so far, m
  double shortest_{std::numeric_limits<double>::infinity()};  // the same on the present detour
  double since_{0};                                           // s
  int detours_{0};
};

}  // namespace adit::nav
