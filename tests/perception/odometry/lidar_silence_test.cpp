// SPDX-License-Identifier: Apache-2.0
// A lidar that is silent, or sends no stamps, while the body drives on.
#include <gtest/gtest.h>

#include "tests/perception/odometry/circling_robot.hpp"

namespace adit::perception {
namespace {

TEST(LidarSilence, ThePoseIsFoundFromWhereSkiddingWheelsBroughtIt) {
  LidarOdometryParams params = CirclingRobot::params();
  params.motion.has_imu = false;
  CirclingRobot robot(params);
  robot.drive(5.0);
  ASSERT_LT(robot.error(), 0.1);
  // For three seconds the wheels slide sideways, too: at the end they are 0.5 m and 0.2 rad off.
  constexpr double kSilence = 3.0;
  Pose3 slid;
  const double begin = robot.t;
  while (robot.t < begin + kSilence) {
    robot.t = 0.01 * ++robot.ticks;
    const double part = (robot.t - begin) / kSilence;
    slid = Pose3::level({0.0, 0.5 * part, 0.2 * part}, 0);
    if (robot.ticks % 2 == 0)
      robot.odometry.add(BodyMotion{robot.stamp(CirclingRobot::wheels, {}), robot.truth() * slid});
  }
  for (int sweep = 0; sweep < 20; ++sweep) {
    for (int n = 0; n < 5; ++n) {
      robot.t = 0.01 * (robot.ticks += 2);
      robot.odometry.add(BodyMotion{robot.stamp(CirclingRobot::wheels, {}), robot.truth() * slid});
    }
    ASSERT_TRUE(robot.odometry.advance(robot.stamp(CirclingRobot::lidar, {})));
    robot.odometry.update(robot.cloud());
    EXPECT_LT(robot.error(), 5 * robot.odometry.state().sigma() + 0.1) << sweep;
  }
  EXPECT_EQ(robot.odometry.state().health, Localisation::ok);
  EXPECT_LT(robot.error(), 0.1);
}

}  // namespace
}  // namespace adit::perception
