// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "nav/areas/area_set.hpp"
#include "nav/routing/tile.hpp"

namespace adit::nav {

/// Ground nearer than this to what the areas forbid counts as forbidden, m, beside their margins: the
/// clearance counts from the centres of cells, so those that a margin ends in are forbidden, too.
inline constexpr double kForbiddenReach = kRouteCell;

/// How much of a square the areas forbid.
enum class ForbiddenPart : std::uint8_t { none, some, all };
/// The part of a square of `side` cells around `middle`, m, that `areas` forbid, in their frame. `none` and
/// `all` are certain; `some` stands also for squares whose corners are near to a border.
ForbiddenPart forbidden_part(const AreaSet& areas, const Eigen::Vector3d& middle, int side);

/// The difference of two sets of areas, for the question which tiles it concerns.
class AreaChange {
 public:
  AreaChange(const AreaSet& before, const AreaSet& after);
  /// Whether the forbidden cells in the window of `tile` may differ between both sets.
  bool concerns(const Tile& tile) const;

 private:
  /// An area that only one of the sets has.
  struct Changed {
    Area area;
    double margin;  ///< m
  };
  void add_missing(const AreaSet& from, const AreaSet& in);

  const AreaSet &before_, &after_;
  std::vector<Changed> changed_{};
};

}  // namespace adit::nav
