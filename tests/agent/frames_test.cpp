// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/frames.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/agent/wheeled.hpp"

namespace adit::agent {
namespace {

constexpr std::uint64_t kSecond = 1'000'000'000;

/// A body that drives along x at 1 m/s, sampled at 10 Hz: at stamp 100 s + t it is at x = t.
class FramesTest : public testing::Test {
 protected:
  bool sample(double t, std::uint64_t stamp) {
    now += 100ms;
    return frames.update(Pose3::level({t, 0, 0}, 0), {1, 0, 0}, stamp, now);
  }
  bool sample(double t) { return sample(t, stamp_of(t)); }
  void drive(double from, double to) {
    for (double t = from; t < to + 1e-6; t += 0.1) ASSERT_TRUE(sample(t)) << t;
  }
  static std::uint64_t stamp_of(double t) {
    return 100 * kSecond + static_cast<std::uint64_t>(std::llround(t * 1e9));
  }
  double x_at(double t) const {
    const auto pose = frames.T_odom_base_at(stamp_of(t));
    return pose ? pose->position.x() : std::nan("");
  }
  /// Corrects to `T_map_odom`, computed from that place.
  Reason correct(const Pose2& T_map_odom, MapFrame computed_from) {
    computed_from.T_map_odom = Pose3::level(T_map_odom, 0);
    return frames.correct(computed_from).reason();
  }
  Reason correct(const Pose2& T_map_odom) { return correct(T_map_odom, frames.map_frame()); }

  Frames frames{Pose2{10, 20, 0}, wheeled(), 3.0};
  Time now{1h};
};

TEST_F(FramesTest, PosesBetweenTwoSamplesAreInterpolated) {
  drive(0, 2);
  EXPECT_NEAR(x_at(1.0), 1.0, 1e-9);
  EXPECT_NEAR(x_at(1.03), 1.03, 1e-9);
  EXPECT_NEAR(x_at(1.97), 1.97, 1e-9);
  const auto then = frames.T_odom_base_at(stamp_of(1.03));
  ASSERT_TRUE(then);
  const Eigen::Vector3d in_map = frames.to_map(then->position);
  EXPECT_NEAR((in_map - Eigen::Vector3d(11.03, 20, 3)).norm(), 0, 1e-9);
}

TEST_F(FramesTest, StampsOutsideOfTheHistoryAreErrors) {
  EXPECT_EQ(frames.T_odom_base_at(stamp_of(0)).reason(), Reason::out_of_range) << "none yet";
  drive(0, 1);
  EXPECT_EQ(frames.T_odom_base_at(stamp_of(-0.01)).reason(), Reason::out_of_range);
  EXPECT_EQ(frames.T_odom_base_at(stamp_of(1.01)).reason(), Reason::out_of_range);
  EXPECT_EQ(frames.T_odom_base_at(0).reason(), Reason::out_of_range);
  ASSERT_TRUE(sample(1.9));
  EXPECT_TRUE(std::isnan(x_at(1.5))) << "nobody knows where it was in a gap of 0.9 s";
}

TEST_F(FramesTest, OvertakenSamplesEnterOnlyTheHistory) {
  drive(0, 1);
  ASSERT_TRUE(sample(1.3));
  EXPECT_NEAR(x_at(1.2), 1.2, 1e-9);
  now += 20ms;
  ASSERT_TRUE(frames.update(Pose3::level({1.2, 0.1, 0}, 0), {0.5, 0, 0}, stamp_of(1.2), now));
  EXPECT_EQ(frames.T_odom_base().position.x(), 1.3) << "the newest one counts";
  EXPECT_EQ(frames.twist().vx, 1.0);
  EXPECT_NEAR(frames.T_odom_base_at(stamp_of(1.2))->position.y(), 0.1, 1e-9);
  EXPECT_NEAR(frames.T_odom_base_at(stamp_of(1.25))->position.y(), 0.05, 1e-9);
  EXPECT_EQ(frames.odom_epoch(), 0u);
  EXPECT_TRUE(frames.alive(now));
}

TEST_F(FramesTest, ADriversClockThatIsSetBackDoesNotHoldThePose) {
  drive(0, 1);
  for (int i = 1; i <= 5; ++i) ASSERT_TRUE(sample(1 + 0.1 * i, stamp_of(0.6 + 0.05 * i)));
  EXPECT_NEAR(frames.T_odom_base().position.x(), 1.5, 1e-9);
  ASSERT_TRUE(sample(1.6, stamp_of(-1000)));
  EXPECT_NEAR(frames.T_odom_base().position.x(), 1.6, 1e-9);
  EXPECT_TRUE(std::isnan(x_at(1.0))) << "stamps of the clock as it was mean nothing now";
  EXPECT_NEAR(x_at(-1000), 1.6, 1e-9);
}

TEST_F(FramesTest, ACorrectionMovesTheMapAlone) {
  drive(0, 2);
  const auto epoch = frames.map_epoch();
  ASSERT_EQ(correct({10, 20.5, 0.1}), Reason::none);
  EXPECT_NEAR(frames.T_odom_base().position.x(), 2.0, 1e-9);
  EXPECT_EQ(frames.odom_epoch(), 0u);
  EXPECT_EQ(frames.map_epoch(), epoch + 1);
  EXPECT_NEAR(frames.T_map_base().x, 10 + 2 * std::cos(0.1), 1e-9);
  EXPECT_NEAR(frames.T_map_base().y, 20.5 + 2 * std::sin(0.1), 1e-9);
  EXPECT_EQ(frames.height(), 0.0) << "a correction has a height";
  EXPECT_EQ(frames.T_map_start(), (Pose2{10, 20, 0}));
  const Eigen::Vector3d corner(1, 2, 3);
  EXPECT_NEAR((frames.to_odom(frames.to_map(corner)) - corner).norm(), 0, 1e-9);
  const Eigen::Vector2d goal(14, 21);
  EXPECT_NEAR((frames.T_map_odom() * frames.to_odom(goal) - goal).norm(), 0, 1e-9);
}

TEST_F(FramesTest, InvalidCorrectionsAreRefused) {
  drive(0, 2);
  ASSERT_EQ(correct({11, 20, 0}), Reason::none);
  MapFrame corrected = frames.map_frame();
  corrected.T_map_odom.position.x() = std::nan("");
  EXPECT_EQ(frames.correct(corrected).reason(), Reason::out_of_range);
  corrected.T_map_odom = {};
  corrected.T_map_odom.orientation = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX());
  EXPECT_EQ(frames.correct(corrected).reason(), Reason::out_of_range);
  corrected.T_map_odom = {};
  corrected.T_map_odom.orientation.coeffs().setZero();
  EXPECT_EQ(frames.correct(corrected).reason(), Reason::out_of_range);
  EXPECT_EQ(frames.T_map_odom(), (Pose2{11, 20, 0}));
}

TEST_F(FramesTest, OfTwoCorrectionsFromOnePlaceTheSecondIsRefused) {
  drive(0, 2);
  const MapFrame before = frames.map_frame();
  EXPECT_EQ(correct({11, 20, 0}, before), Reason::none);
  EXPECT_EQ(correct({12, 20, 0}, before), Reason::sample_stale);
  EXPECT_EQ(frames.T_map_odom(), (Pose2{11, 20, 0}));
}

TEST_F(FramesTest, ACorrectionFromBeforeTheOperatorsPoseIsRefused) {
  drive(0, 2);
  const MapFrame before = frames.map_frame();
  frames.set_pose({0, 0, 0});
  EXPECT_EQ(correct({11, 20, 0}, before), Reason::sample_stale);
  EXPECT_NEAR(frames.T_map_base().x, 0, 1e-9);
  ASSERT_TRUE(sample(2.1));
  EXPECT_EQ(correct({-2, 0.1, 0}), Reason::none);
}

TEST_F(FramesTest, WithoutStampsACorrectionOfAnOlderPlaceIsRefused) {
  for (int n = 0; n <= 20; ++n) ASSERT_TRUE(sample(0.1 * n, 0));
  const MapFrame before = frames.map_frame();
  frames.set_pose({0, 0, 0});
  EXPECT_EQ(correct({11, 20, 0}, before), Reason::sample_stale);
  EXPECT_NEAR(frames.T_map_base().x, 0, 1e-9);
  EXPECT_EQ(correct({-2, 0.1, 0}), Reason::none);
}

TEST_F(FramesTest, AClockThatIsSetBackLetsNoOlderCorrectionPass) {
  drive(0, 2);
  const MapFrame before = frames.map_frame();
  frames.set_pose({0, 0, 0});
  ASSERT_TRUE(sample(2.1, stamp_of(-50)));
  EXPECT_EQ(correct({11, 20, 0}, before), Reason::sample_stale);
  EXPECT_NEAR(frames.T_map_base().x, 0.1, 1e-9);
  EXPECT_EQ(correct({-2, 0.1, 0}), Reason::none) << "of the place in force, whatever the clock says";
}

TEST_F(FramesTest, ARestartLetsNoOlderCorrectionPass) {
  drive(0, 2);
  const MapFrame first = frames.map_frame();
  frames.set_pose({0, 0, 0});
  const MapFrame last = frames.map_frame();
  const StoredFrames stored = frames.stored();
  frames = Frames(Pose2{10, 20, 0}, wheeled(), 3.0);
  frames.restore(stored);
  EXPECT_EQ(correct({11, 20, 0}, first), Reason::sample_stale);
  EXPECT_EQ(correct({11, 20, 0}, last), Reason::sample_stale)
      << "the instance that it was computed for ended";
  EXPECT_NEAR(frames.T_map_base().x, 0, 1e-9);
  EXPECT_EQ(correct({-2, 0.1, 0}), Reason::none);
}

TEST_F(FramesTest, AJumpAndACorrectionTogetherKeepThePlaceInTheMap) {
  drive(0, 2);
  ASSERT_EQ(correct({10, 20.5, 0}), Reason::none);
  const MapFrame before = frames.map_frame();
  ASSERT_FALSE(sample(50, stamp_of(2.1)));
  EXPECT_EQ(frames.odom_epoch(), before.odom_epoch + 1);
  EXPECT_NEAR(frames.T_map_base().x, 12, 1e-9) << "it is taken to be where it was, by the correction";
  EXPECT_NEAR(frames.T_map_base().y, 20.5, 1e-9);
  EXPECT_TRUE(std::isnan(x_at(1.0))) << "no pose of the frame before";
  EXPECT_EQ(correct({10, 20.7, 0}, before), Reason::odometry_jumped) << "SLAM was still matching its scans";
  EXPECT_EQ(correct({-38, 20.6, 0}), Reason::none);
  EXPECT_NEAR(frames.T_map_base().y, 20.6, 1e-9);
}

TEST_F(FramesTest, ARestartRestoresTheCorrection) {
  drive(0, 2);
  ASSERT_EQ(correct({10, 20.5, 0.3}), Reason::none);
  Frames again(Pose2{10, 20, 0}, wheeled(), 3.0);
  again.restore(frames.stored());
  EXPECT_EQ(again.T_map_odom(), (frames.T_map_odom()));
  EXPECT_EQ(again.height(), frames.height());
  EXPECT_EQ(again.odom_epoch(), frames.odom_epoch());
  EXPECT_FALSE(again.initialised()) << "no odometry was heard yet";
  EXPECT_FALSE(again.T_odom_base_at(stamp_of(1.5)));
  ASSERT_TRUE(again.update(Pose3::level({2, 0, 0}, 0), {}, stamp_of(2.5), now + 500ms));
  EXPECT_NEAR(again.T_map_base().x, frames.T_map_base().x, 1e-9);
  EXPECT_NEAR(again.T_map_base().y, frames.T_map_base().y, 1e-9);
  EXPECT_EQ(again.T_map_start(), (Pose2{10, 20, 0}));
}

TEST_F(FramesTest, AHeightThatWasNotStoredIsTheStartsHeight) {
  StoredFrames stored = frames.stored();
  stored.height.reset();
  frames.restore(stored);
  EXPECT_EQ(frames.height(), 3.0);
}

TEST(PoseHistory, KeepsABoundedNumberInTheOrderOfTheirStamps) {
  PoseHistory history;
  const auto pose = [](double x) { return Pose3::level({x, 0, 0}, 0); };
  for (int i = 1; i <= 1000; ++i) {
    // Every other one comes after its successor.
    const int n = i % 2 == 1 ? i + 1 : i - 1;
    history.add(static_cast<std::uint64_t>(n) * 1000, pose(n));
  }
  EXPECT_EQ(history.size(), PoseHistory::kCapacity);
  EXPECT_EQ(history.newest(), 1'000'000u);
  for (int n = 746; n <= 999; ++n)
    EXPECT_NEAR(history.at(static_cast<std::uint64_t>(n) * 1000 + 500)->position.x(), n + 0.5, 1e-9) << n;
  EXPECT_FALSE(history.at(100'000));
  history.add(100'000, pose(1));
  EXPECT_FALSE(history.at(100'000)) << "older than a full history";
}

TEST(PoseHistory, TurnsTheShortWayRound) {
  PoseHistory history;
  history.add(1000, Pose3::level({0, 0, std::numbers::pi - 0.1}, 0));
  history.add(2000, Pose3::level({0, 0, -std::numbers::pi + 0.1}, 0));
  EXPECT_NEAR(std::fabs(history.at(1500)->yaw()), std::numbers::pi, 1e-9);
}

}  // namespace
}  // namespace adit::agent
