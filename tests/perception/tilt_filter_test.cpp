// SPDX-License-Identifier: Apache-2.0
#include "perception/input/tilt_filter.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "core/time/random.hpp"

namespace adit::perception {
namespace {

constexpr double kG = 9.81;
constexpr std::uint64_t kMs = 1'000'000;

Eigen::Vector2d degrees(const Result<Eigen::Quaterniond>& attitude) {
  return roll_pitch(*attitude) * 180 / M_PI;
}

TEST(TiltFilter, ShowsRollAndPitchAtRest) {
  TiltFilter filter({});
  const Eigen::Quaterniond R =
      Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitX());
  for (std::uint64_t n = 1; n <= 100; ++n)
    ASSERT_TRUE(filter.add({n * 10 * kMs, {0, 0, 0}, R.conjugate() * Eigen::Vector3d(0, 0, kG)}));
  const auto attitude = filter.at(990 * kMs);
  ASSERT_TRUE(attitude) << attitude.error().text;
  EXPECT_LT(attitude->angularDistance(R), 1e-6);
}

TEST(TiltFilter, SpeakingInGIsUnderstoodAndSaid) {
  TiltFilter filter({});
  for (std::uint64_t n = 1; n <= 100; ++n) ASSERT_TRUE(filter.add({n * 10 * kMs, {0, 0, 0}, {0, 0, 1}}));
  EXPECT_TRUE(filter.in_g());
  EXPECT_TRUE(filter.at(990 * kMs));
}

TEST(TiltFilter, UpsideDownIsRefusedUnlessTheFileSaysSo) {
  TiltFilter level({}), turned({.roll = M_PI});
  bool refused = false;
  for (std::uint64_t n = 1; n <= 100; ++n) {
    const ImuSample sample{n * 10 * kMs, {0, 0, 0}, {0, 0, -kG}};
    const auto added = level.add(sample);
    if (!added) {
      EXPECT_EQ(added.error().reason, Reason::imu_mounting);
      EXPECT_THAT(added.error().text, testing::HasSubstr("180 degrees"));
      refused = true;
    }
    ASSERT_TRUE(turned.add(sample));
  }
  EXPECT_TRUE(refused);
  EXPECT_EQ(level.at(900 * kMs).reason(), Reason::imu_mounting);
  ASSERT_TRUE(turned.at(900 * kMs));
  EXPECT_LT(degrees(turned.at(900 * kMs)).norm(), 0.01);
}

TEST(TiltFilter, NeitherMetresNorGIsRefused) {
  TiltFilter filter({});
  Result<void> last{};
  for (std::uint64_t n = 1; n <= 60 && last; ++n) last = filter.add({n * 10 * kMs, {0, 0, 0}, {0, 0, 32.2}});
  EXPECT_EQ(last.error().reason, Reason::imu_mounting);
  EXPECT_EQ(filter.add({1, {NAN, 0, 0}, {0, 0, 9}}).error().reason, Reason::malformed);
}

/// A body that drives with speed v(t) and turn rate w(t), pitched by p(t), with a biased and noisy IMU 0.3 m
/// before its middle. Gives the largest error after `settled` s, degrees.
double worst(const std::function<double(double)>& v, const std::function<double(double)>& w,
             const std::function<double(double)>& p, double seconds, bool odometry = true,
             double settled = 5) {
  Random random(7);
  const auto noise = [&](double sigma) {
    double sum = 0;
    for (int i = 0; i < 12; ++i) sum += random.uniform(0, 1);
    return sigma * (sum - 6);
  };
  TiltFilter filter({.x = 0.3, .z = 0.2});
  const double dt = 0.01;
  double most = 0;
  for (int n = 1; n * dt < seconds; ++n) {
    const double t = n * dt;
    const auto stamp = static_cast<std::uint64_t>(std::llround(t * 1e9));
    const double pitch_rate = (p(t + 1e-4) - p(t - 1e-4)) / 2e-4, turn = w(t);
    const Eigen::Quaterniond R(Eigen::AngleAxisd(p(t), Eigen::Vector3d::UnitY()));
    const Eigen::Vector3d rate =
        R.conjugate() * Eigen::Vector3d(0, 0, turn) + Eigen::Vector3d(0, pitch_rate, 0);
    const Eigen::Vector3d driven((v(t + 1e-4) - v(t - 1e-4)) / 2e-4, turn * v(t), 0);
    const Eigen::Vector3d lever = rate.cross(rate.cross(Eigen::Vector3d(0.3, 0, 0.2)));
    const Eigen::Vector3d force = R.conjugate() * (Eigen::Vector3d(0, 0, kG) + driven) + lever;
    const Eigen::Vector3d bias_w(0.003, -0.004, 0.005), bias_a(0.03, -0.02, 0.05);
    const Eigen::Vector3d noise_w(noise(0.002), noise(0.002), noise(0.002)),
        noise_a(noise(0.05), noise(0.05), noise(0.05));
    if (odometry && n % 2 == 0) filter.set_velocity(stamp, {v(t), 0, 0});
    (void)filter.add({stamp, rate + bias_w + noise_w, force + bias_a + noise_a});
    if (t < settled) continue;
    const auto attitude = filter.at(stamp);
    if (!attitude) return 1e9;
    most = std::max(most, attitude->angularDistance(R) * 180 / M_PI);
  }
  return most;
}

TEST(TiltFilter, AcceleratingIsNoSlope) {
  // 1.5 m/s2 for 1 s, and back, every 6 s: a plain accelerometer shows 8.7 degrees.
  const auto v = [](double t) {
    const double at = std::fmod(t, 6.0);
    return at < 1 ? 1.5 * at : at < 3 ? 1.5 : at < 4 ? 1.5 * (4 - at) : 0.0;
  };
  const auto none = [](double) { return 0.0; };
  EXPECT_LT(worst(v, none, none, 60, true, 20), 1.0) << "once the bias of the gyro is learned";
  EXPECT_GT(worst(v, none, none, 60, false, 20), 1.0) << "what the speed explains must matter";
}

TEST(TiltFilter, CurvesAndRampsAreFollowed) {
  const auto v = [](double) { return 1.0; };
  const auto w = [](double t) { return 1.2 * std::sin(0.5 * t); };
  const auto p = [](double t) { return 0.25 * std::sin(0.8 * t); };
  EXPECT_LT(worst(v, w, p, 60), 1.5);
}

TEST(TiltFilter, AnswersOnlyForTimesThatItKnows) {
  TiltFilter filter({});
  EXPECT_EQ(filter.at(5).reason(), Reason::no_localisation);
  for (std::uint64_t n = 1; n <= 1000; ++n) ASSERT_TRUE(filter.add({n * 10 * kMs, {0, 0, 0}, {0, 0, kG}}));
  EXPECT_EQ(filter.at(100 * kMs).reason(), Reason::no_localisation) << "it keeps 5 s at 100 Hz";
  EXPECT_TRUE(filter.at(10'150 * kMs));
  EXPECT_EQ(filter.at(10'300 * kMs).reason(), Reason::no_localisation);
  EXPECT_TRUE(filter.add({9'500 * kMs, {5, 5, 5}, {9, 9, 9}})) << "late, and left out";
  EXPECT_LT(degrees(filter.at(9'995 * kMs)).norm(), 1e-6);
}

TEST(TiltFilter, AClockThatIsSetBackStartsItAgain) {
  TiltFilter filter({});
  for (std::uint64_t n = 1; n <= 100; ++n) ASSERT_TRUE(filter.add({n * 10 * kMs, {0, 0, 0}, {0, 0, kG}}));
  ASSERT_TRUE(filter.add({9'000'000 * kMs, {0, 0, 0}, {0, 0, kG}})) << "one wild stamp";
  for (std::uint64_t n = 102; n <= 200; ++n) ASSERT_TRUE(filter.add({n * 10 * kMs, {0, 0, 0}, {0, 0, kG}}));
  EXPECT_EQ(filter.newest(), 2000 * kMs);
  EXPECT_TRUE(filter.at(1990 * kMs));
}

TEST(TiltFilter, AGyroThatTurnsTheWrongWayIsRefused) {
  TiltFilter filter({});
  for (std::uint64_t n = 1; n <= 400; ++n) {
    ASSERT_TRUE(filter.add({n * 10 * kMs, {0, 0, -1}, {0, 0, kG}}));
    filter.set_yaw(n * 10 * kMs, 0.01 * static_cast<double>(n));
  }
  EXPECT_EQ(filter.at(3990 * kMs).reason(), Reason::imu_mounting);
  EXPECT_THAT(filter.at(3990 * kMs).error().text, testing::HasSubstr("opposite"));
}

}  // namespace
}  // namespace adit::perception
