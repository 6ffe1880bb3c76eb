// SPDX-License-Identifier: Apache-2.0
// What counts as a jump of the odometry, and what does not.
#include "robot_agent/motion/motion_bound.hpp"

#include <gtest/gtest.h>

#include "core/time/random.hpp"
#include "robot_agent/motion/frames.hpp"
#include "tests/agent/wheeled.hpp"

namespace adit::agent {
namespace {

/// A driver that sends odometry to a robot, with stamps of its own clock.
class OdometryJump : public testing::Test {
 protected:
  /// One sample `after` the last one, which came `late`; whether it was continuous.
  bool sample(const Pose2& at, Duration after = 20ms, Duration late = 0ms, double z = 0) {
    measured += after;
    const std::uint64_t stamp = stamps ? driver_start + static_cast<std::uint64_t>(measured.count()) : 0;
    return where.update(Pose3::level(at, z), {}, stamp, Time(100s + measured + late));
  }
  /// Drives at `speed` and `turn` for so long, one sample each `period`: the samples that were jumps.
  int drive(double speed, double turn, Duration time, Duration period) {
    int jumps = 0;
    for (Duration t{}; t < time; t += period) {
      const double dt = seconds(period);
      pose = pose * Pose2{speed * dt, 0, turn * dt};
      if (!sample(pose, period)) ++jumps;
    }
    return jumps;
  }

  Frames where{Pose2{10, 20, 0}, wheeled()};
  Pose2 pose{};
  bool stamps{true};
  std::uint64_t driver_start{5'000'000'000'000};
  Duration measured{};
  Time newest{};
};

TEST_F(OdometryJump, DrivingIsNoJump) {
  for (const bool with : {true, false}) {
    stamps = with;
    for (const Duration period : {5ms, 20ms, 100ms, 400ms, 1000ms}) {
      EXPECT_EQ(drive(2.0, 0.0, 10s, period), 0) << seconds(period);
      EXPECT_EQ(drive(0.0, 1.5, 10s, period), 0) << seconds(period);
      EXPECT_EQ(drive(2.0, -1.5, 10s, period), 0) << seconds(period);
    }
  }
  EXPECT_EQ(where.odom_epoch(), 0u);
}

TEST_F(OdometryJump, LostAndLateSamplesAreNoJump) {
  Random random(7);
  for (int i = 0; i < 20'000; ++i) {
    pose = pose * Pose2{0.04, 0, 0.03};
    if (random.chance(0.7)) {
      measured += 20ms;  // Lost, up to seconds of them.
      continue;
    }
    // Late by up to 0.8 s, so that several are handled in the same instant.
    const Duration late = from_seconds(random.uniform(0, 0.8));
    const Time came(100s + measured + 20ms + late);
    measured += 20ms;
    newest = std::max(newest, came);
    EXPECT_TRUE(where.update(Pose3::level(pose, 0), {},
                             driver_start + static_cast<std::uint64_t>(measured.count()), newest))
        << i;
  }
}

TEST_F(OdometryJump, NoiseIsNoJump) {
  Random random(3);
  for (int i = 0; i < 20'000; ++i) {
    pose = pose * Pose2{0.04, 0, 0.01};
    const Pose2 noisy{pose.x + random.uniform(-0.03, 0.03), pose.y + random.uniform(-0.03, 0.03),
                      pose.yaw + random.uniform(-0.05, 0.05)};
    EXPECT_TRUE(sample(noisy, 20ms, 0ms, random.uniform(-0.05, 0.05))) << i;
  }
}

TEST_F(OdometryJump, ADriverThatBeginsAgainAtZeroJumps) {
  ASSERT_EQ(drive(1.0, 0.0, 3s, 20ms), 0);
  const Pose2 before = where.T_map_base();
  EXPECT_FALSE(sample({}));
  EXPECT_EQ(where.odom_epoch(), 1u);
  EXPECT_NEAR(where.T_map_base().x, before.x, 1e-9) << "the guess: it is where it was";
  EXPECT_FALSE(where.T_odom_base_at(driver_start + 2'900'000'000)) << "no pose of the old frame";
  EXPECT_TRUE(sample({0.02, 0, 0})) << "and goes on from there";
  EXPECT_NEAR(where.T_map_base().x, before.x + 0.02, 1e-9);
}

TEST_F(OdometryJump, StampsThatGoBackwardsDoNotHideIt) {
  ASSERT_EQ(drive(1.0, 0.0, 5s, 20ms), 0);
  driver_start = 0;  // Its computer was restarted, too.
  EXPECT_FALSE(sample({}));
}

TEST_F(OdometryJump, StampsThatGoBackwardsAloneAreNoJump) {
  ASSERT_EQ(drive(1.0, 0.0, 5s, 20ms), 0);
  driver_start -= 3'000'000'000;  // Its clock was set.
  EXPECT_TRUE(sample(pose));
}

TEST_F(OdometryJump, ALeapOfTheDriversClockDoesNotHideIt) {
  ASSERT_EQ(drive(1.0, 0.0, 5s, 20ms), 0);
  driver_start += 3'600'000'000'000;
  EXPECT_FALSE(sample({}));
}

TEST_F(OdometryJump, ASilentDriverIsNotGivenTimeForEver) {
  ASSERT_EQ(drive(2.0, 0.0, 5s, 20ms), 0);
  EXPECT_FALSE(sample({}, 60s)) << "10 m back after a minute in which it was sent zero";
}

TEST_F(OdometryJump, ATurnOnTheSpotAndAHeightAreJumpsToo) {
  ASSERT_EQ(drive(0.0, 1.5, 1s, 20ms), 0);
  EXPECT_FALSE(sample({pose.x, pose.y, pose.yaw + 1.0}));
  EXPECT_FALSE(sample({pose.x, pose.y, pose.yaw + 1.0}, 20ms, 0ms, 1.0));
}

TEST_F(OdometryJump, AStepIsClimbedBetweenTwoSamples) {
  EXPECT_TRUE(sample({}, 20ms, 0ms, 0));
  EXPECT_TRUE(sample({}, 20ms, 0ms, wheeled().step));
}

TEST_F(OdometryJump, ThePoseThatIsSetIsInTheMapAlone) {
  ASSERT_EQ(drive(1.0, 0.0, 3s, 20ms), 0);
  const Pose2 odom = where.T_odom_base().planar();
  where.set_pose({-4, 2, 1});
  EXPECT_NEAR(where.T_map_base().x, -4, 1e-9);
  EXPECT_NEAR(where.T_map_base().y, 2, 1e-9);
  EXPECT_NEAR(where.T_map_base().yaw, 1, 1e-9);
  EXPECT_EQ(where.T_odom_base().planar(), odom);
  EXPECT_EQ(where.odom_epoch(), 0u);
}

TEST_F(OdometryJump, ARestartComparesWithTheStoredPlace) {
  ASSERT_EQ(drive(1.0, 0.0, 5s, 20ms), 0);
  const StoredFrames stored = where.stored();
  const auto back_at = [&](const Pose2& odom, Duration later) {
    Frames again(Pose2{}, wheeled());
    again.restore(stored);
    return again.update(Pose3::level(odom, 0), {}, 1, Time(100s + measured + later));
  };
  EXPECT_TRUE(back_at(pose, 500ms));
  EXPECT_TRUE(back_at({pose.x + 1.5, pose.y, pose.yaw}, 1500ms)) << "driven on before it died";
  EXPECT_FALSE(back_at({}, 700ms)) << "5 m";
  EXPECT_FALSE(back_at({pose.x + 20, pose.y, pose.yaw}, 60s)) << "it stood for most of that";
}

}  // namespace
}  // namespace adit::agent
