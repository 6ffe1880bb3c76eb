// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/known_stairs.hpp"

#include <algorithm>

#include "core/geometry/pose.hpp"

namespace adit::nav {

bool leads_the_same(const Staircase& a, const Staircase& b) {
  constexpr double kShift = 0.05, kTurn = 0.03;  // m, rad
  return a.steps == b.steps && (a.foot - b.foot).norm() < kShift && (a.top() - b.top()).norm() < kShift &&
         std::abs(a.width - b.width) < 2 * kShift && std::abs(wrap_angle(a.heading - b.heading)) < kTurn;
}

std::optional<Staircase> between(std::span<const Staircase> stairs, double from, double to) {
  std::optional<Staircase> best;
  double least = std::abs(to - from) - kSameStorey;
  for (const Staircase& each : stairs)
    for (const bool up : {true, false}) {
      const double begin = up ? each.floor_below() : each.floor_above();
      const double end = up ? each.floor_above() : each.floor_below();
      const double left = std::abs(to - end);
      if (std::abs(begin - from) > kSameStorey || left >= least) continue;
      least = left;
      best = each;
    }
  return best;
}

}  // namespace adit::nav
