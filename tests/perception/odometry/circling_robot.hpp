// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/time/random.hpp"
#include "perception/odometry/lidar_odometry.hpp"

namespace adit::perception {

/// A robot that stands for a second and then circles in a box of 8 x 6 x 3 m at up to 1 m/s, 1.5 m in radius,
/// and the odometry on its sensors. Each sensor's stamps may be off.
struct CirclingRobot {
  enum Sensor { lidar, imu, wheels };
  static constexpr double kRadius = 1.5;                      ///< m
  static constexpr std::uint64_t kBegin = 1'000'000'000'000;  ///< ns
  /// What is added to the stamps of a sensor at a time since the start, s.
  using ClockError = std::function<double(Sensor, double)>;

  static LidarOdometryParams params() {
    LidarOdometryParams out;
    out.max_speed = 1.5;
    return out;
  }
  explicit CirclingRobot(const LidarOdometryParams& with = params()) : odometry(with) {}

  double speed() const { return std::clamp(t - 1.0, 0.0, 1.0); }
  Pose3 truth() const {
    const double ramp = speed(), a = (0.5 * ramp * ramp + std::max(0.0, t - 2.0)) / kRadius;
    return Pose3::level({kRadius * std::sin(a), -kRadius * std::cos(a), a}, 0);
  }
  /// Position and heading by the odometry against the truth, m: an error of the heading counts at 4 m.
  double error() const {
    const Pose3 off = truth().inverse() * T_world_odom() * odometry.state().pose;
    return std::hypot(off.position.norm(), 4 * log_so3(off.orientation).norm());
  }
  /// The wheels begin at the true pose, so both frames are one.
  static Pose3 T_world_odom() { return {}; }

  /// Drives on for `seconds`. Calls `each` after each sweep.
  void drive(double seconds, const ClockError& clock = {}, const std::function<void()>& each = {}) {
    const int sweeps = static_cast<int>(std::lround(seconds * 10));
    for (int n = 0; n < sweeps; ++n) {
      for (int k = 0; k < 10; ++k) {
        t = 0.01 * ++ticks;
        const double v = speed();
        odometry.add(ImuSample{stamp(imu, clock),
                               {0, 0, v / kRadius},
                               {t > 1 && t <= 2 ? 1.0 : 0.0, v * v / kRadius, kStandardGravity}});
        if (k % 2 == 1) odometry.add(BodyMotion{stamp(wheels, clock), truth()});
      }
      located = odometry.advance(stamp(lidar, clock));
      if (located) odometry.update(cloud());
      if (each) each();
    }
  }

  std::uint64_t stamp(Sensor sensor, const ClockError& clock) const {
    const double error = clock ? clock(sensor, t) : 0.0;
    return kBegin + static_cast<std::uint64_t>(ticks) * 10'000'000 +
           static_cast<std::uint64_t>(static_cast<std::int64_t>(error * 1e9));
  }
  std::vector<Eigen::Vector3f> cloud() {
    std::vector<Eigen::Vector3f> points;
    const Pose3 T_base_world = truth().inverse();
    for (int n = 0; n < 2000; ++n) {
      Eigen::Vector3d p(random.uniform(-4, 4), random.uniform(-3, 3), random.uniform(-0.5, 2.5));
      const auto side = static_cast<Eigen::Index>(random.below(3));
      constexpr double kEnds[3][2]{{-4, 4}, {-3, 3}, {-0.5, 2.5}};
      p[side] = kEnds[side][random.below(2)] + random.uniform(-0.02, 0.02);
      points.push_back((T_base_world * p).cast<float>());
    }
    return points;
  }

  LidarOdometry odometry;
  Random random{1};
  int ticks{};  ///< Of 10 ms since the start.
  double t{};   ///< s
  bool located{};
};

}  // namespace adit::perception
