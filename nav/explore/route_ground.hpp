// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "nav/explore/explorer.hpp"
#include "nav/routing/route_planner.hpp"

namespace adit::nav {

/// The ground as the robot's own global planner knows it, which must outlive this.
class RouteGround final : public GroundView {
 public:
  /// `areas`: those of the robot; `within`: what it is to explore. Both in the planner's frame.
  RouteGround(RoutePlanner& planner, const Platform& platform, const AreaSet& areas = {},
              const AreaSet& within = {})
      : planner_(planner), areas_(areas), within_(within), half_width_(platform.width / 2) {}
  std::optional<double> ground(double x, double y, double z) override { return planner_.ground(x, y, z); }
  bool standable(const Eigen::Vector3d& place) override {
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
  std::vector<float> costs(const Eigen::Vector3d& from, std::span<const Eigen::Vector3d> goals) override {
    return planner_.costs(from, goals);
  }
  bool weighs() const override { return !areas_.empty() || !within_.empty(); }
  double weight(const Eigen::Vector3d& place) const override {
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
