// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::nav {

/// A place that is hard to cross, as input to local planners: the centre of a terrain cell in the robot's
/// frame (x ahead, y left, on the ground) at the pose that the plan starts from.
struct ObstaclePoint {
  float x{};        ///< m
  float y{};        ///< m
  float cost{1.0};  ///< [0, 1]; 1: impassable for this platform.
};

}  // namespace adit::nav
