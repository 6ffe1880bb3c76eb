// SPDX-License-Identifier: Apache-2.0
#include "sim/world/lidar.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <thread>

#include "sim/world/noise.hpp"

namespace adit::sim {
namespace {

World room() {  // 10 x 6 m inside
  const std::array<Box, 4> boxes{Box{-5.2, -5, -3, 3, 0, 3}, Box{5, 5.2, -3, 3, 0, 3},
                                 Box{-5.2, 5.2, -3.2, -3, 0, 3}, Box{-5.2, 5.2, 3, 3.2, 0, 3}};
  return *make_box_world(boxes, 0, 3);
}

LidarParams exact(LidarParams params) {
  params.range_noise = 0.0;
  return params;
}

TEST(Lidar, sees_the_walls_in_base_link) {
  const World world = room();
  const LidarPattern lidar(exact({}));
  EXPECT_EQ(lidar.size(), 14400u);
  const Pose2 at{1.0, -0.5, 0.7};
  const PointCloud points = lidar.scan(world, {}, Pose3::level(at, 0.0), 0.5, 1);
  EXPECT_EQ(points.size(), lidar.size()) << "a closed room";
  int floor = 0, walls = 0;
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector2d w = at * Eigen::Vector2d(p.x(), p.y());
    const double to_wall = std::min(5.0 - std::abs(w.x()), 3.0 - std::abs(w.y()));
    if (std::abs(p.z()) < 1e-4)
      ++floor;
    else if (std::abs(to_wall) < 1e-4)
      ++walls;
    else
      ADD_FAILURE() << p.transpose() << " is neither on the floor nor on a wall";
  }
  EXPECT_GT(floor, 3000);
  EXPECT_GT(walls, 9000);
}

TEST(Lidar, tilts_with_the_robot) {
  const World world = room();
  Pose3 base = Pose3::level({0, 0, 0}, 0.0);
  base.orientation = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY());
  for (const Eigen::Vector3f& p : LidarPattern(exact({})).scan(world, {}, base, 0.5, 1)) {
    const Eigen::Vector3d w = base * p.cast<double>();
    const double off = std::min({std::abs(w.z()), 5.0 - std::abs(w.x()), 3.0 - std::abs(w.y())});
    ASSERT_NEAR(off, 0.0, 1e-4);
  }
}

TEST(Lidar, robots_see_each_other) {
  const World world = room();
  const LidarPattern lidar(exact(LidarParams::planar()));
  const std::array<BodyBox, 1> other{BodyBox{{3, 0, 0.5}, 0.0, 0.8, 0.6, 0.55}};
  int seen = 0;
  for (const Eigen::Vector3f& p : lidar.scan(world, other, Pose3::level({0, 0, 0}, 0.0), 0.5, 1)) {
    const Eigen::Vector2d q = other[0].pose.inverse() * Eigen::Vector2d(p.x(), p.y());
    const bool on_border = std::abs(std::max(std::abs(q.x()) - 0.4, std::abs(q.y()) - 0.3)) < 1e-4;
    seen += on_border;
    EXPECT_TRUE(on_border || p.x() < 2.5 || std::abs(p.y()) > 0.5)
        << "nothing behind it is seen " << p.transpose();
  }
  EXPECT_GT(seen, 10);
  EXPECT_LT(seen, 40);
}

/// Distance straight ahead in the plane of a planar lidar 0.5 m above the ground at x = 0, without noise; 0:
/// nothing.
double ahead(std::span<const Box> boxes, double floor, std::span<const BodyBox> bodies = {}) {
  const World world = *make_box_world(boxes, floor, 3);
  const LidarPattern lidar(exact(LidarParams::planar()));
  for (const Eigen::Vector3f& p : lidar.scan(world, bodies, Pose3::level({0, 0, 0}, 0.0), 0.5, 1))
    if (std::abs(p.y()) < 1e-3 && p.x() > 0) {
      EXPECT_FLOAT_EQ(p.z(), 0.5f) << "in the lidar's plane";
      return p.x();
    }
  return 0.0;
}

TEST(PlanarLidar, FoldsItsRingsToOneReturnAColumn) {
  const LidarPattern lidar(LidarParams::planar());
  EXPECT_EQ(lidar.size(), 360u);
  EXPECT_EQ(lidar.scan(room(), {}, Pose3::level({0, 0, 0}, 0.0), 0.5, 1).size(), 360u);
}

TEST(PlanarLidar, SeesABodyOf40CentimetresFromFarToNear) {
  for (double x = 0.4; x < 3.6; x += 0.05) {
    const std::array<Box, 1> box{Box{x, x + 0.3, -1, 1, 0, 0.4}};
    EXPECT_NEAR(ahead(box, 0), x, 0.03) << "in the world";
    const std::array<BodyBox, 1> body{BodyBox{{x + 0.3, 0, 0}, 0.0, 0.6, 0.5, 0.4}};
    EXPECT_NEAR(ahead({}, 0, body), x, 0.01) << "a robot";
  }
}

TEST(PlanarLidar, SeesWhereADropBegins) {
  for (const double width : {1.5, 4.0, 30.0})
    for (double x = 0.35; x < 2.5; x += 0.05) {
      const std::array<Box, 2> ground{Box{-5, x, -3, 3, -1, 0}, Box{x + width, x + width + 5, -3, 3, -1, 0}};
      EXPECT_NEAR(ahead(ground, -1), x, 0.1) << width;
    }
}

TEST(PlanarLidar, GroundThatRisesAndFallsIsGround) {
  std::vector<Box> ramp;  // 12 %, up from x = 1 to 6 and down again
  for (double x = 1.0; x < 11.0; x += 0.05)
    ramp.push_back({x, x + 0.05, -3, 3, 0, 0.12 * std::min(x - 0.975, 11.025 - x)});
  const World world = *make_box_world(ramp, 0, 3);
  const LidarPattern lidar(LidarParams::planar());
  for (double x = -6.0; x < 12.0; x += 0.21) {
    const double z = std::max(0.0, 0.12 * std::min(x - 1.0, 11.0 - x));
    for (const Eigen::Vector3f& p : lidar.scan(world, {}, Pose3::level({x, 0, 0}, z), 0.5, 7)) {
      const bool near = p.head<2>().norm() < 5.0;  // farther off its foot is between two rays
      ASSERT_FALSE(near && std::abs(p.y()) < 2.0) << "from " << x << ": " << p.transpose();
    }
  }
}

TEST(PlanarLidar, SeesNothingBehindAnObstacle) {
  const std::array<Box, 2> boxes{Box{2, 2.2, -1, 1, 0, 3}, Box{3, 3.2, -0.2, 0.2, 0, 3}};
  EXPECT_NEAR(ahead(boxes, 0), 2.0, 1e-3);
}

TEST(Lidar, noise_has_the_deviation_asked_for) {
  const World world = room();
  LidarParams params = LidarParams::planar();
  params.columns = 4000;
  params.range_noise = 0.05;
  const auto noisy = LidarPattern(params).scan(world, {}, Pose3::level({0, 0, 0}, 0.0), 1.0, 9);
  const auto clean = LidarPattern(exact(params)).scan(world, {}, Pose3::level({0, 0, 0}, 0.0), 1.0, 9);
  ASSERT_EQ(noisy.size(), clean.size());
  double sum = 0, squares = 0;
  for (std::size_t n = 0; n < noisy.size(); ++n) {
    const double e = noisy[n].head<2>().norm() - clean[n].head<2>().norm();
    sum += e;
    squares += e * e;
  }
  const double count = static_cast<double>(noisy.size());
  EXPECT_NEAR(sum / count, 0.0, 0.003);
  EXPECT_NEAR(std::sqrt(squares / count), 0.05, 0.002);
}

TEST(Lidar, range_limits_and_open_space) {
  LidarParams params = exact(LidarParams::planar());
  params.max_range = 4.0;
  for (const Eigen::Vector3f& p : LidarPattern(params).scan(room(), {}, Pose3::level({0, 0, 0}, 0), 1.0, 1))
    EXPECT_LE(p.head<2>().norm(), 4.0);
  params.min_range = 3.5;
  for (const Eigen::Vector3f& p : LidarPattern(params).scan(room(), {}, Pose3::level({0, 0, 0}, 0), 1.0, 1))
    EXPECT_GE(p.head<2>().norm(), 3.5);
  EXPECT_TRUE(
      LidarPattern(params).scan(*make_box_world({}, 0, 3), {}, Pose3::level({0, 0, 0}, 0), 1.0, 1).empty());
}

TEST(Lidar, same_seed_same_scan_on_every_thread) {
  const World world = room();
  const LidarPattern lidar{LidarParams{}};
  const auto scan = [&](std::uint64_t seed) {
    return lidar.scan(world, {}, Pose3::level({1, 1, 1}, 0), 0.5, seed);
  };
  const PointCloud first = scan(4);
  std::array<PointCloud, 3> others;
  std::vector<std::thread> threads;
  for (PointCloud& out : others) threads.emplace_back([&] { out = scan(4); });
  for (std::thread& t : threads) t.join();
  for (const PointCloud& other : others) EXPECT_TRUE(first == other);
  EXPECT_FALSE(first == scan(5));
}

TEST(Noise, gaussian_has_mean_0_and_deviation_1) {
  Random random(1);
  double sum = 0, squares = 0;
  constexpr int count = 200000;
  int beyond_two = 0;
  for (int n = 0; n < count; ++n) {
    const double g = gaussian(random);
    sum += g;
    squares += g * g;
    beyond_two += std::abs(g) > 2.0;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.01);
  EXPECT_NEAR(squares / count, 1.0, 0.01);
  EXPECT_NEAR(beyond_two / static_cast<double>(count), 0.045, 0.008);
}

}  // namespace
}  // namespace adit::sim
