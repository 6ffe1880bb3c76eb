// SPDX-License-Identifier: Apache-2.0
#include "perception/map/voxel_image.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace adit::perception {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};

CoarseBlock full_block(const BlockIndex& index, Voxel voxel) {
  return {index, kAll, voxel == Voxel::occupied ? kAll : 0};
}

/// A wall of occupied voxels of 0.2 m at x in [0, 0.2), 8 m long and 0.8 m high.
std::vector<CoarseBlock> wall() {
  std::vector<CoarseBlock> blocks;
  std::uint64_t face = 0;
  for (int y = 0; y < 4; ++y)
    for (int z = 0; z < 4; ++z) face |= std::uint64_t{1} << (4 * y + 16 * z);
  for (int i = 0; i < 10; ++i) blocks.push_back({{0, i, 0}, kAll, face});
  return blocks;
}

Pose3 turned(double x, double y, double yaw) { return Pose3::level({x, y, yaw}, 0.0); }

TEST(VoxelImage, TakesASubmapWhereItIs) {
  VoxelImage image;
  EXPECT_TRUE(image.empty());
  image.add(turned(10, 0, 0),
            std::vector{full_block({0, 0, 0}, Voxel::occupied), full_block({1, 0, 0}, Voxel::free)});
  EXPECT_EQ(image.at(Eigen::Vector3d(10.1, 0.1, 0.1)), Voxel::occupied);
  EXPECT_EQ(image.at(Eigen::Vector3d(10.7, 0.7, 0.7)), Voxel::occupied);
  EXPECT_EQ(image.at(Eigen::Vector3d(10.9, 0.1, 0.1)), Voxel::free);
  EXPECT_EQ(image.at(Eigen::Vector3d(9.9, 0.1, 0.1)), Voxel::unknown);
  EXPECT_EQ(image.occupied_count(), 64u);
  EXPECT_EQ(image.free_count(), 64u);
  ASSERT_TRUE(image.bounds());
  EXPECT_EQ(image.bounds()->low, (VoxelIndex{50, 0, 0}));
  EXPECT_EQ(image.bounds()->high, (VoxelIndex{57, 3, 3}));
}

TEST(VoxelImage, ATurnedWallHasNoHoles) {
  for (const double yaw : {0.1, 0.5, M_PI / 4, 1.0, 2.2}) {
    VoxelImage image;
    image.add(turned(0.03, 0.07, yaw), wall());
    for (double s = 0.2; s < 7.8; s += 0.02) {
      const Eigen::Vector3d on = turned(0.03, 0.07, yaw) * Eigen::Vector3d(0.1, s, 0.3);
      bool near = false;
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
          near = near ||
                 image.at(Eigen::Vector3d(on.x() + 0.08 * dx, on.y() + 0.08 * dy, on.z())) == Voxel::occupied;
      EXPECT_TRUE(near) << yaw << ' ' << s;
    }
    // No hole in the free space beside it.
    for (double s = 0.4; s < 7.6; s += 0.05)
      EXPECT_NE(image.at(turned(0.03, 0.07, yaw) * Eigen::Vector3d(0.5, s, 0.3)), Voxel::unknown);
  }
}

TEST(VoxelImage, ASingleVoxelIsNotLostByATurn) {
  for (int n = 0; n < 40; ++n) {
    VoxelImage image;
    const Pose3 T = turned(0.013 * n, 0.007 * n, 0.04 * n);
    image.add(T, std::vector{CoarseBlock{{0, 0, 0}, kAll, std::uint64_t{1} << 21}});
    EXPECT_GE(image.occupied_count(), 1u) << n;
    EXPECT_LE(image.occupied_count(), 4u) << n;
  }
}

TEST(VoxelImage, TheNewestSubmapWinsForFree) {
  VoxelImage image;
  image.add({}, std::vector{full_block({0, 0, 0}, Voxel::occupied)});
  image.add({}, std::vector{full_block({0, 0, 0}, Voxel::free)});
  EXPECT_EQ(image.at(Eigen::Vector3d(0.1, 0.1, 0.1)), Voxel::free);
}

TEST(VoxelImage, TwoThatAgreeWinForOccupiedUntilTwoNewerSayFree) {
  VoxelImage image;
  const std::vector occupied{full_block({0, 0, 0}, Voxel::occupied)},
      free{full_block({0, 0, 0}, Voxel::free)};
  image.add({}, occupied);
  image.add({}, occupied);
  image.add({}, free);
  EXPECT_EQ(image.at(Eigen::Vector3d(0.1, 0.1, 0.1)), Voxel::occupied);
  image.add({}, free);
  EXPECT_EQ(image.at(Eigen::Vector3d(0.1, 0.1, 0.1)), Voxel::free);
}

TEST(VoxelImage, OwnEyesOverrulePriorKnowledge) {
  VoxelImage prior(0.1);
  for (int x = 0; x < 8; ++x) prior.set({x, 0, 0}, Voxel::occupied);
  VoxelImage image;
  image.add(prior);
  EXPECT_EQ(image.at(Eigen::Vector3d(0.5, 0.1, 0.1)), Voxel::occupied);
  image.add({}, std::vector{full_block({0, 0, 0}, Voxel::free)});
  EXPECT_EQ(image.at(Eigen::Vector3d(0.5, 0.1, 0.1)), Voxel::free);
}

TEST(VoxelImage, GivesItselfAsBlocks) {
  VoxelImage image;
  image.add(turned(3, -2, 0.7), wall());
  VoxelImage again;
  again.add({}, image.coarse_blocks());
  EXPECT_EQ(again.occupied(), image.occupied());
  EXPECT_EQ(again.free_count(), image.free_count());
}

TEST(VoxelImage, ACoarserImageKeepsAllThatIsOccupied) {
  VoxelImage image(0.5);
  image.add({}, std::vector{CoarseBlock{{0, 0, 0}, kAll, 1}});
  EXPECT_EQ(image.at(Eigen::Vector3d(0.1, 0.1, 0.1)), Voxel::occupied);
}

TEST(VoxelImage, TakesAGridAtItsFullResolution) {
  SubmapGrid grid;
  grid.insert({0.05f, 0.05f, 0.05f}, std::vector<Eigen::Vector3f>{{2.05f, 0.05f, 0.05f}}, 20.0f);
  VoxelImage image(0.1);
  image.add({}, grid);
  EXPECT_EQ(image.occupied(), (std::vector<VoxelIndex>{{20, 0, 0}}));
  EXPECT_EQ(image.free_count(), 20u);
}

TEST(VoxelImage, LeavesOutPosesThatAreNoPlaces) {
  VoxelImage image;
  const std::vector blocks{full_block({0, 0, 0}, Voxel::occupied)};
  Pose3 bad;
  bad.position.x() = std::numeric_limits<double>::quiet_NaN();
  image.add(bad, blocks);
  bad.position.x() = 1e12;
  image.add(bad, blocks);
  EXPECT_FALSE(image.set({1 << 30, 0, 0}, Voxel::free));
  EXPECT_TRUE(image.empty());
  EXPECT_EQ(image.at(Eigen::Vector3d(1e300, 0, 0)), Voxel::unknown);
  EXPECT_FALSE(image.bounds());
}

}  // namespace
}  // namespace adit::perception
