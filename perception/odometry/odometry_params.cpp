// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "perception/odometry/lidar_odometry.hpp"

namespace adit::perception {

double OdometryState::sigma() const {
  // The larger eigenvalue of the horizontal part.
  const double xx = covariance(0, 0), yy = covariance(1, 1), xy = covariance(1, 0);
  return std::sqrt(std::max(0.0, (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy)));
}

LidarOdometryParams LidarOdometryParams::of(const Platform& platform, bool wheels) {
  LidarOdometryParams p;
  const LidarConfig lidar = platform.lidar();
  p.motion.has_imu = platform.imu.has_value();
  p.motion.has_wheels = wheels;
  p.motion.sideways = platform.sideways();
  p.motion.flies = platform.flies();
  if (platform.imu) p.motion.imu_position = platform.imu->mounting.position();
  if (platform.drive == Drive::tracked) p.motion.wheel_slip = 0.05;
  p.motion.max_acceleration = 2 * platform.max_acceleration;
  p.motion.max_turn_acceleration = 2 * platform.max_turn_acceleration;
  p.registration.range_noise = std::max(0.005, lidar.noise);
  p.map.noise = static_cast<float>(p.registration.range_noise);
  p.dense.min_range = p.thin.min_range = static_cast<float>(std::max(lidar.min_range, 0.3));
  p.dense.max_range = p.thin.max_range = static_cast<float>(lidar.max_range);
  p.max_speed = p.motion.max_speed = platform.max_speed;
  p.motion.max_turn = platform.max_turn;
  return p;
}

LidarOdometryParams LidarOdometryParams::clouds_only(double noise, double min_range, double max_range) {
  LidarOdometryParams p;
  p.motion.has_imu = p.motion.has_wheels = false;
  p.motion.sideways = p.motion.flies = true;
  p.registration.range_noise = noise;
  // Poses are the lidar's own, so there is no error of a mounting or of a clock; what is left is the width of
  // the beam.
  p.registration.bearing_noise = 0.001;
  p.registration.max_iterations = 10;
  p.registration.has_prior = false;
  p.map.line_clouds = 1;
  p.map.wide = 0.0f;
  // Nothing else holds the pose, so the cloud's own noise has to average out.
  p.thin.wanted = 3000;
  p.dense.wanted = 20000;
  p.first_window = LidarOdometry::kMaxWindow;
  p.map.noise = static_cast<float>(noise);
  p.dense.min_range = p.thin.min_range = static_cast<float>(min_range);
  p.dense.max_range = p.thin.max_range = static_cast<float>(max_range);
  return p;
}

}  // namespace adit::perception
