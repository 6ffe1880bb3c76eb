// SPDX-License-Identifier: Apache-2.0
// Clouds and samples that are of no use.
#include <gtest/gtest.h>

#include <limits>

#include "core/time/random.hpp"
#include "tests/perception/odometry/circling_robot.hpp"

namespace adit::perception {
namespace {

constexpr std::uint64_t kFirst = 1'000'000'000'000, kPeriod = 100'000'000;  // ns

/// A box of 8 x 6 x 3 m seen from `at`, m.
std::vector<Eigen::Vector3f> room(const Eigen::Vector3d& at, Random& random) {
  std::vector<Eigen::Vector3f> points;
  for (int n = 0; n < 6000; ++n) {
    Eigen::Vector3d p(random.uniform(-4, 4), random.uniform(-3, 3), random.uniform(-0.5, 2.5));
    const auto side = static_cast<Eigen::Index>(random.below(3));
    const double ends[3][2]{{-4, 4}, {-3, 3}, {-0.5, 2.5}};
    p[side] = ends[side][random.below(2)] + random.uniform(-0.02, 0.02);
    points.push_back((p - at).cast<float>());
  }
  return points;
}

LidarOdometry clouds_only() { return LidarOdometry(LidarOdometryParams::clouds_only(0.02, 0.3, 30)); }

TEST(OdometryInput, FollowsCloudsAlone) {
  LidarOdometry odometry = clouds_only();
  Random random(1);
  for (int n = 0; n < 40; ++n) {
    odometry.advance(kFirst + static_cast<std::uint64_t>(n) * kPeriod);
    odometry.update(room({0.05 * n, 0, 0}, random));
  }
  EXPECT_NEAR(odometry.state().pose.position.x(), 0.05 * 39, 0.03);
  EXPECT_LT(odometry.state().pose.position.tail<2>().norm(), 0.03);
  EXPECT_EQ(odometry.state().health, Localisation::ok);
}

TEST(OdometryInput, FollowsCloudsAloneThatBeginInMotion) {
  LidarOdometry odometry = clouds_only();
  Random random(6);
  for (int n = 0; n < 20; ++n) {
    odometry.advance(kFirst + static_cast<std::uint64_t>(n) * kPeriod);
    odometry.update(room({0.15 * n - 1.5, 0, 0}, random));
  }
  EXPECT_NEAR(odometry.state().pose.position.x(), 0.15 * 19, 0.05);
  EXPECT_EQ(odometry.state().health, Localisation::ok);
}

TEST(OdometryInput, EmptyAndBrokenCloudsAreSurvived) {
  LidarOdometry odometry = clouds_only();
  Random random(2);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int n = 0; n < 60; ++n) {
    odometry.advance(kFirst + static_cast<std::uint64_t>(n) * kPeriod);
    std::vector<Eigen::Vector3f> cloud = room({0, 0, 0}, random);
    if (n >= 20 && n < 40) cloud.assign(n % 2 == 0 ? 0 : 5000, Eigen::Vector3f(nan, nan, nan));
    const OdometryState& state = odometry.update(cloud);
    ASSERT_TRUE(state.pose.position.allFinite());
    ASSERT_TRUE(state.covariance.allFinite());
    if (n == 35) {
      EXPECT_EQ(state.health, Localisation::weak);
    }
  }
  EXPECT_EQ(odometry.state().health, Localisation::ok);
  EXPECT_LT(odometry.state().pose.position.norm(), 0.1);
}

TEST(OdometryInput, AnotherPlaceIsLostAndTheFirstOneIsFoundAgain) {
  LidarOdometry odometry = clouds_only();
  Random random(3);
  for (int n = 0; n < 60; ++n) {
    odometry.advance(kFirst + static_cast<std::uint64_t>(n) * kPeriod);
    std::vector<Eigen::Vector3f> cloud = room({0, 0, 0}, random);
    // Noise in a ball: nothing fits.
    if (n >= 20 && n < 40)
      for (Eigen::Vector3f& p : cloud)
        p = Eigen::Vector3d(random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(0, 2)).cast<float>();
    odometry.update(cloud);
    if (n == 39) {
      EXPECT_NE(odometry.state().health, Localisation::ok);
    }
  }
  EXPECT_EQ(odometry.state().health, Localisation::ok);
  EXPECT_LT(odometry.state().pose.position.norm(), 0.1);
}

TEST(OdometryInput, WaitsForItsSensorsOfMotion) {
  LidarOdometryParams params = LidarOdometryParams::clouds_only(0.02, 0.3, 30);
  params.motion.has_wheels = true;
  LidarOdometry odometry(params);
  EXPECT_FALSE(odometry.advance(kFirst));
  EXPECT_EQ(odometry.state().health, Localisation::starting);
  odometry.add(BodyMotion{kFirst, Pose3::level({3, 4, 1}, 0)});
  EXPECT_TRUE(odometry.advance(kFirst + 1));
  Random random(4);
  odometry.update(room({0, 0, 0}, random));
  EXPECT_NEAR(odometry.state().pose.position.x(), 3, 1e-6);
  EXPECT_NEAR(odometry.state().pose.yaw(), 1, 1e-6);
}

TEST(OdometryInput, RandomSamplesNeverGiveAPoseThatIsNotFinite) {
  Random random(5);
  LidarOdometryParams params = LidarOdometryParams::clouds_only(0.02, 0.3, 30);
  params.motion.has_wheels = params.motion.has_imu = params.registration.has_prior = true;
  LidarOdometry odometry(params);
  const auto any = [&](double scale) {
    return Eigen::Vector3d(random.uniform(-scale, scale), random.uniform(-scale, scale),
                           random.uniform(-scale, scale));
  };
  for (int n = 0; n < 200; ++n) {
    const std::uint64_t stamp = kFirst + static_cast<std::uint64_t>(n) * kPeriod;
    for (int k = 0; k < 10; ++k)
      odometry.add(ImuSample{stamp - random.below(kPeriod), any(random.chance(0.1) ? 100 : 1),
                             any(random.chance(0.1) ? 1000 : 10)});
    odometry.add(BodyMotion{stamp - random.below(kPeriod),
                            {any(random.chance(0.1) ? 1e5 : 2), Eigen::Quaterniond::UnitRandom()}});
    odometry.advance(stamp);
    std::vector<Eigen::Vector3f> cloud = room(any(2), random);
    odometry.update(cloud);
    ASSERT_TRUE(odometry.state().pose.position.allFinite()) << n;
    ASSERT_TRUE(odometry.state().pose.orientation.coeffs().allFinite()) << n;
  }
}

TEST(OdometryInput, ASampleBeyondTheRangeOfAnImuIsRefused) {
  CirclingRobot robot;
  robot.drive(4);
  const std::uint64_t stamp = robot.stamp(CirclingRobot::imu, {}) + 5'000'000;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  robot.odometry.add(ImuSample{stamp, {0, 0, 0}, {30'000, 0, 0}});
  robot.odometry.add(ImuSample{stamp + 1, {70, 0, 0}, {0, 0, 9.81}});
  robot.odometry.add(ImuSample{stamp + 2, {0, 0, 0}, {0, nan, 9.81}});
  robot.drive(0.3);
  EXPECT_EQ(robot.odometry.refused_samples(), 3u);
  EXPECT_LT(robot.error(), 0.05);
}

TEST(OdometryInput, NoiseOfStandingIsNoWay) {
  LidarOdometry odometry = clouds_only();
  Random random(8);
  for (int n = 0; n < 100; ++n) {
    odometry.advance(kFirst + static_cast<std::uint64_t>(n) * kPeriod);
    odometry.update(room({0, 0, 0}, random));
  }
  EXPECT_LT(odometry.travelled(), 0.01);
  EXPECT_LT(odometry.state().sigma(), 0.006);
}

}  // namespace
}  // namespace adit::perception
