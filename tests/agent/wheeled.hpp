// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/config/platform.hpp"

namespace adit::agent {

/// The limits of a wheeled platform that bound how far a body can move between two samples of odometry.
inline Platform wheeled() {
  Platform platform{};
  platform.max_speed = 2.0;
  platform.max_turn = 1.5;
  platform.max_acceleration = 1.5;
  return platform;
}

}  // namespace adit::agent
