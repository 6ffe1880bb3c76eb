// SPDX-License-Identifier: Apache-2.0
#include "perception/place/recognise.hpp"

#include <gtest/gtest.h>

#include "core/config/platform_file.hpp"
#include "sim/drive/drive_recording.hpp"

namespace adit::perception {
namespace {

using namespace sim;

/// Two halls; the right one is furnished otherwise.
std::shared_ptr<const World> halls() {
  const std::vector<Box> boxes{{-0.2, 0, 0, 12, 0, 3},   {14, 14.2, 0, 12, 0, 3},   {0, 14, -0.2, 0, 0, 3},
                               {0, 14, 12, 12.2, 0, 3},  {4, 5, 4, 5, 0, 2},        {8, 8.6, 7, 9, 0, 1.2},
                               {10, 11, 2.5, 3.2, 0, 3}, {5, 5.3, 8, 8.3, 0, 3},    {30, 30.2, 0, 9, 0, 3},
                               {39, 39.2, 0, 9, 0, 3},   {30, 39.2, -0.2, 0, 0, 3}, {30, 39.2, 9, 9.2, 0, 3},
                               {36, 37, 1, 6, 0, 2}};
  return std::make_shared<const World>(make_box_world(boxes, 0.0, 3.0).value());
}

/// Scans a metre apart, and where they were taken.
std::vector<Keyframe> scans(const Pose2& start, const Eigen::Vector2d& end, std::uint64_t seed) {
  DriveSpec spec;
  spec.world = halls();
  spec.platform = config::load_platform("wheeled").value();
  spec.start = start;
  spec.steps = {DriveTo{end}};
  spec.seed = seed;
  const auto drive = record_drive(spec);
  EXPECT_TRUE(drive.ok());
  const Pose3 T_base_lidar = spec.platform.lidar().mounting.pose();
  std::vector<Keyframe> keyframes;
  for (const Sweep& sweep : drive->sweeps) {
    const Pose3 T_world_base = drive->truth_at(DriveRecording::end_of(sweep));
    if (!keyframes.empty() && (keyframes.back().T_odom_base.position - T_world_base.position).norm() < 1.0)
      continue;
    PointCloud points;
    for (const TimedPoint& p : sweep.points) {
      const auto stamp = sweep.stamp + static_cast<std::uint64_t>(p.time * 1e9);
      const Pose3 T_base = T_world_base.inverse() * drive->truth_at(stamp) * T_base_lidar;
      points.push_back((T_base.orientation * p.position.cast<double>() + T_base.position).cast<float>());
    }
    keyframes.push_back(make_keyframe(points, T_world_base, 0));
  }
  EXPECT_GE(keyframes.size(), 2U);
  return keyframes;
}

const std::vector<Keyframe>& before() {
  static const auto all = scans({2, 2, 0}, {6, 1.5}, 1);
  return all;
}
const Keyframe& afterwards() {
  static const Keyframe last = scans({5.5, 1.6, 0}, {7, 1.5}, 2).back();
  return last;
}

TEST(Recognise, FindsAnErrorOfThePose) {
  struct Case {
    double x, y, degrees;
  };
  for (const Case& off : {Case{0, 0, 0}, Case{0.3, 0.2, 0}, Case{-0.2, 0.3, 5}, Case{0.1, -0.4, -8}}) {
    const Pose3 truth = afterwards().T_odom_base;
    Pose3 guess = truth;
    guess.position += Eigen::Vector3d(off.x, off.y, 0);
    guess.orientation =
        Eigen::AngleAxisd(off.degrees * M_PI / 180, Eigen::Vector3d::UnitZ()) * guess.orientation;
    const auto found = recognise(before(), afterwards().points, guess);
    ASSERT_TRUE(found.ok()) << found.error().text;
    EXPECT_TRUE(found->compared);
    const Pose3 corrected = found->correction * guess;
    EXPECT_LT((corrected.position - truth.position).head<2>().norm(), 0.04) << off.x << " " << off.degrees;
    EXPECT_LT(std::abs(wrap_angle(corrected.yaw() - truth.yaw())), 0.01);
    EXPECT_LT((found->correction.orientation * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm(),
              1e-6);
  }
}

TEST(Recognise, NeedsOneKeyframeOnly) {
  const std::vector<Keyframe> one{before().back()};
  const Pose3 truth = afterwards().T_odom_base;
  Pose3 guess = truth;
  guess.position += Eigen::Vector3d(0.3, -0.2, 0);
  const auto found = recognise(one, afterwards().points, guess);
  ASSERT_TRUE(found.ok()) << found.error().text;
  EXPECT_LT(((found->correction * guess).position - truth.position).head<2>().norm(), 0.05);
  EXPECT_GT(found->overlap, kAlignOverlap);
}

TEST(Recognise, RefusesAnotherRoom) {
  for (const Keyframe& elsewhere : scans({32, 2, 0}, {34, 5}, 2))
    EXPECT_EQ(recognise(before(), elsewhere.points, Pose3::level({6, 1.6, 0.3}, 0)).reason(),
              Reason::not_localised_here);
}

TEST(Recognise, RefusesAPlaceTooFarAway) {
  Pose3 guess = afterwards().T_odom_base;
  guess.position.x() -= 3;
  EXPECT_EQ(recognise(before(), afterwards().points, guess).reason(), Reason::not_localised_here);
}

TEST(Recognise, ComparesNothingWithoutKeyframes) {
  const auto found = recognise({}, afterwards().points, afterwards().T_odom_base);
  ASSERT_TRUE(found.ok());
  EXPECT_FALSE(found->compared);
  EXPECT_EQ(found->correction.position.norm(), 0.0);
}

}  // namespace
}  // namespace adit::perception
