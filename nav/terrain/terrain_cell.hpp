// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace adit::nav {

/// Cause of a terrain cell's cost.
enum class Layer : std::uint8_t {
  obstacle,   ///< An obstacle stands or hangs there.
  drop,       ///< The ground is missing.
  slope,      ///< Steep ground, passable or not.
  step,       ///< An edge.
  roughness,  ///< Uneven ground.
};

/// A cell of the terrain with a cost.
struct TerrainCell {
  float x{}, y{};   ///< Centre, odometry frame, m.
  float cost{1.0};  ///< (0, 1]; 1: impassable for this platform.
  float age{};      ///< Time since an obstacle was first seen there, s; 0 in other layers.
  Layer layer{};
};

}  // namespace adit::nav
