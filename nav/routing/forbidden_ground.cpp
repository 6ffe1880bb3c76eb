// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/forbidden_ground.hpp"

#include <cmath>

#include "nav/geometry/segment.hpp"

namespace adit::nav {
namespace {

constexpr double kBorderError = 1e-2;  // m

/// Radius of the circle around a square, m.
constexpr double radius_of(int side) { return side * kRouteCell * M_SQRT1_2; }

Eigen::Vector3d middle_of(const Tile& tile) {
  return {(tile.tx + 0.5) * kTileSide * kRouteCell, (tile.ty + 0.5) * kTileSide * kRouteCell, tile.z};
}

bool is_near(const Area& area, const Eigen::Vector2d& place, double distance) {
  if (area.contains(place)) return true;
  for (std::size_t i = 0, j = area.corners.size() - 1; i < area.corners.size(); j = i++)
    if (squared_distance(place, area.corners[j], area.corners[i]) <= distance * distance) return true;
  return false;
}

}  // namespace

ForbiddenPart forbidden_part(const AreaSet& areas, const Eigen::Vector3d& middle, int side) {
  const double radius = radius_of(side);
  if (areas.permits(middle, kForbiddenReach + radius)) return ForbiddenPart::none;
  const bool deep = !areas.permits(middle, kForbiddenReach - radius - kBorderError);
  return deep ? ForbiddenPart::all : ForbiddenPart::some;
}

AreaChange::AreaChange(const AreaSet& before, const AreaSet& after) : before_(before), after_(after) {
  add_missing(before, after);
  add_missing(after, before);
}

void AreaChange::add_missing(const AreaSet& from, const AreaSet& in) {
  for (std::size_t i = 0; i < from.all().size(); ++i) {
    const Area& area = from.all()[i];
    if (area.kind == AreaKind::prefer) continue;
    bool missing = true;
    for (std::size_t k = 0; k < in.all().size() && missing; ++k)
      missing = !(in.all()[k] == area && in.margin(k) == from.margin(i));
    if (missing) changed_.push_back({area, from.margin(i)});
  }
}

// A window that both sets forbid in part changes only where an area does.
bool AreaChange::concerns(const Tile& tile) const {
  if (changed_.empty()) return false;
  const Eigen::Vector3d middle = middle_of(tile);
  const ForbiddenPart before = forbidden_part(before_, middle, kTileWindow);
  const ForbiddenPart after = forbidden_part(after_, middle, kTileWindow);
  if (before != after) return true;
  if (before != ForbiddenPart::some) return false;
  for (const Changed& each : changed_) {
    const double reach = radius_of(kTileWindow) + kForbiddenReach + std::fabs(each.margin) + kBorderError;
    if (each.area.at_height(tile.z) && is_near(each.area, middle.head<2>(), reach)) return true;
  }
  return false;
}

}  // namespace adit::nav
