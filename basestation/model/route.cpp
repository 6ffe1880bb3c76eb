// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/route.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "basestation/model/text.hpp"

namespace adit::station {
namespace {

using Place = std::array<double, 3>;

double distance(const Place& a, const Place& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// The point of a leg that is nearest to a place.
Place nearest_on(const Place& from, const Place& to, const Place& place) {
  double along = 0.0, square = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    along += (place[axis] - from[axis]) * (to[axis] - from[axis]);
    square += (to[axis] - from[axis]) * (to[axis] - from[axis]);
  }
  const double t = square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
  Place point{};
  for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = from[axis] + t * (to[axis] - from[axis]);
  return point;
}

}  // namespace

RouteRest rest_of_route(const Robot& robot) {
  const contract::Route& route = robot.route;
  const bool finite = std::isfinite(robot.x) && std::isfinite(robot.y) && std::isfinite(robot.z);
  if (!robot.located || !finite || route.points.size() < 2 || route.goal_id != robot.goal_id) return {};
  const Place here{robot.x, robot.y, robot.z};
  std::vector<Place> corners;
  for (const Eigen::Vector3d& point : route.points) corners.push_back({point.x(), point.y(), point.z()});
  std::size_t leg = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const double off = distance(nearest_on(corners[i], corners[i + 1], here), here);
    if (!(off < least)) continue;
    least = off;
    leg = i;
  }
  RouteRest rest{.points = {here}, .complete = route.points.size() == route.corners};
  for (std::size_t i = leg; i + 1 < corners.size(); ++i) {
    const double length = distance(rest.points.back(), corners[i + 1]);
    rest.unknown.push_back(i < 32 && (route.unknown >> i & 1U) != 0);
    rest.points.push_back(corners[i + 1]);
    rest.length += length;
    if (rest.unknown.back()) rest.unknown_length += length;
  }
  return rest;
}

std::string route_text(const Robot& robot) {
  const RouteRest rest = rest_of_route(robot);
  if (rest.points.empty()) return {};
  std::string text = (rest.complete ? "" : "more than ") + fixed(rest.length, 1) + " m";
  if (rest.unknown_length > 0.0) text += ", of these " + fixed(rest.unknown_length, 1) + " m not seen yet";
  return text;
}

}  // namespace adit::station
