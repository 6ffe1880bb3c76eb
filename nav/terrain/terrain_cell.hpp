// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace adit::nav {

/// What makes a place hard to cross.
enum class Layer : std::uint8_t {
  obstacle,   ///< something stands or hangs there
  drop,       ///< the ground is missing
  slope,      ///< ground too steep, or steep
  step,       ///< an edge
  roughness,  ///< uneven ground
};

/// A place of the terrain that costs something.
struct TerrainCell {
  float x{}, y{};   ///< of its middle, odometry frame, m
  float cost{1.0};  ///< (0, 1]; 1: this platform cannot pass
  float age{};      ///< how long an obstacle has stood there, s; 0 in other layers
  Layer layer{};
};

}  // namespace adit::nav
