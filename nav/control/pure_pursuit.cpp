// SPDX-License-Identifier: Apache-2.0
#include "nav/control/pure_pursuit.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

Twist2 PurePursuit::track(const Pose2& odom, const Place& place, double) {
  constexpr double kLookahead = 0.35;     // Minimum lookahead distance, m.
  constexpr double kLookaheadTime = 0.5;  // Added lookahead per speed, s.
  constexpr double kYawGain = 1.8;        // Heading gain while a holonomic robot drives, 1/s.
  constexpr double kShortest = 0.12;      // m: a nearer lookahead point does not define a direction.
  const auto path = plan().path();
  const double now = std::hypot(command().vx, command().vy);
  const double ahead = kLookahead + kLookaheadTime * now;
  std::size_t aim = place.nearest;
  while (aim + 1 < path.size() && (path[aim].position() - odom.position()).norm() < ahead) ++aim;
  Eigen::Vector2d to = odom.inverse() * path[aim].position();
  if (plan().reverse) to = -to;  // The robot drives backwards: its rear counts as its front.
  const double distance = to.norm();
  const double share = kBrakingShare * platform().max_acceleration;
  double speed = std::min({plan().max_speed, platform().max_speed,
                           std::sqrt(plan().end_speed * plan().end_speed + 2 * share * place.remaining)});
  if (distance < kShortest && place.remaining < kShortest) return {};

  if (platform().sideways()) {
    const double yaw_error = wrap_angle(path[(place.nearest + aim) / 2].yaw - odom.yaw);
    const double turn = std::clamp(kYawGain * yaw_error, -platform().max_turn, platform().max_turn);
    speed *= std::max(0.3, std::cos(std::min(M_PI / 2, 1.5 * std::fabs(yaw_error))));
    const Eigen::Vector2d v = to * (speed / std::max(distance, kShortest)) * (plan().reverse ? -1.0 : 1.0);
    return {v.x(), v.y(), turn};
  }
  double curvature = 2 * to.y() / std::max(distance * distance, kShortest * kShortest);
  if (to.x() <= 0) return {};
  if (!platform().turns_on_spot())
    curvature = std::clamp(curvature, -1 / platform().least_radius(), 1 / platform().least_radius());
  if (std::fabs(curvature) * speed > 0.8 * platform().max_turn)
    speed = 0.8 * platform().max_turn / std::fabs(curvature);
  return {plan().reverse ? -speed : speed, 0, speed * curvature};
}

}  // namespace adit::nav
