// SPDX-License-Identifier: Apache-2.0
#include "sim/world/chassis.hpp"

#include <algorithm>
#include <cmath>

namespace adit::sim {
namespace {

constexpr double kGaitFrequency = 1.8;  // Hz
constexpr double kGaitBob = 0.01;       // m, up and down
constexpr double kGaitSway = 1.5;       // degrees
constexpr double kGaitFullSpeed = 0.3;  // m/s: a slower walk sways less
constexpr double kGaitTime = 0.3;       // s, in which the gait begins and ends
constexpr double kLongestStep = 0.02;   // s: the springs are integrated in steps no longer than this

// Natural frequency of the suspension, or of a flying body's attitude control, Hz.
double suspension_frequency(Drive drive) {
  switch (drive) {
    case Drive::differential:
      return 2.0;
    case Drive::tracked:
    case Drive::car:
      return 1.5;
    case Drive::holonomic:
      return 1.7;
    case Drive::aerial:
      return 3.0;
  }
  return 2.0;
}

}  // namespace

Eigen::Quaterniond Attitude::orientation(double yaw) const {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

std::optional<Attitude> ground_attitude(const StandingMap& ground, const Platform& platform,
                                        const Pose2& pose) {
  const double centre = ground.ground(pose.x, pose.y);
  if (std::isnan(centre)) return std::nullopt;
  const double along = 0.5 * kContactLength * platform.length, across = 0.5 * kContactWidth * platform.width;
  // Ground that differs by more belongs to another floor, which carries no wheel.
  const double reach = platform.step + platform.steepest() * std::hypot(along, across);
  const auto height = [&](double x, double y) {
    const Eigen::Vector2d at = pose * Eigen::Vector2d(x, y);
    return ground.contact(at.x(), at.y(), centre, reach);
  };
  const double front_left = height(along, across), front_right = height(along, -across);
  const double rear_left = height(-along, across), rear_right = height(-along, -across);
  Attitude out;
  out.z = 0.25 * (front_left + front_right + rear_left + rear_right);
  out.pitch = std::atan((rear_left + rear_right - front_left - front_right) / (4.0 * along));
  out.roll = std::atan((front_left + rear_left - front_right - rear_right) / (4.0 * across));
  return out;
}

Chassis::Chassis(const Platform& platform)
    : flies_(platform.flies()),
      walks_(platform.drive == Drive::holonomic),
      frequency_(2.0 * M_PI * suspension_frequency(platform.drive)),
      damping_(flies_ ? 0.8 : 0.35),
      compliance_(1.0 / kGravity),
      limit_(2.0 * platform.max_acceleration) {
  if (flies_) return;
  const double gyration = (platform.length * platform.length + platform.height * platform.height) / 12.0;
  compliance_ = 0.5 * platform.height / (frequency_ * frequency_ * gyration);
}

void Chassis::start(const Attitude& ground) {
  z_ = {ground.z, 0.0};
  roll_ = {ground.roll, 0.0};
  pitch_ = {ground.pitch, 0.0};
}

void Chassis::Spring::advance(double target, double frequency, double damping, double dt) {
  speed += dt * (frequency * frequency * (target - at) - 2.0 * damping * frequency * speed);
  at += dt * speed;
}

void Chassis::advance(const Attitude& ground, const Eigen::Vector2d& acceleration, double speed, double dt) {
  // A contact stops a body within one step; the suspension does not follow such a jolt.
  const Eigen::Vector2d a = acceleration.cwiseMax(-limit_).cwiseMin(limit_);
  // Inertia lifts the nose and the inner side; a flying body lowers both to gain thrust that way.
  const double sign = flies_ ? 1.0 : -1.0;
  const double pitch = ground.pitch + std::atan(sign * compliance_ * a.x());
  const double roll = ground.roll - std::atan(sign * compliance_ * a.y());
  const int parts = std::max(1, static_cast<int>(std::ceil(dt / kLongestStep - 1e-9)));
  for (int n = 0; n < parts; ++n) {
    const double part = dt / parts;
    z_.advance(ground.z, frequency_, damping_, part);
    roll_.advance(roll, frequency_, damping_, part);
    pitch_.advance(pitch, frequency_, damping_, part);
  }
  if (flies_) z_ = {ground.z, 0.0};
  if (!walks_) return;
  const double wanted = std::min(1.0, speed / kGaitFullSpeed);
  gait_ += (wanted - gait_) * std::min(1.0, dt / kGaitTime);
  if (gait_ < 1e-3 && wanted == 0.0) gait_ = 0.0;
  // Two steps make one sway from side to side and back: the phase runs over both.
  if (gait_ > 0.0) phase_ = std::fmod(phase_ + 2.0 * M_PI * kGaitFrequency * dt, 4.0 * M_PI);
}

Attitude Chassis::attitude() const {
  Attitude out{z_.at, roll_.at, pitch_.at};
  if (gait_ == 0.0) return out;
  out.z += gait_ * kGaitBob * std::sin(phase_);
  out.pitch += gait_ * kGaitSway * kDegree * std::cos(phase_);
  out.roll += gait_ * kGaitSway * kDegree * std::sin(0.5 * phase_);
  return out;
}

}  // namespace adit::sim
