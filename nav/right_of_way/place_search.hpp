// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "nav/right_of_way/corridor.hpp"
#include "nav/routing/route_planner.hpp"

namespace adit::nav {

/// The search for a place out of another robot's way. Map frame of the planner, m.
struct ClearQuery {
  Eigen::Vector3d from{0.0, 0.0, 0.0};  ///< This robot.
  Corridor corridor{};                  ///< The ground that must be free.
  double radius{};                      ///< Of this robot's outline, at any heading.
};

/// Farthest place that is looked at, by straight line, m.
inline constexpr double kFarthestClearPlace = 25.0;
/// Cost of a route across a robot that must not be passed, m.
inline constexpr double kNoWay = 1e6;

/// Finds the place that costs least to reach where the body, at any heading, stands outside the corridor on
/// known ground; if there is none, where it stands on ground of which a part was not seen yet. Returns
/// nothing if there is none either. Bounded: at most 8 searches of 64 places each, and 16 routes.
std::optional<Eigen::Vector3d> find_clear_place(RoutePlanner& planner, const ClearQuery& query);

}  // namespace adit::nav
