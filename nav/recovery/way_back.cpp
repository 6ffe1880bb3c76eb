// SPDX-License-Identifier: Apache-2.0
#include "nav/recovery/way_back.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

WayBack::WayBack(const Platform& platform)
    : platform_(platform), body_(platform), grown_(body_.grown(kMargin, kMargin)) {}

void WayBack::note(const Pose2& pose) {
  if (count_ > 0 && (pose.position() - newest().position()).norm() > 1.0) clear();
  while (count_ == 0 || (pose.position() - newest().position()).norm() >= kSpacing) {
    Pose2 next = pose;
    if (count_ > 0) {
      const Eigen::Vector2d way = pose.position() - newest().position();
      const double share = kSpacing / way.norm();
      next = {newest().x + share * way.x(), newest().y + share * way.y(),
              wrap_angle(newest().yaw + share * wrap_angle(pose.yaw - newest().yaw))};
    }
    if (count_ == kMax) {
      std::shift_left(poses_.begin(), poses_.end(), 1);
      --count_;
    }
    poses_[count_++] = next;
  }
}

bool WayBack::is_free(const Footprint& body, const Pose2& at, std::span<const ObstaclePoint> obstacles,
                      float depth) {
  const IntoPose into(at);
  const auto reach = static_cast<float>(body.radius());
  return std::ranges::none_of(obstacles, [&](const ObstaclePoint& o) {
    const float dx = o.x - into.x, dy = o.y - into.y;
    return o.cost >= 1.0f && dx * dx + dy * dy < reach * reach && body.depth(into.turn(dx, dy)) > depth;
  });
}

std::optional<Plan> WayBack::plan(const Pose2& pose, std::span<const ObstaclePoint> obstacles) {
  constexpr double kTurns = 0.35;  // rad: beyond this error the robot turns on the spot before it backs up.
  constexpr double kTurnStep = 0.15;  // rad: headings of that turn that are checked.
  constexpr double kOff = 0.4;        // m: a way back that begins farther from the robot is not its own.
  // What the robot has backed along already is no way back any more.
  while (count_ > 1 && (newest(1).position() - pose.position()).norm() <=
                           (newest().position() - pose.position()).norm() + 1e-9)
    --count_;
  // As near to obstacles as it is now, the body may stay; on its trail it was nearer a moment ago.
  float depth = 0.0f, grown_depth = 0.0f;
  for (const ObstaclePoint& o : obstacles) {
    if (o.cost < 1.0f) continue;
    depth = std::max(depth, body_.depth(o.x, o.y));
    grown_depth = std::max(grown_depth, grown_.depth(o.x, o.y));
  }
  const Pose2 back = pose.inverse();
  const auto turn_is_free = [&](double error) {
    if (std::fabs(error) <= kTurns) return true;
    if (!platform_.turns_on_spot()) return false;
    for (double by = kTurnStep; by < std::fabs(error); by += kTurnStep)
      if (!is_free(body_, {0, 0, std::copysign(by, error)}, obstacles, depth)) return false;
    return true;
  };

  Plan plan;
  plan.poses[plan.pose_count++] = pose;
  const bool own = count_ > 1 && (newest().position() - pose.position()).norm() < kOff &&
                   turn_is_free(wrap_angle(newest(1).yaw - pose.yaw));
  plan.reverse = true;
  bool whole = true;
  if (own) {
    plan.poses[0].yaw = newest().yaw;
    const Eigen::Vector2d way = newest(1).position() - newest().position();
    const auto ahead = [](const Eigen::Vector2d& step, double yaw) {
      return step.dot(Eigen::Vector2d(std::cos(yaw), std::sin(yaw))) > 0;
    };
    plan.reverse = !ahead(way, newest().yaw);
    for (std::size_t n = 1; n < count_ && whole; ++n) {
      const Pose2& next = newest(n);
      whole = ahead(next.position() - newest(n - 1).position(), newest(n - 1).yaw) != plan.reverse &&
              is_free(body_, back * next, obstacles, depth);
      if (whole) plan.poses[plan.pose_count++] = next;
    }
  }
  const Pose2 end = plan.poses[plan.pose_count - 1];
  for (double way = kSpacing; whole && kSpacing * plan.pose_count <= kStraight + 1e-9; way += kSpacing) {
    const Pose2 next = end * Pose2{plan.reverse ? -way : way, 0, 0};
    whole = is_free(grown_, back * next, obstacles, grown_depth);
    if (whole) plan.poses[plan.pose_count++] = next;
  }
  plan.length = kSpacing * static_cast<double>(plan.pose_count - 1);
  if (plan.length < kLeast) return std::nullopt;
  plan.max_speed = std::min(kSpeed, platform_.max_speed);
  return plan;
}

}  // namespace adit::nav
