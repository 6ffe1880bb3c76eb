// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>

namespace adit::nav {

/// Keeps the distance of a follower to its predecessor, from outline to outline along the path.
///
/// The wanted gap grows with speed (constant time headway), and the speed of the predecessor is fed forward:
/// v = v_pred + gain * (gap - standstill - headway * v), solved for v. The transfer from the predecessor's
/// speed to the follower's is (s + k) / ((1 + k h) s + k), whose magnitude is at most 1 at every frequency: a
/// change of speed does not grow along the convoy (string stability, Swaroop and Hedrick 1996).
struct Spacing {
  double standstill{1.5};  ///< Gap at rest, m.
  double headway{0.8};     ///< The h above, s.
  double gain{0.5};        ///< The k above, 1/s.
  double braking{0.8};     ///< Deceleration behind a convoy that halts, m/s2.

  double wanted(double speed) const { return standstill + headway * speed; }
  /// The speed for a gap (m) to a predecessor that drives at `predecessor` (m/s, negative: towards the
  /// follower), within [0, max].
  double speed(double gap, double predecessor, double max) const {
    const double v = (predecessor + gain * (gap - standstill)) / (1.0 + gain * headway);
    return std::clamp(v, 0.0, max);
  }
  /// The speed while the convoy halts: that from which the robot stops at the gap at rest, behind a
  /// predecessor that brakes alike. The law above would approach it for several seconds, one robot after the
  /// other.
  double halting_speed(double gap, double predecessor, double max) const {
    const double ahead = std::max(0.0, predecessor);
    return std::min(std::sqrt(std::max(0.0, ahead * ahead + 2 * braking * (gap - standstill))), max);
  }
};

}  // namespace adit::nav
