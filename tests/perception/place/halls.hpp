// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include "core/config/platform_file.hpp"
#include "core/time/random.hpp"
#include "perception/place/keyframe.hpp"
#include "sim/drive/drive_recording.hpp"

namespace adit::perception {

/// Two halls; the right one is furnished otherwise.
inline std::shared_ptr<const sim::World> halls() {
  const std::vector<sim::Box> boxes{
      {-0.2, 0, 0, 12, 0, 3}, {14, 14.2, 0, 12, 0, 3}, {0, 14, -0.2, 0, 0, 3},    {0, 14, 12, 12.2, 0, 3},
      {4, 5, 4, 5, 0, 2},     {8, 8.6, 7, 9, 0, 1.2},  {10, 11, 2.5, 3.2, 0, 3},  {5, 5.3, 8, 8.3, 0, 3},
      {30, 30.2, 0, 9, 0, 3}, {39, 39.2, 0, 9, 0, 3},  {30, 39.2, -0.2, 0, 0, 3}, {30, 39.2, 9, 9.2, 0, 3},
      {36, 37, 1, 6, 0, 2}};
  return std::make_shared<const sim::World>(sim::make_box_world(boxes, 0.0, 3.0).value());
}

/// Scans a metre apart, and where they were taken. `planar`: by a lidar of one ring.
inline std::vector<Keyframe> scans(const Pose2& start, const Eigen::Vector2d& end, std::uint64_t seed,
                                   bool planar = false) {
  sim::DriveSpec spec;
  spec.world = halls();
  spec.platform = config::load_platform("wheeled").value();
  spec.start = start;
  spec.steps = {sim::DriveTo{end}};
  spec.seed = seed;
  if (planar) {
    spec.lidar = sim::LidarParams::planar();
    spec.lidar.elevations = {0.0};
    spec.lidar.rings = 1;
  }
  const auto drive = sim::record_drive(spec);
  EXPECT_TRUE(drive.ok());
  const Pose3 T_base_lidar = spec.platform.lidar().mounting.pose();
  std::vector<Keyframe> keyframes;
  for (const Sweep& sweep : drive->sweeps) {
    const Pose3 T_world_base = drive->truth_at(sim::DriveRecording::end_of(sweep));
    if (!keyframes.empty() && (keyframes.back().T_odom_base.position - T_world_base.position).norm() < 1.0)
      continue;
    PointCloud points;
    for (const TimedPoint& p : sweep.points) {
      const auto stamp = sweep.stamp + static_cast<std::uint64_t>(p.time * 1e9);
      const Pose3 T_base = T_world_base.inverse() * drive->truth_at(stamp) * T_base_lidar;
      points.push_back((T_base.orientation * p.position.cast<double>() + T_base.position).cast<float>());
    }
    keyframes.push_back(make_keyframe(points, T_world_base, 0, planar));
  }
  EXPECT_GE(keyframes.size(), 2U);
  return keyframes;
}

/// Of a drive through the left hall.
inline const std::vector<Keyframe>& before() {
  static const auto all = scans({2, 2, 0}, {6, 1.5}, 1);
  return all;
}

/// A pose beside another one.
inline Pose3 beside(const Pose3& truth, double x, double y, double yaw) {
  Pose3 guess = truth;
  guess.position += Eigen::Vector3d(x, y, 0);
  guess.orientation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * guess.orientation;
  return guess;
}

/// Adds an upright wall, 2 m high, with a point each 0.1 m and with noise of a centimetre.
inline void add_wall(PointCloud& points, const Eigen::Vector2f& from, const Eigen::Vector2f& to) {
  Random random(static_cast<std::uint64_t>(points.size()) + 1);
  const int steps = static_cast<int>((to - from).norm() / 0.1f);
  for (int n = 0; n <= steps; ++n)
    for (float z = 0.0f; z < 2.0f; z += 0.2f) {
      const Eigen::Vector2f at = from + (to - from) * static_cast<float>(n) / static_cast<float>(steps);
      points.emplace_back(at.x() + static_cast<float>(random.uniform(-0.01, 0.01)),
                          at.y() + static_cast<float>(random.uniform(-0.01, 0.01)), z);
    }
}

}  // namespace adit::perception
