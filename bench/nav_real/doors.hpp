// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "bench/nav_real/true_map.hpp"

namespace adit::bench {

/// A narrow place between two wide ones of the true map.
struct Door {
  Eigen::Vector2d at{0, 0};  ///< Its narrowest place, world, m.
  double width{};            ///< The free width there, m.
};

/// All doors of a map: saddles of the distance to what is blocked, not wider than 1.5 m, between two places
/// each of which is at least 0.25 m farther from everything than the saddle. Sorted by x.
std::vector<Door> find_doors(const TrueMap& map);

/// The straight path through a door that leaves the body most room.
struct Passage {
  Pose2 middle{};
  double beside{};  ///< Room on each side of the body, m; negative: it does not fit.
};
/// Fits one that leads 0.5 m straight on to both sides of the door.
Passage fit_passage(const TrueMap& map, const Door& door);

}  // namespace adit::bench
