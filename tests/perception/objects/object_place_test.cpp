// SPDX-License-Identifier: Apache-2.0
#include "perception/objects/object_place.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace adit::perception {
namespace {

constexpr PinholeView kView{.field_of_view = 1.2, .aspect = 4.0 / 3.0};

/// The box of an upright plate with that middle, camera frame, m.
ObjectBox box_of(const Eigen::Vector3d& middle, double width, double height) {
  const auto a = kView.project(middle + Eigen::Vector3d(0, width / 2, height / 2)).value();
  const auto b = kView.project(middle - Eigen::Vector3d(0, width / 2, height / 2)).value();
  return {.kind = "thing",
          .score = 0.9,
          .left = a.x(),
          .top = a.y(),
          .width = b.x() - a.x(),
          .height = b.y() - a.y()};
}

void add_plate(std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& middle, double width,
               double height, double step = 0.1) {
  for (double y = -width / 2; y <= width / 2; y += step)
    for (double z = -height / 2; z <= height / 2; z += step)
      points.push_back((middle + Eigen::Vector3d(0, y, z)).cast<float>());
}

TEST(ObjectPlace, ProjectsWhereAPinholeCameraSees) {
  EXPECT_TRUE(kView.project({5, 0, 0}).value().isApprox(Eigen::Vector2d(0.5, 0.5)));
  // The left border of the picture is at half of the field of view.
  EXPECT_NEAR(kView.project({1, 0.999 * std::tan(0.6), 0}).value().x(), 0.0, 1e-3);
  EXPECT_NEAR(kView.project({1, 0, 0.999 * std::tan(0.6) * 3 / 4}).value().y(), 0.0, 1e-3);
  EXPECT_FALSE(kView.project({-1, 0, 0}));
  EXPECT_FALSE(kView.project({1, 2, 0}));
  const Eigen::Vector3d point(4, -1, 0.5);
  const auto at = kView.project(point).value();
  EXPECT_TRUE((4.0 * kView.ray(at.x(), at.y())).isApprox(point));
}

TEST(ObjectPlace, TakesTheObjectNotTheWallBehindIt) {
  const Eigen::Vector3d middle(5, 1, -0.2);
  std::vector<Eigen::Vector3f> points;
  add_plate(points, middle, 0.6, 1.7);
  add_plate(points, {9, 0, 0}, 10, 4, 0.2);
  const auto place = place_object(box_of(middle, 0.8, 1.9), kView, points);
  ASSERT_TRUE(place);
  EXPECT_LT((place->position - middle).norm(), 0.1);
  EXPECT_GT(place->sigma, 0.05);
  EXPECT_LT(place->sigma, 0.5);
}

TEST(ObjectPlace, GrainsOfDustInFrontAreNoObject) {
  const Eigen::Vector3d middle(5, 0, 0);
  std::vector<Eigen::Vector3f> points;
  add_plate(points, middle, 0.6, 1.7);
  points.emplace_back(1.0F, 0.0F, 0.0F);
  points.emplace_back(2.0F, 0.01F, 0.0F);
  const auto place = place_object(box_of(middle, 0.6, 1.7), kView, points);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->position.x(), 5.0, 0.1);
}

TEST(ObjectPlace, NothingWhereTheLidarSeesNothing) {
  const ObjectBox box = box_of({5, 0, 0}, 0.6, 1.7);
  EXPECT_FALSE(place_object(box, kView, {}));
  std::vector<Eigen::Vector3f> beside;
  add_plate(beside, {5, 2, 0}, 0.6, 1.7);
  EXPECT_FALSE(place_object(box, kView, beside));
  const std::vector<Eigen::Vector3f> two{{5, 0, 0}, {5, 0.1F, 0}};
  EXPECT_FALSE(place_object(box, kView, two));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(place_object(box, kView, std::vector<Eigen::Vector3f>(9, Eigen::Vector3f(nan, nan, nan))));
}

TEST(ObjectPlace, RefusesAHeightThatTheClassDoesNotHave) {
  ObjectBox box = box_of({5, 0, 0}, 0.6, 1.7);
  std::vector<Eigen::Vector3f> points;
  add_plate(points, {15, 0, 0}, 4, 6);  // The box shows a wall: a person there would be 5 m tall.
  box.shortest = 1.0;
  box.tallest = 2.4;
  EXPECT_FALSE(place_object(box, kView, points));
  box.shortest = box.tallest = 0;
  EXPECT_TRUE(place_object(box, kView, points));
}

}  // namespace
}  // namespace adit::perception
