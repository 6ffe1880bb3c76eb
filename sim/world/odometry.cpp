// SPDX-License-Identifier: Apache-2.0
#include "sim/world/odometry.hpp"

#include <cmath>

namespace adit::sim {
namespace {

constexpr double kLongestSlip = 0.4;  // m
constexpr double kMostExcess = 0.4;   // share of the distance

}  // namespace

OdometryParams OdometryParams::realistic() {
  OdometryParams out;
  out.tilt = 0.5;
  out.slips = 1.0 / 30.0;
  out.altimeter = 0.03;
  return out;
}

OdometryParams OdometryParams::scaled(double noise) const {
  OdometryParams out = *this;
  for (double* error : {&out.scale, &out.drift, &out.turn, &out.tilt, &out.slips, &out.altimeter})
    *error *= noise;
  return out;
}

Odometry::Odometry(const OdometryParams& params, std::uint64_t seed)
    : params_(params),
      random_(seed),
      scale_(1.0 + params.scale * gaussian(random_)),
      rate_(params.drift * kDegree * gaussian(random_)),
      events_(derive_seed(seed, 1)) {
  if (params.turn > 0.0) turn_ += params.turn * gaussian(random_);  // else no draw: old runs stay as they are
}

double Odometry::slip(double way) {
  if (params_.slips <= 0.0) return 1.0;
  if (slipping_ <= 0.0 && events_.chance(params_.slips * way)) {
    slipping_ = kLongestSlip * events_.uniform();
    excess_ = kMostExcess * events_.uniform();
  }
  if (slipping_ <= 0.0) return 1.0;
  slipping_ -= way;
  return 1.0 + excess_;
}

void Odometry::move(const Pose2& from, const Pose2& to, double dt) {
  Pose2 motion = from.inverse() * to;
  const double way = std::hypot(motion.x, motion.y);
  motion.yaw *= turn_;
  if (way > 1e-9) {  // less is rounding
    const double keep = std::exp(-way / params_.correlation);
    const double deviation = params_.drift * kDegree;
    rate_ = keep * rate_ + std::sqrt(1.0 - keep * keep) * deviation * gaussian(random_);
    const double factor = scale_ * slip(way);
    motion.x *= factor;
    motion.y *= factor;
    motion.yaw += rate_ * way;
    // The height is integrated along the slope as it was measured.
    height_ += roll_error_ * motion.y - pitch_error_ * motion.x;
  }
  pose_ = pose_ * motion;
  twist_ = {motion.x / dt, motion.y / dt, motion.yaw / dt};
  distance_ += way;
  turned_ += std::abs(motion.yaw);
}

void Odometry::lean(const Attitude& attitude, double dt) {
  if (params_.tilt > 0.0 || params_.altimeter > 0.0) {
    const double keep = std::exp(-dt / params_.tilt_time), fresh = std::sqrt(1.0 - keep * keep);
    roll_error_ = keep * roll_error_ + fresh * params_.tilt * kDegree * gaussian(events_);
    pitch_error_ = keep * pitch_error_ + fresh * params_.tilt * kDegree * gaussian(events_);
    altimeter_ = keep * altimeter_ + fresh * params_.altimeter * gaussian(events_);
  }
  measured_ = attitude;
  measured_.roll += roll_error_;
  measured_.pitch += pitch_error_;
}

OdometrySigma Odometry::sigma() const {
  // The floor is what the sensors resolve. Slip adds its mean and, per event, its deviation.
  constexpr double kResolution = 1e-3;
  OdometrySigma out;
  const double yaw = params_.drift * kDegree * std::sqrt(2.0 * params_.correlation * distance_);
  const double events = params_.slips * distance_;
  const double slip = 0.25 * kLongestSlip * kMostExcess * (events + std::sqrt(events));
  out.yaw = std::hypot(kResolution, yaw, params_.turn * turned_);
  out.position = std::hypot(kResolution + slip, params_.scale * distance_, 0.58 * out.yaw * distance_);
  out.tilt = std::hypot(kResolution, params_.tilt * kDegree);
  // Of a random walk of the slope's error.
  out.height = std::hypot(kResolution, params_.altimeter,
                          params_.tilt * kDegree * std::sqrt(2.0 * params_.tilt_time * distance_));
  out.speed = std::hypot(kResolution, params_.scale * std::hypot(twist_.vx, twist_.vy));
  out.turn = std::hypot(kResolution, params_.turn * twist_.wz);
  return out;
}

}  // namespace adit::sim
