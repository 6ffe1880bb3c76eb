// SPDX-License-Identifier: Apache-2.0
#include "perception/voxel/voxel_planes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/time/random.hpp"
#include "perception/voxel/thin.hpp"

namespace adit::perception {
namespace {

using Vectors = std::vector<Eigen::Vector3d>;

const Eigen::Vector3d kLidar(0, 0, 1);

/// Points of a wall x + 0.2 y = 4 with 2 cm of noise.
Vectors wall(Random& random, std::size_t count) {
  Vectors points;
  for (std::size_t n = 0; n < count; ++n) {
    const double y = random.uniform(-3, 3), noise = 0.035 * (random.uniform() + random.uniform() - 1.0);
    points.push_back({4 - 0.2 * y + noise, y, random.uniform(0, 2)});
  }
  return points;
}

TEST(VoxelPlanes, FindsAWallAndItsNormal) {
  VoxelPlanes map({});
  Random random(1);
  for (int cloud = 1; cloud <= 5; ++cloud) map.insert(wall(random, 1000), kLidar, cloud);
  const Eigen::Vector3f normal = Eigen::Vector3f(1, 0.2f, 0).normalized();
  int found = 0;
  for (double y = -2.5; y < 2.6; y += 0.25) {
    const auto plane = map.find({4 - 0.2 * y, y, 1.0});
    if (!plane || plane->line) continue;
    ++found;
    EXPECT_GT(std::abs(plane->normal.dot(normal)), 0.995f);
    EXPECT_LT(plane->variance, 0.03f * 0.03f);
  }
  EXPECT_GE(found, 18);
  EXPECT_FALSE(map.find({1, 0, 1}));
}

TEST(VoxelPlanes, FindsAWallOnTheBorderOfTwoVoxelsFromBothSides) {
  VoxelPlanes map({});
  Random random(7);
  Vectors points;
  for (int n = 0; n < 2000; ++n) points.push_back({4.0, random.uniform(-2, 2), random.uniform(0, 2)});
  map.insert(points, kLidar, 1);
  EXPECT_TRUE(map.find({4.05, 0.5, 1.5}));
  EXPECT_TRUE(map.find({3.95, 0.5, 1.5}));
  EXPECT_FALSE(map.find({3.8, 0.5, 1.5}));
}

TEST(VoxelPlanes, SinglePointsBeyondTheBorderDoNotHideAWall) {
  VoxelPlanes map({});
  Random random(8);
  Vectors points;
  for (int n = 0; n < 2000; ++n)
    points.push_back({3.99 + random.uniform(-0.009, 0.009), random.uniform(-2, 2), random.uniform(0, 2)});
  // A few of them were measured just behind it.
  for (int n = 0; n < 12; ++n) points.push_back({4.005, -1.9 + 0.3 * n, random.uniform(0, 2)});
  map.insert(points, kLidar, 1);
  int found = 0;
  for (double y = -1.95; y < 2; y += 0.1) found += map.find({4.03, y, 1.0}).has_value();
  EXPECT_EQ(found, 40);
}

TEST(VoxelPlanes, OfACompleteCloudFindsTheSameWallInVoxelsOfAllSizes) {
  VoxelPlanes::Params params;
  params.levels = VoxelPlanes::kMaxLevels;
  Random random(9);
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3d& p : wall(random, 20000)) points.push_back(p.cast<float>());
  points.push_back(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  points.push_back(Eigen::Vector3f::Constant(1e30f));
  const VoxelPlanes map = VoxelPlanes::of(points, params);
  const Eigen::Vector3f normal = Eigen::Vector3f(1, 0.2f, 0).normalized();
  for (int top = 0; top < VoxelPlanes::kMaxLevels; ++top) {
    const auto plane = map.find({3.9, 0.5, 0.9}, top);
    ASSERT_TRUE(plane) << top;
    EXPECT_GT(std::abs(plane->normal.dot(normal)), 0.99f) << top;
    EXPECT_NEAR(plane->normal.cast<double>().dot(Eigen::Vector3d(3.9, 0.5, 0.9) - plane->centre), 0.0, 0.02)
        << top;
  }
}

TEST(VoxelPlanes, OneRingOnAWallIsNoPlane) {
  VoxelPlanes map({});
  Random random(2);
  Vectors ring;
  for (int n = 0; n < 400; ++n) ring.push_back({4.0 + 0.01 * random.uniform(), -2 + 0.01 * n, 1.0});
  for (int cloud = 1; cloud <= 5; ++cloud) map.insert(ring, kLidar, cloud);
  for (double y = -1.9; y < 1.9; y += 0.1) EXPECT_FALSE(map.find({4, y, 1.0}));
}

TEST(VoxelPlanes, AnUprightPoleIsALineAlsoForABodyThatStands) {
  VoxelPlanes map({});
  Random random(3);
  for (int cloud = 1; cloud <= 5; ++cloud) {
    Vectors pole;
    for (int n = 0; n < 60; ++n)
      pole.push_back(
          {2.4 + random.uniform(-0.05, 0.05), 1.4 + random.uniform(-0.05, 0.05), random.uniform(0.05, 0.95)});
    map.insert(pole, kLidar, 0.0);
  }
  const auto line = map.find({2.4, 1.4, 0.5});
  ASSERT_TRUE(line);
  EXPECT_TRUE(line->line);
  EXPECT_LT(std::abs(line->normal.z()), 0.3f);
  EXPECT_LT(std::abs(line->along.z()), 0.3f);
}

TEST(VoxelPlanes, ForgetsPlacesLeftBehindAndStaysBounded) {
  VoxelPlanes map({.keep_distance = 30.0, .max_voxels = 4000});
  Random random(4);
  for (int step = 0; step < 600; ++step) {
    Vectors here;
    for (int n = 0; n < 300; ++n)
      here.push_back(
          {0.5 * step + random.uniform(-4, 4), random.chance(0.5) ? 3.0 : -3.0, random.uniform(0, 2)});
    map.insert(here, {0.5 * step, 0, 1}, 0.5 * step);
    map.forget(0.5 * step);
    ASSERT_LE(map.size(), 3u * 4000u);
  }
  EXPECT_FALSE(map.find({10, 3, 1}));
  EXPECT_TRUE(map.find({297, 3, 1}));
  EXPECT_LT(map.bytes(), 4'000'000u);
}

/// Rough ground: hills of 2 m, and rocks that are too uneven for the largest voxels.
double ground(double x, double y) {
  return 2 * std::sin(0.11 * x) * std::sin(0.09 * y) + 0.2 * std::sin(3.7 * x + y) * std::sin(3.9 * y - x);
}

/// One sweep on it from (x, 0, 1), up to 100 m: 32 rings 0.8 degrees apart, which bumps spread along the ray.
std::vector<Eigen::Vector3f> sweep_on_ground(Random& random, double x) {
  std::vector<Eigen::Vector3f> points;
  for (int ring = 1; ring <= 32; ++ring)
    for (int n = 0; n < 900; ++n) {
      const double azimuth = n * 2 * M_PI / 900;
      const double range = random.uniform(0.6, 1.1) / std::tan(0.8 * ring * M_PI / 180);  // m
      const double px = x + range * std::cos(azimuth), py = range * std::sin(azimuth);
      points.push_back(
          Eigen::Vector3d(px - x, py, ground(px, py) + random.uniform(-0.02, 0.02) - 1).cast<float>());
    }
  return points;
}

TEST(VoxelPlanes, KnowsTheGroundAheadAfterALongDriveInTheOpen) {
  VoxelPlanes map({});
  Thinner thinner({.wanted = 12000, .min_edge = 0.05f});
  Random random(19);
  for (double x = 0; x < 60; x += 0.5) {
    const Eigen::Vector3d lidar(x, 0, 1);
    Vectors points;
    for (const Eigen::Vector3f& p : thinner.thin(sweep_on_ground(random, x)))
      points.push_back(p.cast<double>() + lidar);
    map.insert(points, lidar, x);
    map.forget(x);
  }
  int known = 0, all = 0;
  for (double x = 45; x < 75; x += 0.5)
    for (double y = -15; y < 15; y += 0.5) {
      if (std::hypot(x - 60, y) > 15) continue;
      ++all;
      known += map.find({x, y, ground(x, y)}).has_value();
    }
  EXPECT_GE(known, 0.9 * all) << "of " << all;
  EXPECT_LE(map.size(), 3 * VoxelPlanes::Params{}.max_voxels);
  EXPECT_LE(map.bytes(), 40'000'000u);
}

TEST(VoxelPlanes, FullOfNearerVoxelsItRefusesFartherOnes) {
  VoxelPlanes map({.max_voxels = 500});
  Random random(20);
  const auto patch = [&](double x) {
    Vectors points;
    for (int n = 0; n < 4000; ++n) points.push_back({x + random.uniform(-2, 2), random.uniform(-2, 2), 0.01});
    return points;
  };
  EXPECT_EQ(map.insert(patch(0), kLidar, 0), 0u);
  Vectors wide;
  for (int n = 0; n < 4000; ++n) wide.push_back({15 + random.uniform(-4, 4), random.uniform(-4, 4), 0.01});
  EXPECT_GT(map.insert(wide, kLidar, 0), 1000u);
  EXPECT_TRUE(map.find({1, 1, 0}, 0));
  // From there, the place that was left is farther.
  map.insert(patch(15), {15, 0, 1}, 15);
  EXPECT_EQ(map.insert(patch(15), {15, 0, 1}, 15), 0u);
  EXPECT_TRUE(map.find({16, 1, 0}, 0));
}

}  // namespace
}  // namespace adit::perception
