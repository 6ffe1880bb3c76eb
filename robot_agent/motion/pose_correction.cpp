// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/pose_correction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "perception/odometry/so3.hpp"

namespace adit::agent {
namespace {

constexpr double kUsualStep = 0.02;  ///< Between two samples of a driver that sends no stamps, s.
constexpr double kMaxStep = 0.5;     ///< After a longer silence no more is made up for at once, s.
constexpr double kAlone = 0.1;       ///< Standard deviation of a way by the driver's odometry alone, share.
constexpr double kSlipping = 1.0;    ///< The same while wheels slip: the body may have stood all the while.
constexpr std::uint64_t kLate = 500'000'000;  ///< A sample that is older than this is of another clock, ns.

bool is_pose(const Pose3& pose) {
  return pose.position.allFinite() && std::fabs(pose.orientation.norm() - 1.0) < 1e-3;
}

double square(double value) { return value * value; }

double turn_between(const Pose3& a, const Pose3& b) {
  return perception::log_so3(a.orientation.conjugate() * b.orientation).norm();
}

double seconds_between(std::uint64_t earlier, std::uint64_t later) {
  return static_cast<double>(later - earlier) * 1e-9;
}

/// A pose on the way from one to another, at most so far from the first, m and rad.
Pose3 towards(const Pose3& from, const Pose3& to, double way, double turn) {
  const Eigen::Vector3d shift = to.position - from.position;
  const Eigen::Vector3d about = perception::log_so3(from.orientation.conjugate() * to.orientation);
  const double part =
      std::min({1.0, way / std::max(1e-9, shift.norm()), turn / std::max(1e-9, about.norm())});
  if (part >= 1.0) return to;
  return {from.position + part * shift, (from.orientation * perception::exp_so3(part * about)).normalized()};
}

}  // namespace

void PoseCorrection::begin_frame(std::uint64_t stamp) {
  wanted_ = T_odom_driver_;  // Another value now would be a second jump.
  T_odom_local_.reset();
  T_driver_base_.reset();
  T_odom_base_.reset();
  slip_ = 0.0;
  frame_began_ = stamp;
}

void PoseCorrection::shift(const Pose3& correction) {
  wanted_ = correction * wanted_;
  wanted_.orientation.normalize();
  if (T_odom_local_) T_odom_local_ = correction * *T_odom_local_;
  ++jumps_;
}

void PoseCorrection::take(const OdometryReport& report, Time now) {
  if (!is_pose(report.T_local_driver) || !is_pose(report.T_local_base) || !std::isfinite(report.sigma) ||
      !std::isfinite(report.sigma_seen) || report.stamp < frame_began_)
    return;
  heard_ = now;
  health_ = report.health;
  if (report.health == Localisation::starting || !T_driver_base_) return;
  const bool stepped = report.steps != account_.steps;
  if (!T_odom_local_ || report.instance != account_.instance || (stepped && holds_steps_until_))
    begin(report);
  else if (stepped)
    ++jumps_;
  account_.steps = report.steps;
  if (holds_steps_until_ && report.steps >= *holds_steps_until_) holds_steps_until_.reset();
  if (report.relocalised != std::exchange(account_.relocalised, report.relocalised) &&
      std::exchange(account_.unplaced, false))
    account_.before = account_.seen_before;
  if (account_.unplaced) health_ = Localisation::lost;
  const bool lost = health_ == Localisation::lost;
  if (lost != std::exchange(account_.lost, lost)) ++jumps_;
  const Pose3 before = wanted_;
  wanted_ = *T_odom_local_ * report.T_local_driver;
  reported_ = report.sigma;
  // It falls where the lidar sees again what it had lost; what grows from there on counts.
  account_.from = std::min(account_.from, reported_);
  const auto since_start = [&](double sigma) {
    return std::sqrt(square(account_.before) + std::max(0.0, square(sigma) - square(account_.from)));
  };
  sigma_ = since_start(reported_);
  account_.seen = account_.unplaced ? account_.seen_before : lost ? since_start(report.sigma_seen) : sigma_;
  slip_ = 0.0;
  if (reported_at_ != 0 && report.stamp > reported_at_)
    slip_ = ((before * *T_driver_base_).position - (wanted_ * *T_driver_base_).position).norm() /
            std::max(kUsualStep, seconds_between(reported_at_, report.stamp));
  reported_at_ = report.stamp;
  slips_ = report.wheels_slip;
  alone_ = 0.0;
}

void PoseCorrection::begin(const OdometryReport& report) {
  const Pose3 here = wanted_ * *T_driver_base_, local = report.T_local_driver * *T_driver_base_;
  const Eigen::Quaterniond turn(
      Eigen::AngleAxisd(wrap_angle(here.yaw() - local.yaw()), Eigen::Vector3d::UnitZ()));
  T_odom_local_ = Pose3{here.position - turn * local.position, turn};
  const double alone = alone_;
  if (account_.instance == 0) {
    account_.from = 0.0;
  } else if (report.instance == account_.instance) {
    account_.before = std::hypot(account_.before, alone);
  } else {
    account_.unplaced = account_.lost;
    account_.seen_before = account_.lost ? account_.seen : std::hypot(sigma_, alone);
    account_.before = std::hypot(sigma_, alone);
    account_.from = 0.0;
  }
  if (report.instance != account_.instance) account_.relocalised = report.relocalised;
  account_.instance = report.instance;
  reported_at_ = 0;
  ++jumps_;
}

Pose3 PoseCorrection::apply(const Pose3& T_driver_base, std::uint64_t stamp) {
  const Pose3 carried = T_odom_driver_ * T_driver_base;
  if (stamp != 0 && stamp < applied_ && applied_ - stamp <= kLate) return carried;
  const bool dated = stamp != 0 && applied_ != 0 && stamp > applied_;
  const double dt = dated ? std::min(kMaxStep, seconds_between(applied_, stamp)) : kUsualStep;
  applied_ = stamp;
  if (T_driver_base_)
    alone_ += (slips_ ? kSlipping : kAlone) * (T_driver_base.position - T_driver_base_->position).norm();
  T_driver_base_ = T_driver_base;
  const Pose3 from = T_odom_base_.value_or(carried);
  const bool drives = (carried.position - from.position).norm() <= max_speed_ * dt + MotionBound::kNoise &&
                      turn_between(from, carried) <= max_turn_ * dt + MotionBound::kHeadingNoise;
  if (drives) {
    T_odom_base_ = towards(from, wanted_ * T_driver_base, max_speed_ * dt, max_turn_ * dt);
    T_odom_driver_ = *T_odom_base_ * T_driver_base.inverse();
    T_odom_driver_.orientation.normalize();
  } else {
    T_odom_base_ = carried;
  }
  pending_ = (T_odom_base_->position - (wanted_ * T_driver_base).position).norm();
  return *T_odom_base_;
}

std::optional<Pose3> PoseCorrection::located(const OdometryReport& report) const {
  if (!T_odom_local_ || report.instance != account_.instance) return std::nullopt;
  return *T_odom_local_ * report.T_local_base;
}

double PoseCorrection::moved() const {
  return std::sqrt(std::max(0.0, square(sigma_) - square(account_.seen)));
}

double PoseCorrection::sigma() const {
  const double since = reported_at_ != 0 && applied_ > reported_at_
                           ? std::min(kMaxStep, seconds_between(reported_at_, applied_))
                           : 0.0;
  return std::hypot(sigma_, alone_) + pending_ + slip_ * since;
}

Localisation PoseCorrection::health(Time now) const {
  if (!heard_ || now - *heard_ >= kSilence) return Localisation::starting;
  return health_ == Localisation::ok && pending_ > kPending ? Localisation::weak : health_;
}

}  // namespace adit::agent
