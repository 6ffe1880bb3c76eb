// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adit::nav {

/// Something that makes a place hard to cross, as the local planner sees it: the centre of a cell of the
/// terrain, in the robot's frame (x ahead, y left, on the ground) at the pose that is planned from.
struct ObstaclePoint {
  float x{};        ///< m
  float y{};        ///< m
  float cost{1.0};  ///< [0, 1]; 1: this platform cannot pass
};

}  // namespace adit::nav
