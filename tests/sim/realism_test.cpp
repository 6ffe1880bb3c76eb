// SPDX-License-Identifier: Apache-2.0
// Bodies that tilt, inertial sensors and sweeps: what `SimulationParams::realistic` adds.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "sim/world/simulation.hpp"
#include "tests/sim/wheeled.hpp"

namespace adit::sim {
namespace {

constexpr double kSlope = 0.14;  // rise per run of the ramp

/// A ramp that rises from x = 1 in the direction of x.
std::shared_ptr<const World> ramp() {
  static const auto world = [] {
    std::vector<Box> boxes;
    constexpr double kStep = 0.05;
    for (int n = 0; n < 100; ++n)
      boxes.push_back({1 + n * kStep, 1 + (n + 1) * kStep, -2, 3, 0, kSlope * (n + 0.5) * kStep});
    return std::make_shared<const World>(*make_box_world(boxes, 0, 4));
  }();
  return world;
}

std::shared_ptr<const World> large_hall() {
  static const auto world = [] {
    const std::array<Box, 2> boxes{Box{8, 8.5, -8, 8, 0, 3}, Box{-8, 8, 6, 6.5, 0, 3}};
    return std::make_shared<const World>(*make_box_world(boxes, 0, 3));
  }();
  return world;
}

Simulation make(std::shared_ptr<const World> world, std::vector<RobotStart> robots, double noise,
                std::uint64_t seed = 1, ImuParams imu = {}) {
  SimulationParams params;
  params.seed = seed;
  params.realistic = true;
  params.noise = noise;
  params.imu = imu;
  params.odometry = OdometryParams::realistic().scaled(noise);
  auto simulation = Simulation::create(std::move(world), std::move(robots), params);
  EXPECT_TRUE(simulation) << simulation.error().text;
  return std::move(simulation).value();
}

struct Peak {
  double roll{}, pitch{};
};

Attitude tilt_of(const Pose3& pose) {
  const Eigen::Matrix3d r = pose.orientation.toRotationMatrix();
  return {pose.position.z(), std::atan2(r(2, 1), r(2, 2)), -std::asin(r(2, 0))};
}

/// Drives, and gives the largest tilt on the way.
Peak drive(Simulation& simulation, const Twist2& wanted, double time) {
  Peak peak;
  for (int n = 0; n < std::lround(time / 0.01); ++n) {
    simulation.command(0, wanted);
    simulation.step();
    const Attitude tilt = tilt_of(simulation.truth(0).pose);
    peak.roll = std::max(peak.roll, std::abs(tilt.roll));
    peak.pitch = std::max(peak.pitch, std::abs(tilt.pitch));
  }
  return peak;
}

TEST(Realism, BodyOnARampLeansAsTheRampDoes) {
  Simulation s = make(ramp(), {{"r1", wheeled(), {0, 0, 0}}}, 0.0);
  drive(s, {0.8, 0, 0}, 6.0);
  const Attitude up = tilt_of(s.truth(0).pose);
  EXPECT_NEAR(up.pitch, -std::atan(kSlope), 0.02) << "nose up";
  EXPECT_NEAR(up.roll, 0.0, 0.01);
  EXPECT_NEAR(up.z, kSlope * (s.truth(0).pose.position.x() - 1.0), 0.03);

  Simulation across = make(ramp(), {{"r1", wheeled(), {4, 0, M_PI / 2}}}, 0.0);
  drive(across, {}, 1.0);
  const Attitude side = tilt_of(across.truth(0).pose);
  EXPECT_NEAR(side.roll, -std::atan(kSlope), 0.02) << "the right side is up";
  EXPECT_NEAR(across.truth(0).pose.yaw(), M_PI / 2, 1e-9);
}

TEST(Realism, BodyPitchesOverAStepAndWhileItBrakes) {
  const std::array<Box, 1> step{Box{2, 9, -2, 2, 0, 0.07}};
  Simulation s =
      make(std::make_shared<const World>(*make_box_world(step, 0, 3)), {{"r1", wheeled(), {0, 0, 0}}}, 0.0);
  drive(s, {0.5, 0, 0}, 1.0);
  const Peak over = drive(s, {0.5, 0, 0}, 5.0);
  EXPECT_GT(over.pitch, 0.06) << "one axle up, 0.07 m on 0.48 m of wheelbase";
  EXPECT_LT(over.pitch, 0.25);
  EXPECT_NEAR(s.truth(0).pose.position.z(), 0.07, 0.005);

  Simulation flat = make(large_hall(), {{"r1", wheeled(), {0, 0, 0}}}, 0.0);
  const Peak start = drive(flat, {2, 0, 0}, 2.0);
  drive(flat, {2, 0, 0}, 0.5);
  const Peak brake = drive(flat, {}, 1.3);
  for (const Peak& peak : {start, brake}) {
    EXPECT_GT(peak.pitch, 2.0 * kDegree);
    EXPECT_LT(peak.pitch, 6.0 * kDegree);
  }
  drive(flat, {}, 3.0);
  EXPECT_NEAR(tilt_of(flat.truth(0).pose).pitch, 0.0, 1e-3) << "at rest";
}

TEST(Realism, LeggedBodySwaysWhileItWalksAndFlyingOneLeansIntoItsAcceleration) {
  Platform legged = wheeled();
  legged.drive = Drive::holonomic;
  Simulation walk = make(large_hall(), {{"r1", legged, {0, 0, 0}}}, 0.0);
  drive(walk, {0.8, 0, 0}, 2.0);
  const Peak gait = drive(walk, {0.8, 0, 0}, 2.0);
  EXPECT_NEAR(gait.roll, 1.5 * kDegree, 0.2 * kDegree);
  EXPECT_NEAR(gait.pitch, 1.5 * kDegree, 0.2 * kDegree);
  drive(walk, {}, 4.0);
  EXPECT_NEAR(tilt_of(walk.truth(0).pose).roll, 0.0, 1e-3) << "it stands";

  Platform flyer = wheeled();
  flyer.drive = Drive::aerial;
  flyer.height = 0.3;
  flyer.hover_height = 1.0;
  Simulation fly = make(large_hall(), {{"r1", flyer, {0, 0, 0}}}, 0.0);
  drive(fly, {2, 0, 0}, 0.8);
  EXPECT_NEAR(tilt_of(fly.truth(0).pose).pitch, std::atan(1.5 / 9.81), 0.02) << "nose down";
  EXPECT_NEAR(fly.truth(0).pose.position.z(), 1.0, 1e-6);
}

TEST(Realism, WithoutNoiseOdometryIsTheTruth) {
  Simulation s = make(ramp(), {{"r1", wheeled(), {0, 0, 0}}}, 0.0);
  drive(s, {0.8, 0, 0.1}, 5.0);
  const Pose3& truth = s.truth(0).pose;
  EXPECT_NEAR(s.odometry(0).pose().x, truth.position.x(), 1e-9);
  EXPECT_NEAR(s.odometry(0).pose().yaw, truth.yaw(), 1e-9);
  EXPECT_NEAR(s.altitude(0), truth.position.z(), 1e-9);
  EXPECT_LT(s.odometry(0).orientation().angularDistance(truth.orientation), 1e-9);
}

TEST(Realism, OdometryDriftsWithinTheDeviationThatItStates) {
  Eigen::Vector4d square =
      Eigen::Vector4d::Zero();  // of the errors in deviations: position, height, roll, yaw
  constexpr int kRuns = 16;
  double height = 0.0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    Simulation s = make(large_hall(), {{"r1", wheeled(), {0, 0, 0}}}, 1.0, seed);
    drive(s, {0.8, 0, 0.5}, 40.0);
    const Pose3& truth = s.truth(0).pose;
    const Odometry& odom = s.odometry(0);
    const OdometrySigma sigma = odom.sigma();
    const double position = (odom.pose().position() - truth.position.head<2>()).norm() / sigma.position;
    const double z = s.altitude(0) - truth.position.z();
    const Eigen::Quaterniond tilt = truth.orientation.conjugate() * odom.orientation();
    square += Eigen::Vector4d(position, z / sigma.height, 2.0 * tilt.x() / sigma.tilt,
                              wrap_angle(odom.pose().yaw - truth.yaw()) / sigma.yaw)
                  .cwiseAbs2();
    height += z * z;
  }
  const Eigen::Vector4d rms = (square / kRuns).cwiseSqrt();
  EXPECT_LT(rms.maxCoeff(), 1.6) << rms.transpose();
  EXPECT_GT(rms.tail<3>().minCoeff(), 0.3) << rms.transpose();
  EXPECT_GT(std::sqrt(height / kRuns), 0.02) << "the height drifts, m in 32 m";
}

TEST(Imu, AtRestItReadsGravityUpwards) {
  Simulation s = make(large_hall(), {{"r1", wheeled(), {0, 0, 0}}}, 0.0);
  drive(s, {}, 1.0);
  const auto samples = s.take_imu(0);
  ASSERT_NEAR(samples.size(), 98, 2);
  for (const ImuSample& sample : samples) {
    EXPECT_LT((sample.accel - Eigen::Vector3d(0, 0, 9.81)).norm(), 1e-6);
    EXPECT_LT(sample.gyro.norm(), 1e-9);
  }
  EXPECT_EQ(samples[1].at - samples[0].at, 10ms);
  EXPECT_TRUE(s.take_imu(0).empty());
}

TEST(Imu, RotatingBodyShowsTheLeverArmAndTheRate) {
  RobotStart start{"r1", wheeled(), {0, 0, 0}};
  start.platform.imu.emplace();
  start.platform.imu->mounting = {.x = 0.2, .z = 0.2};
  Simulation s = make(large_hall(), {start}, 0.0);
  drive(s, {0, 0, 1.5}, 3.0);
  const ImuSample last = s.take_imu(0).back();
  EXPECT_NEAR(last.gyro.z(), 1.5, 1e-3);
  EXPECT_NEAR(last.accel.x(), -1.5 * 1.5 * 0.2, 0.01) << "towards the axis";
  EXPECT_NEAR(last.accel.y(), 0.0, 0.01);
}

TEST(Imu, FastSensorsGiveTheirRateAndFaultsOfTheMountShow) {
  ImuParams params;
  params.rate = 400.0;
  params.in_g = true;
  params.upside_down = true;
  Simulation s = make(large_hall(), {{"r1", wheeled(), {0, 0, 0}}}, 0.0, 1, params);
  drive(s, {}, 0.5);
  const auto samples = s.take_imu(0);
  EXPECT_NEAR(samples.size(), 193, 4);
  EXPECT_NEAR(samples.back().accel.z(), -1.0, 1e-6) << "g, and upside down";
}

TEST(Imu, ErrorsAreThoseOfItsSeed) {
  const auto mean = [](std::uint64_t seed) {
    Simulation s = make(large_hall(), {{"r1", wheeled(), {0, 0, 0}}}, 1.0, seed);
    drive(s, {}, 3.0);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const auto samples = s.take_imu(0);
    for (const ImuSample& sample : samples) sum += sample.accel;
    return Eigen::Vector3d(sum / static_cast<double>(samples.size()) - Eigen::Vector3d(0, 0, 9.81));
  };
  EXPECT_EQ(mean(1), mean(1));
  EXPECT_NE(mean(1), mean(2));
  EXPECT_GT(mean(1).norm(), 0.02);
  EXPECT_LT(mean(1).norm(), 0.3);
}

/// Mean distance of the points on the wall x = 8 from it, placed by the lidar's poses at their own times, m.
double mean_error(const SweepJob& job) {
  double sum = 0.0;
  int count = 0;
  const std::size_t intervals = job.T_world_lidar.size() - 1;
  for (const SweepPoint& p : job.trace()) {
    const double at = p.t / job.duration * static_cast<double>(intervals);
    const auto n = std::min<std::size_t>(static_cast<std::size_t>(at), intervals - 1);
    const double part = at - static_cast<double>(n);
    const Pose3 from = job.T_world_lidar[n], to = job.T_world_lidar[n + 1];
    const Pose3 pose{from.position + part * (to.position - from.position),
                     from.orientation.slerp(part, to.orientation)};
    const Eigen::Vector3d world = pose * p.position().cast<double>();
    if (std::abs(world.y()) > 3.0 || world.z() < 0.4 || world.z() > 2.0 || world.x() < 6.0) continue;
    sum += std::abs(world.x() - 8.0);
    ++count;
  }
  EXPECT_GT(count, 500);
  return sum / count;
}

TEST(Sweep, EachColumnIsTracedFromThePoseAtItsOwnTime) {
  Simulation s = make(large_hall(), {{"r1", wheeled(), {2, 0, 0}}}, 0.0);
  drive(s, {1.0, 0, 1.5}, 1.2);
  const SweepJob job = s.sweep(0);
  EXPECT_EQ(job.T_world_lidar.size(), 11u);
  const double yaw = wrap_angle(job.T_world_lidar.back().yaw() - job.T_world_lidar.front().yaw());
  EXPECT_NEAR(yaw, 0.15, 1e-3);
  EXPECT_LT(mean_error(job), 1e-4) << "deskewed by the true poses the wall is straight";
  SweepJob still = job;
  std::fill(still.T_world_lidar.begin(), still.T_world_lidar.end(), job.T_world_lidar.back());
  const auto skewed = job.trace(), instant = still.trace();
  EXPECT_NE(skewed.front().position(), instant.front().position());
  float last = 0.0f;
  for (const SweepPoint& p : skewed) {
    EXPECT_GE(p.t, last) << "in the order of time";
    last = p.t;
    EXPECT_LT(p.ring, 16);
    // The sweep begins behind and turns counter-clockwise: the direction gives the time.
    const double turned = std::atan2(p.y, p.x) + M_PI;
    const double apart = std::remainder(p.t - turned / (2 * M_PI) * 0.1, 0.1);
    ASSERT_NEAR(apart, 0.0, 1e-4);
  }
  EXPECT_GT(last, 0.099f);
  EXPECT_LT(last, 0.1f);
}

TEST(Sweep, LinesOfARosetteAreNoElevationsAndNoSweepIsLikeTheOneBefore) {
  Platform platform = wheeled();
  LidarConfig lidar = platform.lidar();
  lidar.rosette = true;
  platform.lidars = {lidar};
  Simulation s = make(large_hall(), {{"r1", platform, {0, 0, 0}}}, 0.0);
  drive(s, {}, 0.3);
  const auto elevation = [](const SweepPoint& p) { return std::atan2(p.z, std::hypot(p.x, p.y)); };
  const auto first = s.sweep(0).trace();
  std::array<float, 4> low{}, high{};
  for (const SweepPoint& p : first) {
    ASSERT_LT(p.ring, 4);
    low[p.ring] = std::min(low[p.ring], elevation(p));
    high[p.ring] = std::max(high[p.ring], elevation(p));
  }
  for (std::size_t line = 0; line < 4; ++line) EXPECT_GT(high[line] - low[line], 0.4F) << "rad";
  drive(s, {}, 0.1);
  const auto second = s.sweep(0).trace();
  std::size_t same = 0;
  for (std::size_t n = 0; n < std::min(first.size(), second.size()); ++n)
    same += std::abs(elevation(first[n]) - elevation(second[n])) < 1e-5F;
  EXPECT_LT(same, first.size() / 20);
}

TEST(Sweep, MountErrorAndNoiseAreReproducibleAndBounded) {
  const auto mount = [](double noise, std::uint64_t seed) {
    Simulation s = make(large_hall(), {{"r1", wheeled(), {0, 0, 0}}}, noise, seed);
    return s.truth(0).pose.inverse() * s.sweep(0).T_world_lidar.back();
  };
  const Pose3 nominal = wheeled().lidar().mounting.pose();
  EXPECT_LT((mount(0.0, 1).position - nominal.position).norm(), 1e-12);
  double most = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Pose3 pose = mount(1.0, seed);
    EXPECT_EQ(pose.position, mount(1.0, seed).position);
    const double off = (pose.position - nominal.position).norm();
    most = std::max(most, off);
    EXPECT_LE(off, 0.01);
    EXPECT_LE(pose.orientation.angularDistance(nominal.orientation), 0.3001 * kDegree);
  }
  EXPECT_GT(most, 0.004);
}

TEST(Sweep, FarAndGrazingSurfacesAreNoisierAndSomeBeamsGetLost) {
  Simulation s = make(large_hall(), {{"r1", wheeled(), {0, 0, 0}}}, 1.0);
  drive(s, {}, 0.3);
  SweepJob noisy = s.sweep(0), exact = noisy;
  exact.errors.noise = 0.0;
  noisy.errors.bias = 0.0;
  const auto truth = exact.trace(), measured = noisy.trace();
  EXPECT_LT(measured.size(), truth.size());
  EXPECT_GT(measured.size(), truth.size() * 9 / 10);
  double near_square = 0.0, far_square = 0.0;
  int near_count = 0, far_count = 0;
  std::size_t n = 0;
  for (const SweepPoint& p : measured) {
    while (n < truth.size() && (truth[n].t != p.t || truth[n].ring != p.ring)) ++n;
    if (n == truth.size()) break;
    const double range = truth[n].position().norm(), error = p.position().norm() - range;
    if (std::abs(error) > 0.25) continue;  // a mixed return
    const bool wall = std::abs(truth[n].y) < 3.0f && truth[n].x > 0.0f && truth[n].z > -0.3f;
    if (wall && range < 9.0) near_square += error * error, ++near_count;
    if (range > 12.0) far_square += error * error, ++far_count;
  }
  ASSERT_GT(near_count, 200);
  ASSERT_GT(far_count, 100);
  EXPECT_NEAR(std::sqrt(near_square / near_count), 0.025, 0.006);
  EXPECT_GT(std::sqrt(far_square / far_count), 0.03);
  EXPECT_LT(std::sqrt(far_square / far_count), 0.055);
}

}  // namespace
}  // namespace adit::sim
