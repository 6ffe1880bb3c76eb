// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/telemetry/route_report.hpp"

#include <algorithm>
#include <limits>

namespace adit::agent {
namespace {

using Points = std::vector<Eigen::Vector3d>;

double distance_to(const Points& line, const Eigen::Vector3d& point) {
  double nearest = line.size() == 1 ? (line[0] - point).norm() : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector3d way = line[i + 1] - line[i];
    const double length = std::max(way.squaredNorm(), 1e-12);
    const double along = std::clamp((point - line[i]).dot(way) / length, 0.0, 1.0);
    nearest = std::min(nearest, (line[i] + along * way - point).norm());
  }
  return nearest;
}

double unknown_length(const FollowedRoute& route) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < route.points.size(); ++i)
    if ((route.unknown >> i & 1U) != 0) length += (route.points[i + 1] - route.points[i]).norm();
  return length;
}

}  // namespace

bool RouteReport::due(const FollowedRoute& route, Time now, double stretch) {
  const bool same_goal = (route.corners == 0) == (sent_.corners == 0) && route.goal_id == sent_.goal_id;
  const double unknown = unknown_length(route);
  if (route.corners == 0) {
    if (sent_.corners == 0) return false;
  } else if (same_goal) {
    if (sent_at_ && now - *sent_at_ < kPeriod * stretch) return false;
    // The corners of a route on which the robot advances lie on the route that was sent.
    const bool deviates = std::any_of(route.points.begin(), route.points.end(), [this](const auto& point) {
      return distance_to(sent_.points, point) > kTolerance;
    });
    const bool learnt = sent_unknown_ > 0.0 && (unknown == 0.0 || unknown < sent_unknown_ - kLearnt);
    if (!deviates && !learnt) return false;
  }
  sent_ = route;
  sent_unknown_ = unknown;
  sent_at_ = now;
  return true;
}

}  // namespace adit::agent
