// SPDX-License-Identifier: Apache-2.0
#include "perception/place/recognise.hpp"

#include <gtest/gtest.h>

#include "tests/perception/place/halls.hpp"

namespace adit::perception {
namespace {

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
    EXPECT_EQ(found->match, PlaceMatch::found);
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
  EXPECT_EQ(found->match, PlaceMatch::nothing_stored);
  EXPECT_EQ(found->correction.position.norm(), 0.0);
}

TEST(Recognise, CannotTellByAScanThatShowsTooLittle) {
  for (const Keyframe& elsewhere : scans({32, 2, 0}, {34, 5}, 2)) {
    const auto found = recognise(before(), std::span(elsewhere.points).first(150), before()[1].T_odom_base);
    ASSERT_TRUE(found.ok());
    EXPECT_EQ(found->match, PlaceMatch::cannot_tell);
    EXPECT_EQ(found->correction.position.norm(), 0.0);
  }
}

TEST(Recognise, KnowsAPlaceByOneRing) {
  const std::vector<Keyframe> keyframes = scans({2, 2, 0}, {6, 1.5}, 1, true);
  ASSERT_TRUE(keyframes.front().planar);
  const Keyframe scan = scans({5.5, 1.6, 0}, {7, 1.5}, 2, true).back();
  for (const Pose3& guess : {scan.T_odom_base, beside(scan.T_odom_base, 0.3, -0.2, 0.1)}) {
    const auto found = recognise(keyframes, scan.points, guess, {.planar = true});
    ASSERT_TRUE(found.ok()) << found.error().text;
    EXPECT_EQ(found->match, PlaceMatch::found);
    const Pose3 corrected = found->correction * guess;
    EXPECT_LT((corrected.position - scan.T_odom_base.position).head<2>().norm(), 0.08);
    EXPECT_LT(std::abs(wrap_angle(corrected.yaw() - scan.T_odom_base.yaw())), 0.02);
  }
  for (const Keyframe& elsewhere : scans({32, 2, 0}, {34, 5}, 2, true))
    EXPECT_EQ(
        recognise(keyframes, elsewhere.points, Pose3::level({6, 1.6, 0.3}, 0), {.planar = true}).reason(),
        Reason::not_localised_here);
}

TEST(Recognise, DoesNotShiftAPoseAlongASmoothCorridor) {
  PointCloud corridor;
  add_wall(corridor, {-31, -1.5f}, {31, -1.5f});
  add_wall(corridor, {-31, 1.6f}, {31, 1.6f});
  const std::vector<Keyframe> keyframes{make_keyframe(corridor, {}, 0)};
  const auto found = recognise(keyframes, corridor, Pose3::level({0.1, 0.2, 0}, 0));
  ASSERT_TRUE(found.ok()) << found.error().text;
  EXPECT_NEAR(found->correction.position.x(), 0.0, 0.05);
  EXPECT_NEAR(found->correction.position.y(), -0.2, 0.05);
}

}  // namespace
}  // namespace adit::perception
