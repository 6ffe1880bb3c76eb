// SPDX-License-Identifier: Apache-2.0
#include "perception/place/relocalise.hpp"

#include <gtest/gtest.h>

#include "tests/perception/place/halls.hpp"

namespace adit::perception {
namespace {

const Keyframe& lost() {
  static const Keyframe last = scans({5.5, 1.6, 0}, {7, 1.5}, 2).back();
  return last;
}

TEST(Relocalise, FindsThePlaceMetresAwayAndTurned) {
  const Pose3 truth = lost().T_odom_base;
  for (const Pose3& guess :
       {beside(truth, 0, 0, 0), beside(truth, 1.6, 1.2, 0.7), beside(truth, -1.4, 1.4, -2.6)}) {
    const auto found = relocalise(before(), lost().points, guess, 0.8);
    ASSERT_TRUE(found.ok()) << found.error().text;
    ASSERT_EQ(found->match, PlaceMatch::found);
    const Pose3 corrected = found->correction * guess;
    EXPECT_LT((corrected.position - truth.position).head<2>().norm(), 0.05);
    EXPECT_LT(std::abs(wrap_angle(corrected.yaw() - truth.yaw())), 0.01);
    EXPECT_LT(found->runner_up, found->overlap);
  }
}

TEST(Relocalise, FindsThePlaceOfABodyThatWasCarriedFar) {
  const Pose3 truth = lost().T_odom_base;
  for (const Pose3& guess : {beside(truth, 11, 4, 2.5), beside(truth, -6, -13, -0.9)}) {
    const auto found = relocalise(before(), lost().points, guess, 0.1, {.moved = 15.0});
    ASSERT_TRUE(found.ok()) << found.error().text;
    ASSERT_EQ(found->match, PlaceMatch::found);
    EXPECT_LT(((found->correction * guess).position - truth.position).head<2>().norm(), 0.05);
  }
  const auto elsewhere = scans({32, 2, 0}, {33.5, 3}, 2);
  EXPECT_EQ(
      relocalise(before(), elsewhere[0].points, Pose3::level({16, 2, 0}, 0), 0.1, {.moved = 15.0}).reason(),
      Reason::not_localised_here);
}

TEST(Relocalise, RefusesAnotherHall) {
  const auto others = scans({32, 2, 0}, {33.5, 3}, 2);
  for (const Keyframe& elsewhere : others)
    EXPECT_EQ(relocalise(before(), elsewhere.points, Pose3::level({6, 1.6, 0.3}, 0), 0.8).reason(),
              Reason::not_localised_here);
}

TEST(Relocalise, RefusesAPlaceBeyondWhatTheBodyCanHaveDone) {
  const Pose3 guess = beside(lost().T_odom_base, 2.5, 0, 0);
  EXPECT_EQ(relocalise(before(), lost().points, guess, 0.1, {.moved = 0.2}).reason(),
            Reason::not_localised_here);
  EXPECT_EQ(relocalise(before(), lost().points, beside(lost().T_odom_base, 0, 0, 1.5), 0.1, {.max_turn = 0.5})
                .reason(),
            Reason::not_localised_here);
}

TEST(Relocalise, RefusesPlacesThatLookAlike) {
  PointCloud square;  // Four headings fit.
  add_wall(square, {-4, -4}, {4, -4});
  add_wall(square, {4, -4}, {4, 4});
  add_wall(square, {4, 4}, {-4, 4});
  add_wall(square, {-4, 4}, {-4, -4});
  PointCloud passage;  // With pillars 2.4 m apart, all alike.
  for (float x = -29.8f; x < 29; x += 2.4f) {
    add_wall(passage, {x, 2.3f}, {x, 1.5f});
    add_wall(passage, {x, 1.5f}, {x + 0.4f, 1.5f});
    add_wall(passage, {x + 0.4f, 1.5f}, {x + 0.4f, 2.3f});
  }
  add_wall(passage, {-30, 2.3f}, {30, 2.3f});
  add_wall(passage, {-30, -2.3f}, {30, -2.3f});
  for (const PointCloud& cloud : {square, passage}) {
    const std::vector<Keyframe> keyframes{make_keyframe(cloud, {}, 0)};
    const auto found = relocalise(keyframes, cloud, {}, 0.8);
    EXPECT_EQ(found.reason(), Reason::not_localised_here);
    EXPECT_NE(found.error().text.find("look alike"), std::string::npos) << found.error().text;
  }
}

TEST(Relocalise, FindsThePlaceOnARamp) {
  const Pose3 level = lost().T_odom_base;
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d::UnitX().eval(), Eigen::Vector3d::UnitY().eval()}) {
    Pose3 truth = level;
    truth.orientation = truth.orientation * Eigen::AngleAxisd(15 * M_PI / 180, axis);
    const Pose3 T_truth_level = truth.inverse() * level;
    PointCloud seen;
    for (const Eigen::Vector3f& p : lost().points)
      seen.push_back((T_truth_level * p.cast<double>()).cast<float>());
    for (const double turn : {-2.6, -1.6, 0.7, 2.0, 3.1}) {
      const Pose3 guess = beside(truth, 11, 4, turn);
      SCOPED_TRACE(turn);
      const auto found = relocalise(before(), seen, guess, 0.1, {.moved = 15.0});
      ASSERT_TRUE(found.ok()) << found.error().text;
      EXPECT_EQ(found->match, PlaceMatch::found);
      const Pose3 corrected = found->correction * guess;
      EXPECT_LT((corrected.position - truth.position).norm(), 0.05);
      EXPECT_LT(corrected.orientation.angularDistance(truth.orientation), 0.02);
    }
  }
}

TEST(Relocalise, RefusesAPlaceWhenItCouldNotCompareAllOthers) {
  const Pose3 guess = beside(lost().T_odom_base, 1.6, 1.2, 0.7);
  ASSERT_TRUE(relocalise(before(), lost().points, guess, 0.8).ok());
  for (const std::size_t squares : {1U, 5U, 20U}) {
    const auto found = relocalise(before(), lost().points, guess, 0.8, {.max_squares = squares});
    ASSERT_EQ(found.reason(), Reason::not_localised_here) << squares;
    EXPECT_NE(found.error().text.find("too many"), std::string::npos) << found.error().text;
  }
}

TEST(Relocalise, SaysWhatItCannotCompare) {
  EXPECT_EQ(relocalise({}, lost().points, {}, 0.5)->match, PlaceMatch::nothing_stored);
  EXPECT_EQ(relocalise(before(), std::span(lost().points).first(150), lost().T_odom_base, 0.5)->match,
            PlaceMatch::cannot_tell);
}

TEST(Relocalise, IsDeterministic) {
  const Pose3 guess = beside(lost().T_odom_base, 1, 0.5, 0.4);
  const auto one = relocalise(before(), lost().points, guess, 0.8),
             two = relocalise(before(), lost().points, guess, 0.8);
  EXPECT_EQ(one->correction.position, two->correction.position);
  EXPECT_EQ(one->overlap, two->overlap);
}

}  // namespace
}  // namespace adit::perception
