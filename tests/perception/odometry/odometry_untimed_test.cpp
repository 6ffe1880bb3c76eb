// SPDX-License-Identifier: Apache-2.0
// Sweeps whose points have no times, so that the motion distorts them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/time/random.hpp"
#include "perception/odometry/lidar_odometry.hpp"

namespace adit::perception {
namespace {

constexpr std::uint64_t kFirstCloud = 1'000'000'000'000, kCloudPeriod = 100'000'000;  // ns

/// The way along a ray to the first surface of a street along x, m: ground 1.7 m below, a facade on each
/// side, and pillars of 1.6 m before the left one each 7.3 m, before the right and far one each 14.6 m.
double range_in_street(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  constexpr double kLeft = 7.37, kRight = -18.4, kPitch = 7.3, kSize = 1.6;  // m
  double range = std::numeric_limits<double>::infinity();
  const auto plane = [&](int axis, double at) {
    const double t = (at - from[axis]) / ray[axis];
    if (t > 0) range = std::min(range, t);
  };
  plane(2, -1.7);
  plane(1, kLeft);
  plane(1, kRight);
  const auto pillar = [&](double x, double y) {
    double enter = 0, leave = range;
    for (const auto& [axis, low] : {std::pair{0, x}, std::pair{1, y}}) {
      const double a = (low - from[axis]) / ray[axis], b = (low + kSize - from[axis]) / ray[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter < leave) range = enter;
  };
  const double first = std::floor(from.x() / (2 * kPitch)) * 2 * kPitch + 0.37;
  for (int n = -3; n <= 3; ++n) {
    pillar(first + 2 * n * kPitch, kLeft - kSize);
    pillar(first + (2 * n + 1) * kPitch, kLeft - kSize);
    pillar(first + 2 * n * kPitch, kRight);
  }
  return range;
}

/// A sweep that turns clockwise and passes the front in the middle of its time, with beams at any elevation:
/// real rings wander over the ground as the body moves.
std::vector<Eigen::Vector3f> sweep_in_street(double middle, double speed, Random& random) {
  std::vector<Eigen::Vector3f> points;
  for (int ring = 0; ring < 32; ++ring)
    for (int n = 0; n < 450; ++n) {
      const double azimuth = M_PI * (1 - 2 * (n + 0.5) / 450), elevation = random.uniform(-0.35, 0.1);
      const Eigen::Vector3d from(middle + speed * 0.1 * ((n + 0.5) / 450 - 0.5), 0, 0);
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const double range = range_in_street(from, ray) + random.uniform(-0.03, 0.03);
      if (range < 60) points.push_back((range * ray).cast<float>());
    }
  return points;
}

/// Error of the way over 3 s at 6 m/s, after a start from rest, m.
double error_of_way(bool deskewed) {
  LidarOdometry odometry(LidarOdometryParams::clouds_only(0.02, 0.3, 100));
  Random random(3);
  constexpr double kSpeed = 6.0;  // m/s
  constexpr int kStart = 20, kSweeps = 30;
  double x = 0, error = 0;
  for (int n = 0; n <= kStart + kSweeps; ++n) {
    const double speed = kSpeed * std::min(1.0, static_cast<double>(n) / kStart);
    odometry.advance(kFirstCloud + static_cast<std::uint64_t>(n) * kCloudPeriod);
    odometry.update(sweep_in_street(x, speed, random), {}, deskewed);
    if (n == kStart || n == kStart + kSweeps) error = odometry.state().pose.position.x() - x - error;
    x += 0.1 * speed;
  }
  return error;
}

TEST(OdometryUntimed, DistortionMattersLessWhenItIsKnownToBeThere) {
  const double taken_as_rigid = error_of_way(true), known = error_of_way(false);
  EXPECT_LT(std::abs(known), 0.7 * std::abs(taken_as_rigid)) << known << " m, " << taken_as_rigid << " m";
}

}  // namespace
}  // namespace adit::perception
