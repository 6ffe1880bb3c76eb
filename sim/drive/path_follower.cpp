// SPDX-License-Identifier: Apache-2.0
#include "sim/drive/path_follower.hpp"

#include <algorithm>
#include <cmath>

namespace adit::sim {
namespace {

constexpr double kArrived = 0.1;        // m: at the last of several places in a row
constexpr double kShortestAhead = 0.4;  // m: pure pursuit's lookahead at low speed
constexpr double kAheadTime = 0.6;      // s: lookahead by speed
constexpr double kTurnFirst = 0.8;      // rad: a larger heading error is turned off on the spot
constexpr double kTurnGain = 3.0;       // 1/s
constexpr double kTurned = 0.01;        // rad
constexpr double kSlowest = 0.05;       // m/s: while it approaches a place
constexpr double kSlowestTurn = 0.03;   // rad/s
constexpr double kComfort = 0.5;        // share of the platform's acceleration

}  // namespace

PathFollower::PathFollower(std::vector<DriveStep> steps, const Platform& platform, const Pose2& start)
    : steps_(std::move(steps)), platform_(platform), from_(start.position()), yaw_(start.yaw) {}

void PathFollower::finish(const Eigen::Vector2d& from) {
  ++at_;
  from_ = from;
  turned_ = stood_ = 0.0;
}

Twist2 PathFollower::drive(const DriveTo& to, const Pose2& pose) {
  const bool last = at_ + 1 == steps_.size() || !std::holds_alternative<DriveTo>(steps_[at_ + 1]);
  const Eigen::Vector2d line = to.place - from_;
  const double length = line.norm();
  const Eigen::Vector2d along = length > 1e-6 ? Eigen::Vector2d(line / length) : Eigen::Vector2d(1, 0);
  const double left = length - along.dot(pose.position() - from_);
  const double distance = (to.place - pose.position()).norm();
  const double ahead = std::max(kShortestAhead, kAheadTime * to.speed);
  if (last ? distance < kArrived || left < 0.02 : left < 0.5 * ahead) {
    finish(to.place);
    return {};
  }
  // The target is on the line, at the lookahead's distance from the nearest point of it.
  const Eigen::Vector2d target = left > ahead ? Eigen::Vector2d(to.place - along * (left - ahead)) : to.place;
  const Eigen::Vector2d local = pose.inverse() * target;
  const double error = std::atan2(local.y(), local.x());
  if (std::abs(error) > kTurnFirst && platform_.turns_on_spot())
    return {0.0, 0.0, std::clamp(kTurnGain * error, -platform_.max_turn, platform_.max_turn)};
  // At a corner it slows down as if to half of its speed.
  const double a = kComfort * platform_.max_acceleration;
  const double corner = last ? 0.0 : 0.5 * to.speed;
  double speed = std::sqrt(corner * corner + 2.0 * a * std::max(0.0, left - (last ? 0.5 * kArrived : 0.0)));
  speed = std::clamp(speed, kSlowest, std::max(kSlowest, to.speed));
  const double curvature = 2.0 * local.y() / std::max(1e-3, local.squaredNorm());
  // The turn rate limits the speed, not the curvature.
  if (std::abs(curvature) * speed > platform_.max_turn) speed = platform_.max_turn / std::abs(curvature);
  return {speed, 0.0, speed * curvature};
}

Twist2 PathFollower::turn(const TurnBy& by, const Pose2& pose) {
  const double left = by.angle - turned_;
  if (std::abs(left) < kTurned) {
    finish(pose.position());
    return {};
  }
  const double a = kComfort * platform_.max_turn_acceleration;
  const double rate = std::clamp(std::sqrt(2.0 * a * std::abs(left)) * 0.7, kSlowestTurn, by.rate);
  return {0.0, 0.0, std::copysign(rate, left)};
}

Twist2 PathFollower::command(const Pose2& pose, double dt) {
  turned_ += wrap_angle(pose.yaw - yaw_);
  yaw_ = pose.yaw;
  if (done()) return {};
  const DriveStep& step = steps_[at_];
  if (const auto* to = std::get_if<DriveTo>(&step)) return drive(*to, pose);
  if (const auto* by = std::get_if<TurnBy>(&step)) return turn(*by, pose);
  stood_ += dt;
  if (stood_ >= std::get<StandFor>(step).time) finish(pose.position());
  return {};
}

}  // namespace adit::sim
