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

double unknown_length(const contract::Route& route) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < route.points.size(); ++i)
    if ((route.unknown >> i & 1U) != 0) length += (route.points[i + 1] - route.points[i]).norm();
  return length;
}

}  // namespace

bool RouteReport::due(const contract::Route& route, Time now, double stretch) {
  const bool none = route.corners == 0, had_none = sent_.corners == 0;
  if (none && had_none) return false;
  // Only another goal is sent at once; a route may be lost and found many times in a second.
  const bool other_goal = !none && !had_none && route.goal_id != sent_.goal_id;
  const auto pause = std::chrono::duration_cast<Duration>(kPeriod * stretch);
  if (!other_goal && sent_at_ && now - *sent_at_ < pause) return false;
  const double unknown = unknown_length(route);
  if (!none && !had_none && !other_goal) {
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
