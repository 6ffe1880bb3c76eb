// SPDX-License-Identifier: Apache-2.0
#include "sim/world/body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/world/odometry.hpp"

namespace adit::sim {
namespace {

constexpr double kDt = 0.01;

Platform platform(Drive drive) {
  Platform p;
  p.drive = drive;
  p.max_speed = 2.0;
  p.max_turn = 1.5;
  p.max_acceleration = 1.5;
  p.max_turn_acceleration = 3.0;
  return p;
}

void run(Body& body, const Twist2& wanted, double time) {
  for (int n = 0; n < std::lround(time / kDt); ++n) {
    body.command(wanted);
    body.take(body.advance(kDt));
  }
}

TEST(Body, reaches_a_speed_at_its_acceleration) {
  Body body(platform(Drive::differential), {}, 0.5);
  run(body, {1.5, 0, 0}, 0.5);
  EXPECT_NEAR(body.twist().vx, 0.75, 1e-9);
  run(body, {1.5, 0, 0}, 0.6);
  EXPECT_EQ(body.twist().vx, 1.5);
  run(body, {0, 0, 0}, 1.01);
  EXPECT_EQ(body.twist().vx, 0.0) << "no remainder creeps";
}

TEST(Body, keeps_the_limits_of_its_platform) {
  Body body(platform(Drive::differential), {}, 0.5);
  run(body, {9, 9, 9}, 5.0);
  EXPECT_EQ(body.twist().vx, 2.0);
  EXPECT_EQ(body.twist().vy, 0.0) << "wheels do not slide sideways";
  EXPECT_EQ(body.twist().wz, 1.5);
  Body legs(platform(Drive::holonomic), {}, 0.5);
  run(legs, {9, 9, 0}, 5.0);
  EXPECT_NEAR(std::hypot(legs.twist().vx, legs.twist().vy), 2.0, 1e-9);
  EXPECT_NEAR(legs.pose().x, legs.pose().y, 1e-9);
}

TEST(Body, tracks_swallow_a_part_of_each_turn) {
  Platform p = platform(Drive::tracked);
  p.turn_slip = 0.2;
  Body body(p, {}, 0.5);
  run(body, {1, 0.5, 1}, 1.0);
  const double yaw = body.pose().yaw;
  run(body, {1, 0.5, 1}, 1.0);
  EXPECT_NEAR(body.pose().yaw - yaw, 0.8, 1e-9);
  EXPECT_NEAR(body.twist().wz, 0.8, 1e-9);
  EXPECT_EQ(body.twist().vx, 1.0);
  EXPECT_EQ(body.twist().vy, 0.0) << "not sideways";
}

TEST(Body, a_car_turns_about_its_rear_axle_and_steers_at_its_rate) {
  Platform p = platform(Drive::car);
  p.wheelbase = 0.6;
  p.max_steering = 0.5;
  p.steering_rate = 1.0;
  Body body(p, {}, 0.5);
  run(body, {0, 0, 1}, 1.0);
  EXPECT_EQ(body.pose(), Pose2{}) << "no turn on the spot";
  run(body, {0.5, 0.3, 0.1}, 0.1);
  EXPECT_LT(body.twist().wz, 0.5 * std::tan(0.11) / 0.6) << "wheels are not steered at once";
  run(body, {0.5, 0, 9}, 2.0);
  const double radius = p.least_radius();
  EXPECT_NEAR(body.twist().vx / body.twist().wz, radius, 1e-9);
  EXPECT_NEAR(body.twist().vy, 0.3 * body.twist().wz, 1e-9) << "base_link is between the axles";
  const Pose2 middle = body.pose() * Pose2{-0.3, radius, 0};
  run(body, {0.5, 0, 9}, 2.0);
  const Pose2 same = body.pose() * Pose2{-0.3, radius, 0};
  EXPECT_NEAR((same.position() - middle.position()).norm(), 0.0, 1e-3) << "one circle";
  run(body, {-0.5, 0, -0.5 / radius}, 2.0);
  EXPECT_NEAR(body.twist().wz, -0.5 / radius, 1e-9) << "backwards on the same circle";
}

TEST(Body, what_flies_keeps_its_height_above_the_ground) {
  Platform p = platform(Drive::aerial);
  p.hover_height = 1.0;
  p.max_climb = 0.5;
  Body body(p, {}, 0.5);
  double z = 1.0;
  const auto fly = [&](double up, double ground, double ceiling, double time) {
    for (int n = 0; n < std::lround(time / kDt); ++n) {
      body.command({0, 0, 0, up});
      body.take(body.advance(kDt));
      const double before = z;
      z = body.climb(z, ground, ceiling, kDt);
      EXPECT_LE(std::abs(z - before), 0.5 * kDt + 1e-12);
    }
  };
  fly(0, 0, 9, 1);
  EXPECT_EQ(z, 1.0);
  fly(0, 0.4, 9, 2);
  EXPECT_NEAR(z, 1.4, 1e-9) << "the ground rose";
  fly(2, 0.4, 9, 2);
  EXPECT_NEAR(z, 2.4, 1e-9) << "no faster than it climbs";
  fly(0.5, 0.4, 3.0, 5);
  EXPECT_NEAR(z, 3.0 - p.height - 0.2, 1e-9) << "away from the ceiling";
  fly(-0.5, 0.4, 9, 10);
  EXPECT_NEAR(z, 0.4 + 0.3, 1e-9) << "and from the ground";
}

TEST(Body, stops_when_nothing_is_commanded) {
  Body body(platform(Drive::differential), {}, 0.5);
  run(body, {1, 0, 0}, 2.0);
  for (int n = 0; n < 48; ++n) body.take(body.advance(kDt));
  EXPECT_EQ(body.twist().vx, 1.0) << "just before 0.5 s of silence";
  for (int n = 0; n < 120; ++n) body.take(body.advance(kDt));
  EXPECT_EQ(body.twist().vx, 0.0);
}

TEST(Body, what_is_not_a_number_is_zero) {
  Body body(platform(Drive::holonomic), {}, 0.5);
  run(body, {std::nan(""), std::numeric_limits<double>::infinity(), -std::nan("")}, 1.0);
  EXPECT_EQ(body.pose(), Pose2{});
}

TEST(Body, drives_a_circle) {
  Body body(platform(Drive::differential), {}, 0.5);
  run(body, {1, 0, 1}, 2.0);
  const Pose2 before = body.pose();
  run(body, {1, 0, 1}, 2 * M_PI);
  EXPECT_NEAR((body.pose().position() - before.position()).norm(), 0.0, 0.01);
}

/// Error along the way, error sideways and of the heading after a straight drive.
Pose2 error_after(double way, std::uint64_t seed, const OdometryParams& params) {
  Odometry odometry(params, seed);
  const int steps = static_cast<int>(way / 0.01);
  for (int n = 0; n < steps; ++n) odometry.move({3 + n * 0.01, 4, 0}, {3 + (n + 1) * 0.01, 4, 0}, kDt);
  return {odometry.pose().x - way, odometry.pose().y, odometry.pose().yaw};
}

TEST(Odometry, errs_by_the_given_amount) {
  double along = 0, heading_1 = 0, heading_20 = 0;
  constexpr int runs = 400;
  for (int n = 0; n < runs; ++n) {
    along += std::pow(error_after(10, n, {}).x, 2) / runs;
    heading_1 += std::pow(error_after(1, n, {}).yaw, 2) / runs;
    heading_20 += std::pow(error_after(20, n, {}).yaw, 2) / runs;
  }
  constexpr double degree = M_PI / 180;
  EXPECT_NEAR(std::sqrt(along), 0.10, 0.02) << "1 % of 10 m";
  EXPECT_NEAR(std::sqrt(heading_1), 0.2 * degree, 0.05 * degree) << "0.2 degrees in a metre";
  EXPECT_NEAR(std::sqrt(heading_20), 1.25 * degree, 0.25 * degree) << "a random walk over 20 m";
}

TEST(Odometry, without_noise_it_is_the_truth) {
  const Pose2 e = error_after(20, 1, {0, 0, 1});
  EXPECT_NEAR(e.x, 0, 1e-9);
  EXPECT_NEAR(e.y, 0, 1e-9);
  Odometry odometry({0, 0, 1}, 1);
  const Pose2 start{1, 2, 0.5}, end = start * Pose2{0.1, 0, 0.02};
  odometry.move(start, end, 0.1);
  EXPECT_NEAR(odometry.pose().x, 0.1, 1e-12) << "odom begins at the start pose";
  EXPECT_NEAR(odometry.twist().vx, 1.0, 1e-9);
  EXPECT_NEAR(odometry.twist().wz, 0.2, 1e-9);
}

TEST(Odometry, misjudges_turns_where_it_skids) {
  double off = 0;
  constexpr int runs = 200;
  for (int n = 0; n < runs; ++n) {
    Odometry odometry({.turn = 0.05}, n);
    for (int i = 0; i < 100; ++i) odometry.move({1, 1, 0.01 * i}, {1, 1, 0.01 * (i + 1)}, kDt);
    off += std::pow(odometry.pose().yaw - 1.0, 2) / runs;
  }
  EXPECT_NEAR(std::sqrt(off), 0.05, 0.01);
}

TEST(Odometry, same_seed_same_error) {
  EXPECT_EQ(error_after(5, 3, {}), error_after(5, 3, {}));
  EXPECT_NE(error_after(5, 3, {}), error_after(5, 4, {}));
}

TEST(Odometry, standing_and_turning_gain_no_error) {
  Odometry odometry({}, 3);
  for (int n = 0; n < 1000; ++n) odometry.move({1, 1, 0.01 * n}, {1, 1, 0.01 * (n + 1)}, kDt);
  EXPECT_NEAR(odometry.pose().yaw, wrap_angle(10.0), 1e-9);
  EXPECT_NEAR(odometry.pose().x, 0.0, 1e-9);
}

}  // namespace
}  // namespace adit::sim
