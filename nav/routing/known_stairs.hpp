// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/geometry/staircase.hpp"
#include "nav/geometry/stairs_geometry.hpp"
#include "nav/routing/tile.hpp"

namespace adit::nav {

/// Whether two estimates of a staircase lead a route the same way: refinements below a cell are ignored.
bool leads_the_same(const Staircase& a, const Staircase& b);

/// Calls `visit(ix, iy, place)` for each cell whose centre is up to `margin` (m) before or behind a
/// staircase, and between its sides.
template <class Visit>
void visit_cells(const Staircase& stairs, double margin, Visit&& visit) {
  const double half = stairs.width / 2, length = length_of(stairs);
  const double reach = length + 2 * margin + half;
  const Eigen::Vector2d middle = stairs.foot.head<2>() + length / 2 * stairs.direction();
  const int cells = static_cast<int>(reach / kRouteCell) + 1;
  const int cx = route_cell(middle.x()), cy = route_cell(middle.y());
  for (int iy = cy - cells; iy <= cy + cells; ++iy)
    for (int ix = cx - cells; ix <= cx + cells; ++ix) {
      const OnStairs place = on_stairs(stairs, (ix + 0.5) * kRouteCell, (iy + 0.5) * kRouteCell);
      if (place.along >= -margin && place.along <= length + margin && std::abs(place.across) <= half)
        visit(ix, iy, place);
    }
}

/// The staircases that are nearest to one of the places, at most `most`, in the order of `stairs`. A place
/// whose height is NaN may be at any.
std::vector<Staircase> nearest_stairs(std::span<const Staircase> stairs,
                                      std::span<const Eigen::Vector3d> places, std::size_t most);

/// A way over a staircase, between the places where a body stands before it and behind it, m.
struct Flight {
  Staircase stairs{};
  Eigen::Vector3d begin{0, 0, 0}, end{0, 0, 0};
};

/// The flights that lead nearer to a height by another storey at least, m.
std::vector<Flight> flights_towards(std::span<const Staircase> stairs, double height);

}  // namespace adit::nav
