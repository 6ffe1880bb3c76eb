// SPDX-License-Identifier: Apache-2.0
#include "perception/map/submap_grid.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <cmath>
#include <limits>
#include <random>

namespace adit::perception {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// A scan of the inside of a room, 8 m x 6 m x 2.4 m, with the sensor 0.5 m above the floor.
Points room_scan(const Eigen::Vector3f& origin, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0f, 0.02f);
  const Eigen::Vector3f low(-4.03f, -3.02f, -0.53f), high(4.01f, 3.04f, 1.93f);
  Points points;
  for (int ring = 0; ring < 16; ++ring)
    for (int column = 0; column < 300; ++column) {
      const float elevation = (-15.0f + 2.0f * static_cast<float>(ring)) * static_cast<float>(M_PI) / 180.0f;
      const float azimuth = static_cast<float>(column) * static_cast<float>(M_PI) / 150.0f;
      const Eigen::Vector3f ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      float range = 1e9f;
      for (int axis = 0; axis < 3; ++axis) {
        const float wall = ray[axis] > 0 ? high[axis] : low[axis];
        if (std::abs(ray[axis]) > 1e-6f) range = std::min(range, (wall - origin[axis]) / ray[axis]);
      }
      points.push_back(origin + ray * (range + noise(random)));
    }
  return points;
}

TEST(SubmapGrid, HitsAtTheEndOfARayAndFreesTheWay) {
  SubmapGrid grid;
  EXPECT_EQ(grid.at({1.0f, 0.0f, 0.0f}), Voxel::unknown);
  const Points points{{2.05f, 0.05f, 0.05f}};
  grid.insert({0.05f, 0.05f, 0.05f}, points, 20.0f);
  EXPECT_EQ(grid.at({2.05f, 0.05f, 0.05f}), Voxel::occupied);
  for (float x = 0.05f; x < 1.96f; x += 0.1f) EXPECT_EQ(grid.at({x, 0.05f, 0.05f}), Voxel::free) << x;
  EXPECT_EQ(grid.at({2.15f, 0.05f, 0.05f}), Voxel::unknown);
  EXPECT_EQ(grid.at({1.0f, 0.15f, 0.05f}), Voxel::unknown);
  EXPECT_EQ(grid.revision(), 1u);
}

TEST(SubmapGrid, FreesUpToTheRangeWithoutAnEnd) {
  SubmapGrid grid;
  grid.insert({0.05f, 0.05f, 0.05f}, Points{{-30.0f, 0.05f, 0.05f}}, 5.0f);
  EXPECT_EQ(grid.at({-4.85f, 0.05f, 0.05f}), Voxel::free);
  EXPECT_EQ(grid.at({-5.15f, 0.05f, 0.05f}), Voxel::unknown);
  EXPECT_EQ(grid.at({-30.0f, 0.05f, 0.05f}), Voxel::unknown);
}

TEST(SubmapGrid, MoversFreeAndNeverOccupy) {
  SubmapGrid grid;
  const Points points{{2.05f, 0.05f, 0.05f}, {0.05f, 2.05f, 0.05f}};
  grid.insert({0.05f, 0.05f, 0.05f}, points, 20.0f, std::vector<std::uint8_t>{1, 0});
  EXPECT_NE(grid.at(points[0]), Voxel::occupied);
  EXPECT_EQ(grid.at({1.05f, 0.05f, 0.05f}), Voxel::free);
  EXPECT_EQ(grid.at(points[1]), Voxel::occupied);
}

TEST(SubmapGrid, AHitOutweighsTheRaysThatPassInTheSameScan) {
  SubmapGrid grid;
  Points points{{1.05f, 0.05f, 0.05f}};
  for (int i = 0; i < 20; ++i) points.push_back({3.0f + 0.1f * static_cast<float>(i), 0.05f, 0.05f});
  grid.insert({0.05f, 0.05f, 0.05f}, points, 20.0f);
  EXPECT_EQ(grid.at({1.05f, 0.05f, 0.05f}), Voxel::occupied);
}

TEST(SubmapGrid, ObstacleThatLeftIsFreeAfterTwoMissesPerHit) {
  SubmapGrid grid;
  const Eigen::Vector3f origin(0.05f, 0.05f, 0.05f), thing(2.05f, 0.05f, 0.05f);
  grid.insert(origin, Points{thing}, 20.0f);
  int scans = 0;
  while (grid.at(thing) == Voxel::occupied && scans < 10) {
    grid.insert(origin, Points{{5.05f, 0.05f, 0.05f}}, 20.0f);
    ++scans;
  }
  EXPECT_EQ(scans, 3);
}

TEST(SubmapGrid, LeavesOutPointsThatAreNoPlaces) {
  SubmapGrid grid;
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  grid.insert({0, 0, 0}, Points{{nan, 0, 0}, {0, inf, 0}, {1e30f, 0, 0}, {1.05f, 0.05f, 0.05f}}, 20.0f);
  EXPECT_EQ(grid.at({1.05f, 0.05f, 0.05f}), Voxel::occupied);
  const std::uint32_t before = grid.revision();
  grid.insert({nan, 0, 0}, Points{{1, 0, 0}}, 20.0f);
  grid.insert({1e9f, 0, 0}, Points{{1e9f + 1000, 0, 0}}, 20.0f);
  grid.insert({0, 0, 0}, Points{{3, 0, 0}}, nan);
  grid.insert({0, 0, 0}, Points{}, 20.0f);
  EXPECT_EQ(grid.revision(), before);
  EXPECT_EQ(grid.at({nan, 0, 0}), Voxel::unknown);
  EXPECT_EQ(grid.at({1e30f, 0, 0}), Voxel::unknown);
}

TEST(SubmapGrid, CoarseVoxelsAreOccupiedWhenAnyPartIsAndFreeWhenNearlyAllAre) {
  SubmapGrid grid;
  // Four rays along the four lines of a voxel of 0.2 m; a fifth one through one part of its neighbour.
  const Eigen::Vector3f origin(0.05f, 0.05f, 0.05f);
  for (const float y : {0.05f, 0.15f})
    for (const float z : {0.05f, 0.15f}) grid.insert({0.05f, y, z}, Points{{0.75f, y, z}}, 20.0f);
  grid.insert(origin, Points{{0.05f, 0.75f, 0.05f}}, 20.0f);
  const auto block = grid.coarse({0, 0, 0});
  ASSERT_TRUE(block);
  EXPECT_EQ(block->at(0, 0, 0), Voxel::free);
  EXPECT_EQ(block->at(3, 0, 0), Voxel::occupied);
  EXPECT_EQ(block->at(0, 1, 0), Voxel::unknown);
  EXPECT_FALSE(grid.coarse({1, 0, 0}));
  EXPECT_FALSE(grid.coarse({1 << 20, 0, 0}));
  const auto fine = grid.fine({0, 0, 0});
  ASSERT_TRUE(fine);
  EXPECT_EQ(fine->at(7, 0, 0), Voxel::occupied);
  EXPECT_EQ(fine->at(6, 0, 0), Voxel::free);
  EXPECT_EQ(fine->at(0, 2, 0), Voxel::free);
  EXPECT_EQ(fine->at(1, 2, 0), Voxel::unknown);
}

TEST(SubmapGrid, TheCoarseMasksAreThoseOfTheFineOnes) {
  SubmapGrid grid;
  for (unsigned n = 0; n < 4; ++n) grid.insert({0, 0, 0}, room_scan({0, 0, 0}, n), 20.0f);
  grid.for_each_block([&](const BlockIndex& index, std::uint32_t) {
    const CoarseBlock coarse = *grid.coarse(index);
    const FineBlock fine = *grid.fine(index);
    for (int place = 0; place < 64; ++place) {
      const int x = place % 4, y = place / 4 % 4, z = place / 16;
      int free = 0, occupied = 0;
      for (int part = 0; part < 8; ++part) {
        const Voxel voxel = fine.at(2 * x + part % 2, 2 * y + part / 2 % 2, 2 * z + part / 4);
        free += voxel == Voxel::free;
        occupied += voxel == Voxel::occupied;
      }
      const Voxel expected = occupied > 0 ? Voxel::occupied : free >= 7 ? Voxel::free : Voxel::unknown;
      ASSERT_EQ(coarse.at(x, y, z), expected) << index.x << ' ' << index.y << ' ' << index.z << ' ' << place;
    }
  });
}

TEST(SubmapGrid, ChangedSinceListsTheBlocksWhoseMasksChanged) {
  SubmapGrid grid;
  const Eigen::Vector3f origin(0.05f, 0.05f, 0.05f);
  const auto insert_bundle = [&] {
    for (const float y : {0.05f, 0.15f})
      for (const float z : {0.05f, 0.15f}) grid.insert({0.05f, y, z}, Points{{2.05f, y, z}}, 20.0f);
  };
  insert_bundle();
  EXPECT_EQ(grid.changed_since(0), (std::vector<BlockIndex>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  const std::uint32_t first = grid.revision();
  insert_bundle();
  EXPECT_GT(grid.revision(), first);  // Surer, but the masks are the same.
  EXPECT_TRUE(grid.changed_since(first).empty());
  grid.insert(origin, Points{{0.05f, -1.05f, 0.05f}}, 20.0f);
  // One ray frees no voxel of 0.2 m.
  EXPECT_EQ(grid.changed_since(first), (std::vector<BlockIndex>{{0, -2, 0}}));
}

TEST(SubmapGrid, FreeBlocksShrinkAndGrowAgain) {
  SubmapGrid grid;
  Points wall;  // Rays fill the blocks before the wall.
  for (float y = -2.0f; y < 2.0f; y += 0.02f)
    for (float z = -2.0f; z < 2.0f; z += 0.02f) wall.push_back({4.05f, y, z});
  grid.insert({0.05f, 0.05f, 0.05f}, wall, 20.0f);
  const std::size_t before = grid.bytes();
  SubmapGrid twice;
  for (int n = 0; n < 12; ++n) twice.insert({0.05f, 0.05f, 0.05f}, wall, 20.0f);
  // The pool keeps its memory; another surface takes it over, and what is hit in a free block is known.
  EXPECT_LE(twice.bytes(), before + 4096);
  EXPECT_EQ(twice.at({2.85f, 0.05f, 0.05f}), Voxel::free);
  for (int n = 0; n < 3; ++n) twice.insert({0.05f, 0.05f, 0.05f}, Points{{2.85f, 0.05f, 0.05f}}, 20.0f);
  EXPECT_EQ(twice.at({2.85f, 0.05f, 0.05f}), Voxel::occupied);
  EXPECT_EQ(twice.at({2.75f, 0.05f, 0.05f}), Voxel::free);
}

TEST(SubmapGrid, GrazingRayDoesNotFreeTheGroundNextToItsEnd) {
  SubmapGrid grid;
  const Eigen::Vector3f origin(0.05f, 0.05f, 0.55f), ground(4.05f, 0.05f, 0.05f), before(3.95f, 0.05f, 0.05f);
  for (int n = 0; n < 2; ++n) grid.insert(origin, Points{before}, 20.0f);
  ASSERT_EQ(grid.at(before), Voxel::occupied);
  for (int n = 0; n < 12; ++n) grid.insert(origin, Points{ground}, 20.0f);
  EXPECT_EQ(grid.at(before), Voxel::occupied);
}

TEST(SubmapGrid, EqualsOctoMap) {
  SubmapGrid grid;
  octomap::OcTree tree(0.1);
  for (unsigned n = 0; n < 12; ++n) {
    const Eigen::Vector3f origin(-1.5f + 0.25f * static_cast<float>(n), 0.1f, 0.02f);
    const Points points = room_scan(origin, n);
    grid.insert(origin, points, 3.5f);
    octomap::Pointcloud cloud;
    for (const Eigen::Vector3f& p : points) cloud.push_back(p.x(), p.y(), p.z());
    tree.insertPointCloud(cloud, octomap::point3d(origin.x(), origin.y(), origin.z()), 3.5);
  }
  tree.expand();
  std::size_t theirs = 0, equal = 0, ours = 0;
  for (auto it = tree.begin_leafs(); it != tree.end_leafs(); ++it, ++theirs) {
    const Voxel kind = tree.isNodeOccupied(*it) ? Voxel::occupied : Voxel::free;
    equal += grid.at({static_cast<float>(it.getX()), static_cast<float>(it.getY()),
                      static_cast<float>(it.getZ())}) == kind;
  }
  grid.for_each_block([&](const BlockIndex& index, std::uint32_t) {
    const auto fine = grid.fine(index);
    for (const std::uint64_t layer : fine->known) ours += static_cast<std::size_t>(std::popcount(layer));
  });
  EXPECT_GT(theirs, 20000u);
  EXPECT_GE(static_cast<double>(equal), 0.99 * static_cast<double>(theirs));
  EXPECT_GE(static_cast<double>(equal), 0.99 * static_cast<double>(ours));
  EXPECT_LT(2 * grid.bytes(), tree.memoryUsage());
}

TEST(SubmapGrid, TheSameScansMakeTheSameGrid) {
  const auto digest = [] {
    SubmapGrid grid;
    for (unsigned n = 0; n < 3; ++n) grid.insert({0, 0, 0}, room_scan({0, 0, 0}, n), 20.0f);
    std::uint64_t sum = grid.revision();
    grid.for_each_block([&](const BlockIndex& index, std::uint32_t revision) {
      const auto fine = grid.fine(index);
      for (const std::uint64_t layer : fine->occupied) sum = sum * 31 + layer;
      sum = sum * 31 + revision;
    });
    return sum;
  };
  EXPECT_EQ(digest(), digest());
}

TEST(SubmapGrid, RandomScansStayWithinTheirBounds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> near(-6.0f, 6.0f), far(-300.0f, 300.0f);
  SubmapGrid grid;
  for (int n = 0; n < 20; ++n) {
    Points points;
    for (int i = 0; i < 40; ++i) points.push_back({near(random), near(random), near(random)});
    points.push_back({far(random), far(random), far(random)});
    points.push_back(Eigen::Vector3f(0.8f, 1.6f, -0.8f));  // On the borders of blocks.
    const Eigen::Vector3f origin =
        n % 3 == 0 ? Eigen::Vector3f::Zero() : Eigen::Vector3f(near(random), 0.0f, near(random));
    grid.insert(origin, points, n % 2 == 0 ? 4.0f : 100.0f);
  }
  EXPECT_GT(grid.blocks(), 100u);
}

}  // namespace
}  // namespace adit::perception
