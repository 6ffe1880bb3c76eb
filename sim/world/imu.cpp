// SPDX-License-Identifier: Apache-2.0
#include "sim/world/imu.hpp"

#include <algorithm>
#include <cmath>

#include "sim/world/chassis.hpp"
#include "sim/world/mount_error.hpp"

namespace adit::sim {
namespace {

constexpr Duration kLongestGap = 300ms;

Eigen::Vector3d uniform(Random& random, double limit) {
  Eigen::Vector3d out;
  for (double& v : out) v = random.uniform(-limit, limit);
  return out;
}

// The rotation vector of a small rotation.
Eigen::Vector3d rotation_vector(Eigen::Quaterniond q) {
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  return (sine > 1e-12 ? 2.0 * std::atan2(sine, q.w()) / sine : 2.0) * q.vec();
}

}  // namespace

Imu::Imu(const ImuParams& params, const Pose3& T_base_imu, double noise, std::uint64_t seed)
    : params_(params),
      noise_(noise),
      random_(seed),
      T_base_imu_(T_base_imu * mount_error(random_, noise * kMountOffset, noise * params.misalignment)),
      accel_bias_(uniform(random_, noise * params.accel_bias)),
      gyro_bias_(uniform(random_, noise * params.gyro_bias)),
      accel_scale_(Eigen::Vector3d::Ones() + uniform(random_, noise * params.scale)),
      gyro_scale_(Eigen::Vector3d::Ones() + uniform(random_, noise * params.scale)),
      period_(from_seconds(1.0 / params.rate)) {
  if (params.upside_down)
    T_base_imu_.orientation = T_base_imu_.orientation * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
}

Imu::Motion Imu::motion(double dt) const {
  const auto& [before, here, after] = poses_;
  const Eigen::Vector3d acceleration = (after.position - 2.0 * here.position + before.position) / (dt * dt);
  const Eigen::Vector3d force = acceleration + Eigen::Vector3d(0.0, 0.0, kGravity);
  return {rotation_vector(before.orientation.conjugate() * after.orientation) / (2.0 * dt),
          here.orientation.conjugate() * force};
}

Eigen::Vector3d Imu::vector(double deviation) {
  Eigen::Vector3d out;
  for (double& v : out) v = deviation * gaussian(random_);
  return out;
}

ImuSample Imu::measure(const Motion& motion, Duration at, double effort) {
  ImuSample out{at, motion.gyro, motion.accel};
  if (noise_ > 0.0) {
    const double root = std::sqrt(params_.rate);
    accel_bias_ += vector(noise_ * params_.accel_walk / root);
    gyro_bias_ += vector(noise_ * params_.gyro_walk / root);
    const double accel = std::hypot(params_.accel_noise * root, params_.accel_vibration * effort);
    const double gyro = std::hypot(params_.gyro_noise * root, params_.gyro_vibration * effort);
    out.accel = out.accel.cwiseProduct(accel_scale_) + accel_bias_ + vector(noise_ * accel);
    out.gyro = out.gyro.cwiseProduct(gyro_scale_) + gyro_bias_ + vector(noise_ * gyro);
  }
  out.accel = out.accel.cwiseMax(-params_.max_accel).cwiseMin(params_.max_accel);
  out.gyro = out.gyro.cwiseMax(-params_.max_gyro).cwiseMin(params_.max_gyro);
  if (params_.in_g) out.accel /= kGravity;
  return out;
}

void Imu::advance(const Pose3& T_world_base, Duration at, Duration step, double effort) {
  std::rotate(poses_.begin(), poses_.begin() + 1, poses_.end());
  poses_[2] = T_world_base * T_base_imu_;
  if (++known_ < 3) return;
  const Duration here = at - step;
  const Motion now = motion(seconds(step));
  if (!before_) {
    before_ = now;
    next_ = here;
  }
  for (; next_ <= here; next_ += period_) {
    const double part = 1.0 - seconds(here - next_) / seconds(step);
    const Motion between{before_->gyro + part * (now.gyro - before_->gyro),
                         before_->accel + part * (now.accel - before_->accel)};
    const ImuSample sample = measure(between, next_, effort);
    if (noise_ > 0.0 && random_.chance(std::min(1.0, noise_ * params_.gaps / params_.rate)))
      silent_until_ = next_ + from_seconds(random_.uniform(0.0, seconds(kLongestGap)));
    if (next_ < silent_until_) continue;
    if (samples_.size() == kCapacity) samples_.erase(samples_.begin());
    samples_.push_back(sample);
  }
  before_ = now;
}

std::vector<ImuSample> Imu::take() { return std::exchange(samples_, {}); }

}  // namespace adit::sim
