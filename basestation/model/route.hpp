// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <vector>

#include "basestation/model/robot.hpp"

namespace adit::station {

/// The way that a robot still has to go along its route, from where it is now.
struct RouteRest {
  std::vector<std::array<double, 3>> points{};  ///< Map frame, m; empty: no route is known.
  std::vector<bool> unknown{};                  ///< One per leg: it leads through space that was not seen.
  double length{};                              ///< Of all legs, m.
  double unknown_length{};                      ///< Of those through space that was not seen, m.
  bool complete{};                              ///< It ends at the end of the route.
};

/// A robot sends its route when it changes, not while it drives along it: what lies behind is left out here.
/// A route to another goal than the robot has now is none.
RouteRest rest_of_route(const Robot& robot);

/// For example "12.3 m, of these 4.0 m not seen yet"; empty without a route.
std::string route_text(const Robot& robot);

}  // namespace adit::station
