// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

namespace adit::nav {

/// Class of a cell of the ground for one platform: what is there. Whether the body may cross it, the cost
/// says.
enum class CellClass : std::uint8_t {
  unknown,   ///< No scan showed the ground or an obstacle there.
  ground,    ///< Passable ground.
  slope,     ///< Steep ground, passable or not.
  step,      ///< An edge or rough ground, passable or not.
  obstacle,  ///< Something stands or hangs there that the body cannot pass.
  drop,      ///< The ground is missing, or ends here.
  mover,  ///< An obstacle on or within 0.35 m of what moves: no evidence for or against anything that lasts.
};
inline constexpr std::array kCellClassNames{"unknown",  "ground", "slope", "step",
                                            "obstacle", "drop",   "mover"};
inline constexpr std::size_t kCellClasses = kCellClassNames.size();

}  // namespace adit::nav
