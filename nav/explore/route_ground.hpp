// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "nav/routing/route_planner.hpp"

namespace adit::nav {

/// The ground as the robot's own global planner knows it, which must outlive this.
class RouteGround {
 public:
  /// `areas`: those of the robot; `within`: what it is to explore. Both in the planner's frame.
  RouteGround(RoutePlanner& planner, const Platform& platform, const AreaSet& areas = {},
              const AreaSet& within = {})
      : planner_(planner), areas_(areas), within_(within), half_width_(platform.width / 2) {}
  /// Height of the ground at a place, of the floor nearest to z; nothing when it is not known.
  std::optional<double> ground(double x, double y, double z) const { return planner_.ground(x, y, z); }
  /// Whether the ground around a place is known to be free, as far as the body and a margin reach.
  bool standable(const Eigen::Vector3d& place) const {
    if (!areas_.permits(place, half_width_)) return false;
    const double reach = half_width_ + kFree;
    for (int k = 0; k < kSides; ++k) {
      const double bearing = 2 * M_PI * k / kSides;
      const GroundCell* cell =
          planner_.map().cell(route_cell(place.x() + reach * std::cos(bearing)),
                              route_cell(place.y() + reach * std::sin(bearing)), place.z());
      if (cell == nullptr || !cell->known || cell->blocked) return false;
    }
    return true;
  }
  /// Costs of the routes from one place to many through known space, m; infinite where none leads.
  std::vector<float> costs(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> goals) {
    return planner_.costs(from, goals);
  }
  /// Whether weight() is not 1 everywhere.
  bool weighs() const { return !areas_.empty() || !within_.empty(); }
  /// Factor of what is seen at a place; 0: it is not worth a look.
  double weight(const Eigen::Vector3d& place) const {
    return within_.permits(place) ? areas_.weight(place) : 0.0;
  }

 private:
  static constexpr double kFree = 0.1;  ///< On each side of the body, m.
  static constexpr int kSides = 8;

  RoutePlanner& planner_;
  AreaSet areas_, within_;
  double half_width_;  ///< m
};

}  // namespace adit::nav
