// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/pose_correction.hpp"

#include <algorithm>
#include <cmath>

#include "perception/odometry/so3.hpp"

namespace adit::agent {
namespace {

constexpr double kUsualStep = 0.02;  ///< Between two samples of a driver that sends no stamps, s.
constexpr double kMaxStep = 0.5;     ///< After a longer silence no more is made up for at once, s.

bool is_pose(const Pose3& pose) {
  return pose.position.allFinite() && std::fabs(pose.orientation.norm() - 1.0) < 1e-3;
}

}  // namespace

void PoseCorrection::begin_frame(std::uint64_t stamp) {
  wanted_ = T_odom_driver_;  // Another value now would be a second jump.
  T_odom_local_.reset();
  T_driver_base_.reset();
  frame_began_ = stamp;
}

void PoseCorrection::shift(const Pose3& correction) {
  wanted_ = correction * wanted_;
  wanted_.orientation.normalize();
  if (T_odom_local_) T_odom_local_ = correction * *T_odom_local_;
}

void PoseCorrection::take(const OdometryReport& report, Time now) {
  if (!is_pose(report.T_local_driver) || !std::isfinite(report.sigma) || report.stamp < frame_began_) return;
  heard_ = now;
  health_ = report.health;
  if (report.health == Localisation::starting || !T_driver_base_) return;
  if (!T_odom_local_ || report.instance != instance_) {
    const Pose3 here = wanted_ * *T_driver_base_, local = report.T_local_driver * *T_driver_base_;
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(wrap_angle(here.yaw() - local.yaw()), Eigen::Vector3d::UnitZ()));
    T_odom_local_ = Pose3{here.position - turn * local.position, turn};
    if (instance_ != 0) sigma_before_ = sigma_;
    instance_ = report.instance;
  }
  wanted_ = *T_odom_local_ * report.T_local_driver;
  sigma_ = std::hypot(sigma_before_, report.sigma);
}

Pose3 PoseCorrection::apply(const Pose3& T_driver_base, std::uint64_t stamp) {
  const bool dated = stamp != 0 && applied_ != 0 && stamp > applied_;
  const double dt = dated ? std::min(kMaxStep, static_cast<double>(stamp - applied_) * 1e-9) : kUsualStep;
  applied_ = std::max(applied_, stamp);
  T_driver_base_ = T_driver_base;
  const Pose3 have = T_odom_driver_ * T_driver_base, want = wanted_ * T_driver_base;
  const Eigen::Vector3d way = want.position - have.position;
  const Eigen::Vector3d turn = perception::log_so3(have.orientation.conjugate() * want.orientation);
  const double part = std::min(
      {1.0, kMaxSpeed * dt / std::max(1e-9, way.norm()), kMaxTurn * dt / std::max(1e-9, turn.norm())});
  if (part >= 1.0) {
    T_odom_driver_ = wanted_;
    return want;
  }
  const Pose3 moved{have.position + part * way,
                    (have.orientation * perception::exp_so3(part * turn)).normalized()};
  T_odom_driver_ = moved * T_driver_base.inverse();
  T_odom_driver_.orientation.normalize();
  return moved;
}

Localisation PoseCorrection::health(Time now) const {
  return heard_ && now - *heard_ < kSilence ? health_ : Localisation::starting;
}

}  // namespace adit::agent
