// SPDX-License-Identifier: Apache-2.0
// Stamps that jump: a clock that is set, or a bad one among good ones.
#include <gtest/gtest.h>

#include "tests/perception/odometry/circling_robot.hpp"

namespace adit::perception {
namespace {

using Robot = CirclingRobot;

struct ClockStep {
  const char* name;
  double jump;  ///< s
  bool of_lidar, of_imu, of_wheels;
  double lasts;  ///< s
};

class ClockSteps : public testing::TestWithParam<ClockStep> {};

TEST_P(ClockSteps, ThePoseIsRightAgainWithinTwoSeconds) {
  const ClockStep& step = GetParam();
  const bool of[3]{step.of_lidar, step.of_imu, step.of_wheels};
  const bool all = step.of_lidar && step.of_imu && step.of_wheels;
  constexpr double kAt = 4.0;
  const auto clock = [&](Robot::Sensor sensor, double t) {
    return of[sensor] && t > kAt + 1e-3 && t < kAt + step.lasts + 1e-3 ? step.jump : 0.0;
  };
  Robot robot;
  robot.drive(kAt);
  ASSERT_EQ(robot.odometry.state().health, Localisation::ok);
  ASSERT_LT(robot.error(), 0.1);
  int blind = 0;
  const auto honest = [&] {
    blind = robot.located ? 0 : blind + 1;
    ASSERT_TRUE(robot.odometry.state().pose.position.allFinite());
    ASSERT_LT(blind, 5) << robot.t;
    ASSERT_NE(robot.odometry.state().health, Localisation::lost) << robot.t;
    if (blind == 0) {
      ASSERT_LT(robot.error(), 5 * robot.odometry.state().sigma() + 0.3) << robot.t;
    }
  };
  if (!all) robot.drive(step.lasts, clock, honest);
  robot.drive(2.0, clock, honest);
  EXPECT_EQ(robot.odometry.state().health, Localisation::ok);
  EXPECT_LT(robot.error(), 0.1);
  EXPECT_LT(robot.odometry.state().sigma(), 0.3);
  if (!all) return;
  // And back again.
  robot.drive(step.lasts, clock, honest);
  EXPECT_EQ(robot.odometry.state().health, Localisation::ok);
  EXPECT_LT(robot.error(), 0.1);
}

constexpr double kHour = 3600, kYears = 50 * 365.25 * 86400;

INSTANTIATE_TEST_SUITE_P(Of, ClockSteps,
                         testing::Values(ClockStep{"AllAnHourOn", kHour, true, true, true, 4},
                                         ClockStep{"AllYearsOn", kYears, true, true, true, 4},
                                         ClockStep{"AllBack", -10, true, true, true, 4},
                                         ClockStep{"OneSweep", kHour, true, false, false, 0.1},
                                         ClockStep{"OneSweepBack", -10, true, false, false, 0.1},
                                         ClockStep{"OneImuSample", kHour, false, true, false, 0.01},
                                         ClockStep{"OneImuSampleBack", -10, false, true, false, 0.01},
                                         ClockStep{"OneWheelSample", kYears, false, false, true, 0.02},
                                         ClockStep{"LidarOn", kHour, true, false, false, 3},
                                         ClockStep{"LidarYearsOn", kYears, true, false, false, 3},
                                         ClockStep{"LidarBack", -10, true, false, false, 13},
                                         ClockStep{"ImuOn", kHour, false, true, false, 3},
                                         ClockStep{"ImuYearsOn", kYears, false, true, false, 3},
                                         ClockStep{"ImuBack", -10, false, true, false, 3},
                                         ClockStep{"WheelsOn", kHour, false, false, true, 3},
                                         ClockStep{"WheelsBack", -10, false, false, true, 3},
                                         ClockStep{"ImuAndWheelsOn", kHour, false, true, true, 3},
                                         ClockStep{"ImuAndWheelsBack", -10, false, true, true, 3}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace adit::perception
