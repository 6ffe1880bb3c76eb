// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/combined_planner.hpp"

#include <algorithm>

namespace adit::nav {

// Checks the straight line to the target, which the global planner keeps as far from obstacles as the route.
bool CombinedPlanner::is_tight(const Target& target, const Pose2& pose,
                               std::span<const ObstaclePoint> obstacles) const {
  constexpr double kAhead = 2.0;  // Distance that is checked along the route, beyond the braking distance, m.
  if (target.passage) return true;
  const Eigen::Vector2d to = pose.inverse() * target.goal;
  const double distance = to.norm();
  const double speed = lattice_.speed();
  const double braking = speed * speed / (2.0 * platform_.max_acceleration);
  const auto length = static_cast<float>(std::min(distance, kAhead + braking));
  const auto c = static_cast<float>(distance > 1e-6 ? to.x() / distance : 1.0);
  const auto s = static_cast<float>(distance > 1e-6 ? to.y() / distance : 0.0);
  const auto near = static_cast<float>(platform_.width / 2 + kClearance);
  for (const ObstaclePoint& o : obstacles) {
    if (o.cost < 1.0f) continue;
    const float along = c * o.x + s * o.y, across = c * o.y - s * o.x;
    const float beyond = along - std::clamp(along, 0.0f, length);
    if (beyond * beyond + across * across < near * near) return true;
  }
  return false;
}

void CombinedPlanner::choose(const Target& target, const Pose2& pose,
                             std::span<const ObstaclePoint> obstacles) {
  if (target.kind != Target::Kind::goal || target.route == 0) {
    tight_ = instead_ = false;
    return;
  }
  constexpr double kHysteresis = 1.0;  // m after the last tight place, where open space begins.
  const bool gone = (pose.position() - switched_at_).norm() > kHysteresis;
  if (instead_ && !gone) return;
  instead_ = false;
  const bool tight = is_tight(target, pose, obstacles);
  if (tight) switched_at_ = pose.position();
  // A manoeuvre that has begun is finished.
  if (tight || (gone && lattice_.drives_ahead())) tight_ = tight;
}

Plan CombinedPlanner::plan(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
                           double stamp_s) {
  lattice_.watch(pose, stamp_s);
  choose(target, pose, obstacles);
  const auto with = [&](bool tight) -> Plan {
    return tight ? lattice_.plan(target, pose, obstacles, stamp_s)
                 : open_.plan(target, pose, obstacles, stamp_s);
  };
  Plan plan = with(tight_);
  if (!plan.blocked || target.kind != Target::Kind::goal || target.route == 0) return plan;
  const Plan other = with(!tight_);
  if (other.blocked || other.arrived) return plan;
  tight_ = !tight_;
  instead_ = true;
  switched_at_ = pose.position();
  return other;
}

}  // namespace adit::nav
