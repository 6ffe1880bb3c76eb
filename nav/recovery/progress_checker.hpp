// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>

namespace adit::nav {

/// Parameters of ProgressChecker.
struct ProgressParams {
  double gain{0.5};   ///< Minimum progress, m, [0.1, 5].
  double time{45.0};  ///< Maximum time for it, s, [1, 600].
  int detours{3};     ///< Maximum number of restarts of that time for a longer route, [0, 100].
};

/// Checks that a robot makes progress towards its goal, by the length of the remaining route. The distance to
/// the goal may grow on a detour, and the distance to a route point that moves ahead of the robot proves
/// nothing.
class ProgressChecker {
 public:
  explicit ProgressChecker(const ProgressParams& params = {}) : params_(params) {}

  /// Returns true when there was no progress for ProgressParams::time. `left`: length of the remaining route,
  /// m; `longer`: it is a new route that is longer than the previous one.
  bool stuck(double left, bool longer, double now_s) {
    const bool nearer = left < nearest_ - params_.gain;
    // On a detour its own remaining length counts, until the goal is nearer than ever.
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
  double nearest_{std::numeric_limits<double>::infinity()};   // Least length of the remaining route, m.
  double shortest_{std::numeric_limits<double>::infinity()};  // The same on the present detour.
  double since_{0};                                           // s
  int detours_{0};
};

}  // namespace adit::nav
