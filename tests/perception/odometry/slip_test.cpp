// SPDX-License-Identifier: Apache-2.0
// Wheels that turn while the body does not.
#include <gtest/gtest.h>

#include "tests/perception/odometry/circling_robot.hpp"

namespace adit::perception {
namespace {

/// A robot that stands in the room of CirclingRobot while its wheels turn at `speed`, m/s.
struct StuckRobot {
  explicit StuckRobot(bool has_imu)
      : robot([&] {
          LidarOdometryParams params = CirclingRobot::params();
          params.motion.has_imu = has_imu;
          return params;
        }()) {}

  void stand(double seconds, double speed) {
    for (int n = 0; n < static_cast<int>(std::lround(seconds * 10)); ++n) {
      for (int k = 0; k < 10; ++k) {
        stamp += 10'000'000;
        rolled += 0.01 * speed;
        robot.odometry.add(ImuSample{stamp, {0, 0, 0}, {0, 0, kStandardGravity}});
        Pose3 pose = robot.truth();
        pose.position.x() += rolled;
        if (k % 2 == 1) robot.odometry.add(BodyMotion{stamp, pose});
      }
      if (robot.odometry.advance(stamp)) robot.odometry.update(robot.cloud());
      const OdometryState& state = robot.odometry.state();
      if (state.stamp == 0) continue;
      worst = std::max(worst, robot.error());
      fastest = std::max(fastest, state.velocity.norm());
      slip_sweeps += state.wheels_slip;
      honest = honest && robot.error() <= 5 * state.sigma() + 0.02;
    }
  }

  CirclingRobot robot;
  std::uint64_t stamp{CirclingRobot::kBegin};
  double rolled{};  ///< By the wheels, m.
  double worst{}, fastest{};
  int slip_sweeps{};
  bool honest{true};
};

TEST(WheelsSlip, TheLidarSeesItWithoutAnImu) {
  for (const double speed : {0.3, 1.0}) {
    StuckRobot stuck(false);
    stuck.stand(2, 0);
    EXPECT_EQ(stuck.slip_sweeps, 0);
    stuck.stand(10, speed);
    EXPECT_GT(stuck.slip_sweeps, 90);
    EXPECT_LT(stuck.worst, 0.05 + 0.1 * speed);  // What a single sweep may be off by.
    EXPECT_LT(stuck.robot.error(), 0.02);
    EXPECT_TRUE(stuck.honest);
    EXPECT_NE(stuck.robot.odometry.state().health, Localisation::lost);
    stuck.stand(1.5, 0);
    EXPECT_FALSE(stuck.robot.odometry.state().wheels_slip);
    EXPECT_EQ(stuck.robot.odometry.state().health, Localisation::ok);
  }
}

TEST(WheelsSlip, TheVelocityIsNotKickedWhereTheLidarIsGood) {
  StuckRobot stuck(true);
  stuck.stand(2, 0);
  stuck.stand(10, 0.5);
  EXPECT_GT(stuck.slip_sweeps, 90);
  EXPECT_LT(stuck.fastest, 0.05);
  EXPECT_LT(stuck.worst, 0.03);
  stuck.stand(1.5, 0);
  EXPECT_FALSE(stuck.robot.odometry.state().wheels_slip);
}

TEST(WheelsSlip, WheelsThatHoldDoNotSlip) {
  for (const bool imu : {true, false}) {
    CirclingRobot robot([&] {
      LidarOdometryParams params = CirclingRobot::params();
      params.motion.has_imu = imu;
      return params;
    }());
    int slips = 0;
    robot.drive(8, {}, [&] { slips += robot.odometry.state().wheels_slip; });
    EXPECT_EQ(slips, 0);
    EXPECT_LT(robot.error(), 0.05);
  }
}

}  // namespace
}  // namespace adit::perception
