#include "nav/path_follower.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr double kStanding = 0.12;  ///< m/s: slow enough to begin to turn on the spot
constexpr double kShortest = 0.12;  ///< m: a nearer point says little about the direction

double stepped(double from, double to, double step) { return from + std::clamp(to - from, -step, step); }

}  // namespace

PathFollower::PathFollower(const Platform& platform, const PathFollowerParams& params)
    : platform_(platform), params_(params), check_(platform, params.check) {}

void PathFollower::set_plan(const Plan& plan) { plan_ = plan; }

Twist2 PathFollower::stop_now() {
  plan_ = {};
  turning_ = held_ = false;
  return last_ = {};
}

Twist2 PathFollower::follow(const Pose2& odom, double dt) {
  const Twist2 candidate = towards(desired(odom), dt);
  check_.look(plan_.near(), odom);
  held_ = !check_.safe(candidate);
  last_ = held_ ? braked(dt) : candidate;
  return last_;
}

Twist2 PathFollower::desired(const Pose2& odom) {
  const auto path = plan_.path();
  if (path.size() < 2) {
    turning_ = false;
    return {};
  }
  std::size_t nearest = 0;
  double best = 1e30;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double d = (path[i].position() - odom.position()).squaredNorm();
    if (d < best) {
      best = d;
      nearest = i;
    }
  }
  const double spacing = plan_.length / static_cast<double>(path.size() - 1);
  const double remaining = spacing * static_cast<double>(path.size() - 1 - nearest);

  double error = wrap_angle(path[nearest].yaw - odom.yaw);
  const double off = std::fabs(error);
  turning_ = off > (turning_ ? params_.turn_until : params_.turn_from);
  if (turning_) {
    // The planner may have found that only the long way round is free.
    if (plan_.turn != 0 && error * plan_.turn < 0 && off > M_PI / 3) error += plan_.turn * 2 * M_PI;
    return turn_on_spot(error);
  }
  return pursue(odom, nearest, remaining);
}

Twist2 PathFollower::turn_on_spot(double error) const {
  if (std::hypot(last_.vx, last_.vy) > kStanding) return {};
  const double rate =
      std::sqrt(2 * params_.braking_share * platform_.max_turn_acceleration * std::fabs(error));
  return {0, 0, std::copysign(std::min(platform_.max_turn, rate), error)};
}

Twist2 PathFollower::pursue(const Pose2& odom, std::size_t nearest, double remaining) const {
  const auto path = plan_.path();
  const double now = std::hypot(last_.vx, last_.vy);
  const double ahead = params_.lookahead + params_.lookahead_time * now;
  std::size_t aim = nearest;
  while (aim + 1 < path.size() && (path[aim].position() - odom.position()).norm() < ahead) ++aim;
  Eigen::Vector2d to = odom.inverse() * path[aim].position();
  if (plan_.reverse) to = -to;  // as seen by a robot whose front is its back
  const double distance = to.norm();
  const double share = params_.braking_share * platform_.max_acceleration;
  double speed = std::min({plan_.max_speed, platform_.max_speed, std::sqrt(2 * share * remaining)});
  if (distance < kShortest && remaining < kShortest) return {};

  if (platform_.drive == Drive::holonomic) {
    const double yaw_error = wrap_angle(path[(nearest + aim) / 2].yaw - odom.yaw);
    const double turn = std::clamp(params_.yaw_gain * yaw_error, -platform_.max_turn, platform_.max_turn);
    speed *= std::max(0.3, std::cos(std::min(M_PI / 2, 1.5 * std::fabs(yaw_error))));
    const Eigen::Vector2d v = to * (speed / std::max(distance, kShortest)) * (plan_.reverse ? -1.0 : 1.0);
    return {v.x(), v.y(), turn};
  }
  const double curvature = 2 * to.y() / std::max(distance * distance, kShortest * kShortest);
  if (to.x() <= 0) return {};
  if (std::fabs(curvature) * speed > 0.8 * platform_.max_turn)
    speed = 0.8 * platform_.max_turn / std::fabs(curvature);
  return {plan_.reverse ? -speed : speed, 0, speed * curvature};
}

Twist2 PathFollower::towards(const Twist2& wanted, double dt) const {
  const Eigen::Vector2d from(last_.vx, last_.vy);
  Eigen::Vector2d change = Eigen::Vector2d(wanted.vx, wanted.vy) - from;
  const double most = platform_.max_acceleration * dt;
  if (change.norm() > most) change *= most / change.norm();
  const Eigen::Vector2d v = from + change;
  return {v.x(), v.y(), stepped(last_.wz, wanted.wz, platform_.max_turn_acceleration * dt)};
}

Twist2 PathFollower::braked(double dt) const {
  // Down along the curve that the robot is on, which the check of the command before found free.
  const double speed = std::hypot(last_.vx, last_.vy);
  double keep = 0.0;
  if (speed > 0.0) keep = std::max(keep, 1.0 - platform_.max_acceleration * dt / speed);
  if (last_.wz != 0.0)
    keep = std::max(keep, 1.0 - platform_.max_turn_acceleration * dt / std::fabs(last_.wz));
  return {keep * last_.vx, keep * last_.vy, keep * last_.wz};
}

}  // namespace adit::nav
