// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::station {

/// Velocity that a stick requests, body frame. All zero: the stick is centred.
struct StickVelocity {
  double vx{};  ///< Forward, m/s.
  double vy{};  ///< To the left, m/s.
  double wz{};  ///< Turn to the left, rad/s.
  bool operator==(const StickVelocity&) const = default;
};

}  // namespace adit::station
