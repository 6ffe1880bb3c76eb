// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/config/platform.hpp"

namespace adit::sim {

/// A wheeled platform of 0.6 x 0.5 m: at most 2 m/s, 1.5 rad/s and 1.5 m/s^2.
inline Platform wheeled() {
  Platform p;
  p.name = "wheeled";
  p.length = 0.6;
  p.width = 0.5;
  p.max_speed = 2.0;
  p.max_turn = 1.5;
  p.max_acceleration = 1.5;
  return p;
}

}  // namespace adit::sim
