// SPDX-License-Identifier: Apache-2.0
#include "perception/stairs/stairs_detector.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/geometry/pose.hpp"
#include "tests/perception/stairs/scene.hpp"

namespace adit::perception {
namespace {

using scenes::Cloud;
using scenes::Scene;

/// A flight of six steps of 17 cm by 29 cm, 1.2 m wide, that climbs along +x from the origin.
Scene six_steps() {
  Scene scene;
  scene.truth = Staircase{.foot = {0.0, 0.0, 0.085}, .rise = 0.17, .run = 0.29, .width = 1.2, .steps = 6};
  for (int k = 0; k < 6; ++k)
    scenes::add_box(scene, k * 0.29, k == 5 ? 6.0 : (k + 1) * 0.29, -0.6, 0.6, 0.0, (k + 1) * 0.17);
  return scene;
}

/// A second of sweeps, with half of the columns of a real lidar.
const scenes::Sensing kSensing{.lidar = {.columns = 450}, .sweeps = 10};

std::vector<Staircase> found_in(const Scene& scene, const scenes::Sensing& sensing = kSensing,
                                std::uint64_t seed = 1) {
  Random random(seed);
  const Cloud cloud = scenes::sense(scene, sensing, random);
  return StairsDetector().detect(cloud.points, cloud.eye);
}

void expect_same(const Staircase& found, const Staircase& truth) {
  EXPECT_EQ(found.steps, truth.steps);
  EXPECT_NEAR(found.rise, truth.rise, 0.01);
  EXPECT_NEAR(found.run, truth.run, 0.012);
  EXPECT_NEAR(found.width, truth.width, 0.08);
  EXPECT_NEAR(wrap_angle(found.heading - truth.heading), 0.0, 0.05);
  EXPECT_LT((found.foot - truth.foot).norm(), 0.1);
  EXPECT_LT((found.top() - truth.top()).norm(), 0.15);
}

TEST(StairsDetector, FindsAFlightThatLeadsUp) {
  Scene scene = six_steps();
  scene.start = {-2.0, 0.2, 0.3};
  const auto found = found_in(scene);
  ASSERT_EQ(found.size(), 1U);
  expect_same(found[0], scenes::seen_from(scene, *scene.truth));
  EXPECT_TRUE(valid(found[0]));
}

TEST(StairsDetector, FindsItBetweenWalls) {
  Scene scene = six_steps();
  scene.start = {-1.5, -0.1, -0.2};
  scenes::add_box(scene, -3.0, 6.0, 0.6, 0.8, 0.0, 3.0);
  scenes::add_box(scene, -3.0, 6.0, -0.8, -0.6, 0.0, 3.0);
  const auto found = found_in(scene);
  ASSERT_EQ(found.size(), 1U);
  expect_same(found[0], scenes::seen_from(scene, *scene.truth));
}

TEST(StairsDetector, FindsAFlightThatLeadsDownFromItsEdge) {
  Scene scene = six_steps();
  scene.start = {5 * 0.29 + 0.6, 0.1, M_PI};
  scene.ground = 6 * 0.17;
  const auto found = found_in(scene);
  ASSERT_EQ(found.size(), 1U);
  expect_same(found[0], scenes::seen_from(scene, *scene.truth));
}

TEST(StairsDetector, FindsItInOneSweepOf16Rings) {
  Scene scene = six_steps();
  scene.start = {-2.0, 0.0, 0.0};
  const auto found =
      found_in(scene, {.lidar = {.rings = 16, .lowest = -15.0, .highest = 15.0, .height = 0.5}, .sweeps = 1});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].rise, 0.17, 0.02);
  EXPECT_NEAR(found[0].run, 0.29, 0.03);
}

TEST(StairsDetector, SeesNoneWhereThereIsNone) {
  for (std::uint64_t n = 0; n < scenes::kNotStairs.size(); ++n) {
    Random random = Random(n + 1).fork(7);
    const Scene scene = scenes::not_stairs(n, random);
    EXPECT_TRUE(found_in(scene, kSensing, n).empty()) << scenes::kNotStairs[n];
  }
}

TEST(StairsDetector, TwoKerbsAreNoStaircase) {
  Scene scene;
  scene.start = {-2.0, 0.0, 0.1};
  scenes::add_box(scene, 0.0, 0.3, -3.0, 3.0, 0.0, 0.16);
  scenes::add_box(scene, 0.3, 5.0, -3.0, 3.0, 0.0, 0.32);
  EXPECT_TRUE(found_in(scene).empty());
}

TEST(StairsDetector, StepsOfDifferentHeightsAreNone) {
  Scene scene;
  scene.start = {-2.0, 0.0, 0.0};
  double height = 0.0;
  for (const double rise : {0.10, 0.24, 0.12, 0.22}) {
    const double x = 0.3 * static_cast<double>(scene.solids.size());
    height += rise;
    scenes::add_box(scene, x, 5.0, -0.6, 0.6, 0.0, height);
  }
  EXPECT_TRUE(found_in(scene).empty());
}

TEST(StairsDetector, TakesAnyCloud) {
  StairsDetector detector;
  EXPECT_TRUE(detector.detect({}, {0, 0, 0.6f}).empty());
  const float nan = std::numeric_limits<float>::quiet_NaN(), far = 1e30f;
  std::vector<Eigen::Vector3f> points(1000, Eigen::Vector3f(nan, 0.0f, 0.0f));
  points.resize(2000, Eigen::Vector3f(far, -far, far));
  points.resize(3000, Eigen::Vector3f(1.0f, 1.0f, 0.0f));
  EXPECT_TRUE(detector.detect(points, {0, 0, 0.6f}).empty());
  EXPECT_TRUE(detector.detect(points, {0, 0, 0.6f}, false).empty());
}

}  // namespace
}  // namespace adit::perception
