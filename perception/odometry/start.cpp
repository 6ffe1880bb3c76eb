// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/start.hpp"

#include "perception/odometry/so3.hpp"

namespace adit::perception {
namespace {

// A body at rest with its motors on, and more than the noise of any MEMS sensor.
constexpr double kQuietGyro = 0.03, kQuietAccel = 0.3;    ///< Standard deviations, rad/s, m/s2.
constexpr double kQuietTurn = 0.05;                       ///< Mean turn rate, rad/s.
constexpr double kQuietWay = 0.01, kQuietHeading = 0.01;  ///< By the wheels, m, rad.
constexpr std::size_t kLeast = 20, kMost = 1024;

}  // namespace

void StartWatch::add(const ImuSample& sample) {
  if (first_ == 0) first_ = sample.stamp;
  imu_.push_back(sample);
  while (imu_.size() > kMost || sample.stamp - imu_.front().stamp > kRest) imu_.pop_front();
}

void StartWatch::add(const BodyMotion& sample) {
  wheels_.push_back(sample);
  while (wheels_.size() > kMost || sample.stamp - wheels_.front().stamp > kRest) wheels_.pop_front();
}

std::optional<StartAttitude> StartWatch::judge(std::uint64_t stamp) const {
  if (imu_.size() < kLeast) return std::nullopt;
  Eigen::Vector3d gyro(0, 0, 0), accel(0, 0, 0);
  const auto count = static_cast<double>(imu_.size());
  for (const ImuSample& s : imu_) {
    gyro += s.gyro / count;
    accel += s.accel / count;
  }
  double gyro_spread = 0, accel_spread = 0;
  for (const ImuSample& s : imu_) {
    gyro_spread += (s.gyro - gyro).squaredNorm() / count;
    accel_spread += (s.accel - accel).squaredNorm() / count;
  }
  bool quiet = gyro_spread < kQuietGyro * kQuietGyro && accel_spread < kQuietAccel * kQuietAccel &&
               gyro.norm() < kQuietTurn && imu_.back().stamp - imu_.front().stamp > kRest * 4 / 5;
  if (quiet && wheels_.size() > 1) {
    const Pose3 moved = wheels_.front().pose.inverse() * wheels_.back().pose;
    quiet = moved.position.head<2>().norm() < kQuietWay && std::abs(moved.yaw()) < kQuietHeading;
  }
  if (!quiet && stamp - first_ < kPatience) return std::nullopt;
  StartAttitude found;
  found.at_rest = quiet;
  found.level_from_base = rotation_between(accel, Eigen::Vector3d::UnitZ());
  if (quiet) found.gyro_bias = gyro;
  return found;
}

}  // namespace adit::perception
