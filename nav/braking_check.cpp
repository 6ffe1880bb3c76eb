#include "nav/braking_check.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

BrakingCheck::BrakingCheck(const Platform& platform, const BrakingCheckParams& params)
    : platform_(platform), params_(params) {}

void BrakingCheck::look(std::span<const Eigen::Vector2f> obstacles, const Pose2& pose) {
  const double top = platform_.max_speed;
  const double reach = std::hypot(platform_.length, platform_.width) / 2 + params_.margin +
                       top * params_.reaction + top * top / (2 * platform_.max_acceleration);
  const auto c = static_cast<float>(std::cos(pose.yaw)), s = static_cast<float>(std::sin(pose.yaw));
  const auto x0 = static_cast<float>(pose.x), y0 = static_cast<float>(pose.y);
  const auto reach2 = static_cast<float>(reach * reach);
  count_ = 0;
  for (const Eigen::Vector2f& p : obstacles) {
    const float dx = p.x() - x0, dy = p.y() - y0;
    if (dx * dx + dy * dy > reach2 || count_ == kMax) continue;
    near_[count_++] = {c * dx + s * dy, c * dy - s * dx};
  }
}

bool BrakingCheck::safe(const Twist2& velocity) const {
  const double speed = std::hypot(velocity.vx, velocity.vy), turn = std::fabs(velocity.wz);
  if (count_ == 0 || (speed < 1e-6 && turn < 1e-6)) return true;
  // Both ways shrink together while braking (the curvature is kept): the longer of both times rules.
  const double braking = std::max(speed / platform_.max_acceleration, turn / platform_.max_turn_acceleration);
  const double time = params_.reaction + braking / 2;  // at full velocity, for the same way
  const double radius = std::hypot(platform_.length, platform_.width) / 2;
  const int steps = std::clamp(static_cast<int>(std::ceil((speed + turn * radius) * time / 0.04)), 1, 64);
  const double dt = time / steps;
  const auto hl = static_cast<float>(platform_.length / 2 + params_.margin);
  const auto hw = static_cast<float>(platform_.width / 2 + params_.margin);
  const auto depth = [hl, hw](float x, float y) { return std::min(hl - std::fabs(x), hw - std::fabs(y)); };

  Pose2 pose{};
  for (int i = 0; i < steps; ++i) {
    const Pose2 half{0, 0, velocity.wz * dt / 2};
    pose = pose * half * Pose2{velocity.vx * dt, velocity.vy * dt, 0} * half;
    const auto c = static_cast<float>(std::cos(pose.yaw)), s = static_cast<float>(std::sin(pose.yaw));
    const auto x0 = static_cast<float>(pose.x), y0 = static_cast<float>(pose.y);
    for (std::size_t j = 0; j < count_; ++j) {
      const float dx = near_[j].x() - x0, dy = near_[j].y() - y0;
      const float inside = depth(c * dx + s * dy, c * dy - s * dx);
      if (inside > 0.0f && inside > depth(near_[j].x(), near_[j].y()) + 0.002f) return false;
    }
  }
  return true;
}

}  // namespace adit::nav
