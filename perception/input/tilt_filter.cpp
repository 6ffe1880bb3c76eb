// SPDX-License-Identifier: Apache-2.0
#include "perception/input/tilt_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace adit::perception {
namespace {

constexpr double kGravity = 9.81;                // m/s2
constexpr double kInG = 0.8, kMostInG = 1.25;    // of a sample in g at rest
constexpr double kRest = 8.0, kMostRest = 11.6;  // m/s2, of one at rest
constexpr double kLongestStep = 0.1;             // s: over a longer gap the gyro is not integrated
constexpr double kAfterGap = 10.0;               // of the gain, in the step after a gap
constexpr std::uint64_t kHeld = 200'000'000;     // ns after the newest sample
constexpr std::uint64_t kOldVelocity = 300'000'000;
constexpr std::uint64_t kSetBack = 1'000'000'000;  // ns: an older stamp is of a clock that was set back
constexpr double kSmooth = 0.15;                   // s: of the derivative of the speed

std::string text(const char* format, double value) {
  char out[160];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

}  // namespace

Eigen::Quaterniond level_from(const Eigen::Vector3d& up) {
  // Yaw is 0: x of base_link stays in the plane y = 0.
  const double pitch = std::asin(std::clamp(-up.x(), -1.0, 1.0)), roll = std::atan2(up.y(), up.z());
  return Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

Eigen::Vector2d roll_pitch(const Eigen::Quaterniond& R_level_base) {
  const Eigen::Vector3d up = R_level_base.conjugate() * Eigen::Vector3d::UnitZ();
  return {std::atan2(up.y(), up.z()), std::asin(std::clamp(-up.x(), -1.0, 1.0))};
}

TiltFilter::TiltFilter(const Mounting& mounting, const TiltFilterParams& params)
    : params_(params), R_base_imu_(mounting.pose().orientation), lever_(mounting.position()) {}

void TiltFilter::set_velocity(std::uint64_t stamp, const Eigen::Vector3d& velocity) {
  if (stamp + kSetBack < velocity_stamp_) velocity_stamp_ = 0;
  if (!velocity.allFinite() || stamp == 0 || stamp <= velocity_stamp_) return;
  const double dt = static_cast<double>(stamp - velocity_stamp_) * 1e-9;
  if (velocity_stamp_ == 0 || stamp - velocity_stamp_ > kOldVelocity)
    acceleration_.setZero();
  else
    acceleration_ += std::min(1.0, dt / kSmooth) * ((velocity - velocity_) / dt - acceleration_);
  velocity_ = velocity;
  velocity_stamp_ = stamp;
}

Result<void> TiltFilter::add(const ImuSample& sample) {
  if (!sample.gyro.allFinite() || !sample.accel.allFinite())
    return {Reason::malformed, "a sample of the IMU is no number"};
  if (sample.stamp + kSetBack < newest_) restart();
  if (sample.stamp <= newest_) return {};
  const Eigen::Vector3d gyro = R_base_imu_ * sample.gyro, accel = R_base_imu_ * sample.accel;
  turns_.add_rate(sample.stamp, gyro.z());
  if (!started_) {
    newest_ = sample.stamp;
    return start(sample.stamp, gyro, accel);
  }
  const double dt = static_cast<double>(sample.stamp - newest_) * 1e-9;
  newest_ = sample.stamp;
  follow(dt, gyro, scale_ * accel);
  keep(sample.stamp);
  return {};
}

void TiltFilter::restart() {
  started_ = false;
  count_ = size_ = 0;
  newest_ = velocity_stamp_ = 0;
  accel_sum_.setZero();
  gyro_sum_.setZero();
  driven_sum_.setZero();
}

Result<void> TiltFilter::start(std::uint64_t stamp, const Eigen::Vector3d& gyro,
                               const Eigen::Vector3d& accel) {
  if (count_ == 0) start_stamp_ = stamp;
  accel_sum_ += accel;
  driven_sum_ += driven(gyro);
  gyro_sum_ += gyro;
  ++count_;
  if (static_cast<double>(stamp - start_stamp_) * 1e-9 < params_.start) return {};
  const Eigen::Vector3d mean = accel_sum_ / static_cast<double>(count_);
  const Eigen::Vector3d turn = gyro_sum_ / static_cast<double>(count_);
  const Eigen::Vector3d moving = driven_sum_ / static_cast<double>(count_);
  accel_sum_.setZero();
  driven_sum_.setZero();
  gyro_sum_.setZero();
  count_ = 0;
  const double size = mean.norm();
  const bool in_g = size >= kInG && size <= kMostInG;
  if (!in_g && !(size >= kRest && size <= kMostRest)) {
    refusal_ = text("the IMU measures %.2f at rest, which is gravity neither in m/s2 nor in g", size);
    return {Reason::imu_mounting, refusal_};
  }
  const Eigen::Vector3d up = ((in_g ? kGravity : 1.0) * mean - moving).normalized();
  if (up.z() < std::cos(params_.steepest)) {
    refusal_ = text("by the IMU the body leans by %.0f degrees: it is not mounted as `sensors: imu:` says",
                    std::acos(std::clamp(up.z(), -1.0, 1.0)) * 180 / M_PI);
    return {Reason::imu_mounting, refusal_};
  }
  refusal_.clear();
  scale_ = in_g ? kGravity : 1.0;
  up_ = up;
  // A body that stands shows the bias of its gyro.
  const bool stands = velocity_.norm() < params_.still && turn.norm() < params_.still;
  bias_ = stands ? turn : Eigen::Vector3d::Zero();
  started_ = true;
  keep(stamp);
  return {};
}

Eigen::Vector3d TiltFilter::driven(const Eigen::Vector3d& rate) const {
  Eigen::Vector3d out = rate.cross(rate.cross(lever_));
  if (velocity_stamp_ != 0 && newest_ <= velocity_stamp_ + kOldVelocity)
    out += acceleration_ + rate.cross(velocity_);
  return out;
}

void TiltFilter::follow(double dt, const Eigen::Vector3d& gyro, const Eigen::Vector3d& accel) {
  const bool gap = dt > kLongestStep;
  const Eigen::Vector3d rate = gyro - bias_;
  if (!gap && rate.squaredNorm() > 1e-16) up_ = Eigen::AngleAxisd(-rate.norm() * dt, rate.normalized()) * up_;
  const Eigen::Vector3d measured = accel - driven(rate);
  const double size = measured.norm();
  const double weight = 1.0 - std::fabs(size - kGravity) / (params_.gate * kGravity);
  if (weight > 0) {
    const Eigen::Vector3d up = measured / size;
    const double share = std::min(0.5, params_.gain * weight * (gap ? kAfterGap * kLongestStep : dt));
    up_ += share * (up - up_);
    if (!gap) bias_ += params_.bias_gain * weight * dt * up_.cross(up);
  }
  up_.normalize();
}

void TiltFilter::keep(std::uint64_t stamp) {
  if (size_ == kCapacity) {
    first_ = (first_ + 1) % kCapacity;
    --size_;
  }
  entries_[(first_ + size_) % kCapacity] = {stamp, up_};
  ++size_;
}

Result<Eigen::Quaterniond> TiltFilter::at(std::uint64_t stamp) const {
  if (!refusal_.empty()) return Error{Reason::imu_mounting, refusal_};
  if (!turns_.refusal().empty()) return Error{Reason::imu_mounting, turns_.refusal()};
  if (size_ == 0) return Error{Reason::no_localisation, "the IMU has not shown the attitude yet"};
  if (stamp < entry(0).stamp || stamp > newest_ + kHeld)
    return Error{Reason::no_localisation, "the IMU shows no attitude of that time"};
  std::size_t low = 0, high = size_ - 1;
  while (low < high) {
    const std::size_t middle = (low + high + 1) / 2;
    if (entry(middle).stamp <= stamp)
      low = middle;
    else
      high = middle - 1;
  }
  const Entry& before = entry(low);
  if (low + 1 == size_ || before.stamp == stamp) return level_from(before.up);
  const Entry& after = entry(low + 1);
  const double part =
      static_cast<double>(stamp - before.stamp) / static_cast<double>(after.stamp - before.stamp);
  return level_from((before.up + part * (after.up - before.up)).normalized());
}

}  // namespace adit::perception
