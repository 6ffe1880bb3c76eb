// SPDX-License-Identifier: Apache-2.0
#include "perception/voxel/thin.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/time/random.hpp"
#include "sim/world/noise.hpp"

namespace adit::perception {
namespace {

std::vector<Eigen::Vector3f> room(double size, std::size_t count) {
  Random random(3);
  std::vector<Eigen::Vector3f> points;
  for (std::size_t n = 0; n < count; ++n) {
    Eigen::Vector3d p(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-1, 2));
    p[static_cast<Eigen::Index>(random.below(2))] = random.chance(0.5) ? size : -size;
    points.push_back(p.cast<float>());
  }
  return points;
}

TEST(Thinner, LeavesAboutAsManyPointsInAnyRoom) {
  for (const double size : {2.0, 8.0, 25.0}) {
    Thinner thinner({.wanted = 1500});
    std::size_t left = 0;
    for (int n = 0; n < 10; ++n) left = thinner.thin(room(size, 14'000)).size();
    EXPECT_GE(left, 1000u) << size;
    EXPECT_LE(left, 2000u) << size;
  }
}

TEST(Thinner, KeepsOnePointOfEachVoxelWhenThereAreManyMoreThanWanted) {
  Thinner thinner({.wanted = 10, .min_edge = 0.5f, .max_edge = 0.5f});
  std::vector<Eigen::Vector3f> points;
  for (int round = 0; round < 3; ++round)
    for (int x = 0; x < 100; ++x)
      for (int y = 0; y < 100; ++y)
        points.push_back({0.5f * static_cast<float>(x) + 0.55f, 0.5f * static_cast<float>(y) + 0.25f, 0.25f});
  EXPECT_EQ(thinner.thin(points).size(), 10'000u);
  EXPECT_EQ(thinner.thin(points).size(), 10'000u);
}

TEST(Thinner, LeavesOutPointsThatAreNoReturns) {
  std::vector<Eigen::Vector3f> points = room(5, 2000);
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinite = std::numeric_limits<float>::infinity();
  points.push_back({nan, 0, 0});
  points.push_back({infinite, 1, 1});
  points.push_back({0.1f, 0, 0});
  points.push_back({500, 0, 0});
  Thinner thinner({});
  for (const Eigen::Vector3f& p : thinner.thin(points)) {
    ASSERT_TRUE(p.allFinite());
    ASSERT_GT(p.norm(), 0.4f);
    ASSERT_LT(p.norm(), 100.0f);
  }
  EXPECT_TRUE(Thinner({}).thin({}).empty());
}

/// A turn of 900 columns between two walls, from behind counter-clockwise as a sweep comes, with range
/// errors.
std::vector<Eigen::Vector3f> corridor_sweep(Random& random) {
  std::vector<Eigen::Vector3f> points;
  for (int column = 0; column < 900; ++column) {
    const double angle = -M_PI + 2 * M_PI * column / 900.0, away = 1.3 / std::abs(std::sin(angle));
    if (!(away < 20.0)) continue;
    for (int ring = 0; ring < 4; ++ring) {
      const double range = away + 0.05 * sim::gaussian(random);
      points.emplace_back(
          Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0.4 * ring).cast<float>());
    }
  }
  return points;
}

TEST(Thinner, DoesNotTurnACloudThatComesInTheOrderOfItsAngle) {
  Random random(7);
  Thinner thinner({.wanted = 400});
  double turn = 0, weight = 0;
  for (int cloud = 0; cloud < 200; ++cloud)
    for (const Eigen::Vector3f& p : thinner.thin(corridor_sweep(random))) {
      // How far beside its wall, to the left: of a turned cloud it grows with x.
      const double beside = p.y() - std::copysign(1.3, p.y());
      turn += p.x() * beside;
      weight += p.x() * p.x();
    }
  EXPECT_NEAR(turn / weight, 0.0, 2e-5);  // Four standard deviations.
}

}  // namespace
}  // namespace adit::perception
