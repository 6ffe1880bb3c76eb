// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/vfh/vfh_planner.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr int kHeadings = 72;                          // 5 degrees apart.
constexpr double kSpacing = 0.05, kFarthest = 3.0;     // m
constexpr double kTolerance = 0.25, kMinLength = 0.4;  // m: goal tolerance; minimum length of a path.
constexpr double kMargin = 0.06;                       // m around the robot.

}  // namespace

double VfhPlanner::free_along(double heading, std::span<const ObstaclePoint> obstacles) const {
  const double radius = std::hypot(platform_.length, platform_.width) / 2 + kMargin;
  const double c = std::cos(heading), s = std::sin(heading);
  double free = kFarthest;
  for (const ObstaclePoint& o : obstacles) {
    if (o.cost < 1.0f) continue;
    const double along = c * o.x + s * o.y, across = std::fabs(c * o.y - s * o.x);
    if (along > 0 && across < radius)
      free = std::min(free, along - std::sqrt(radius * radius - across * across));
  }
  return free;
}

Plan VfhPlanner::plan(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
                      double stamp_s) {
  Plan plan{};
  plan.stamp_s = stamp_s;
  if (target.kind == Target::Kind::none) return plan;
  const Eigen::Vector2d to = pose.inverse() * target.goal;
  const bool goal = target.kind == Target::Kind::goal;
  const double distance = goal ? to.norm() : kFarthest;
  const double bearing = goal ? std::atan2(to.y(), to.x()) : target.direction;
  plan.arrived = goal && distance < kTolerance;
  if (plan.arrived || (!goal && target.speed <= 0)) return plan;

  double best = 1e9, way = 0;
  int turn = 0;  // Degrees.
  for (int i = 0; i < kHeadings; ++i) {
    const double heading = wrap_angle(bearing + 2 * M_PI * i / kHeadings);
    const double free = free_along(heading, obstacles);
    if (free < std::min(kMinLength, distance)) continue;
    // Prefers directions towards the target, with little turning and more free space.
    const double cost = std::fabs(wrap_angle(heading - bearing)) + 0.4 * std::fabs(heading) +
                        0.5 * (1 - std::min(free, distance) / std::min(kFarthest, distance));
    if (cost >= best) continue;
    best = cost;
    way = free;
    turn = static_cast<int>(std::lround(heading * 180 / M_PI));
  }
  plan.blocked = best > 1e8;
  if (plan.blocked) return plan;
  const Pose2 start = pose * Pose2{0, 0, turn * M_PI / 180};
  plan.length = kSpacing * std::floor(std::min(way, distance) / kSpacing);
  plan.ends_at_goal = goal && distance <= way;
  for (double at = 0; at <= plan.length + 1e-9 && plan.pose_count < Plan::kMaxPath; at += kSpacing)
    plan.poses[plan.pose_count++] = start * Pose2{at, 0, 0};
  plan.max_speed = std::min(platform_.max_speed, std::sqrt(platform_.max_acceleration * std::max(0.0, way)));
  if (target.speed > 0) plan.max_speed = std::min(plan.max_speed, target.speed);
  return plan;
}

}  // namespace adit::nav
