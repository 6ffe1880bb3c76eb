// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>

namespace adit::station::input {

/// The axis of a stick as a share of the limit, [-1, 1]: without the dead zone of a worn stick, and finer
/// near the centre. `value`: [-1, 1]; not a number counts as the centre.
inline double shaped(double value) {
  constexpr double kDead = 0.12;  // Worn sticks rest up to here.
  constexpr double kCurve = 0.3;  // Share of the cubic part.
  if (!(std::abs(value) >= kDead)) return 0.0;
  const double share = std::min(1.0, (std::abs(value) - kDead) / (1.0 - kDead));
  return std::copysign((1.0 - kCurve) * share + kCurve * share * share * share, value);
}

}  // namespace adit::station::input
