// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "sim/world/world.hpp"

namespace adit::sim {

/// A world seen from above, one class for each column.
struct GroundPlan {
  enum Kind : std::uint8_t { unknown, floor, glimpsed, furniture, wall };

  int nx{}, ny{};
  std::vector<Kind> kind{};
  Eigen::Vector2d low{}, high{};  ///< Corners of the drawn part, world, m.

  Kind at(int i, int j) const { return kind[static_cast<std::size_t>(j) * nx + i]; }
};

/// Floor: open for a body of that height at the most common floor level; wall: solid up to above a man's
/// head, beside what is open; furniture: solid beside it but open above; glimpsed:
/// open at that height only; unknown: the rest. Open patches of
/// less than a square metre do not widen the part worth showing.
GroundPlan make_ground_plan(const World& world, double headroom);

}  // namespace adit::sim
