// SPDX-License-Identifier: Apache-2.0
#include "perception/map/floors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "perception/map/export/grid_file.hpp"

namespace adit::perception {
namespace {

/// A slab of ground with `air` voxels of free space above it, indices [x0, x1) and [y0, y1).
void slab(VoxelImage& image, int x0, int x1, int y0, int y1, int z, int air = 6) {
  for (int x = x0; x < x1; ++x)
    for (int y = y0; y < y1; ++y) {
      image.set({x, y, z}, Voxel::occupied);
      for (int up = 1; up <= air; ++up) image.set({x, y, z + up}, Voxel::free);
    }
}

TEST(Floors, AnEmptyMapHasNone) { EXPECT_TRUE(find_floors(VoxelImage{}).empty()); }

TEST(Floors, StoreysAreFloorsFromTheLowestUp) {
  VoxelImage image;
  slab(image, 0, 30, 0, 20, 15);
  slab(image, 0, 30, 0, 20, -1);
  const auto floors = find_floors(image);
  ASSERT_EQ(floors.size(), 2u);
  EXPECT_NEAR(floors[0].height, 0.0, 1e-9);
  EXPECT_NEAR(floors[1].height, 3.2, 1e-9);
  EXPECT_EQ(floors[0].ground.size(), 600u);
}

TEST(Floors, StairsBelongToOneFloorAndDoNotJoinTheNext) {
  VoxelImage image;
  slab(image, 0, 30, 0, 20, -1);
  slab(image, 0, 30, 0, 20, 15);
  for (int n = 0; n < 16; ++n) slab(image, 30 + n, 31 + n, 0, 6, n - 1);  // Up, beside both.
  slab(image, 30, 46, 6, 20, 15);
  const auto floors = find_floors(image);
  ASSERT_EQ(floors.size(), 2u);
  EXPECT_NEAR(floors[0].height, 0.0, 0.2 + 1e-9);
  EXPECT_GE(floors[1].ground.size(), 600u);
}

TEST(Floors, ARampIsOneFloor) {
  VoxelImage image;
  for (int x = 0; x < 100; ++x) slab(image, x, x + 1, 0, 15, x / 10);
  const auto floors = find_floors(image);
  ASSERT_EQ(floors.size(), 1u);
  EXPECT_EQ(floors[0].ground.size(), 1500u);
}

TEST(FloorPlan, ShowsWallsFreeGroundAndTheUnknown) {
  VoxelImage image;
  slab(image, 0, 20, 0, 20, -1);
  for (int y = 0; y < 20; ++y)
    for (int z = -1; z < 8; ++z) image.set({20, y, z}, Voxel::occupied);
  image.set({5, 5, 0}, Voxel::occupied);  // Lower than the band: robots drive over it.
  const auto plan = floor_plan(image, 0);
  ASSERT_TRUE(plan);
  const auto at = [&](int x, int y) {
    const int column = static_cast<int>(std::lround((x * 0.2 - plan->origin.x()) / 0.2));
    const int row = static_cast<int>(std::lround((y * 0.2 - plan->origin.y()) / 0.2));
    return plan->cells[static_cast<std::size_t>(column + row * plan->width)];
  };
  EXPECT_EQ(at(10, 10), FloorPlan::kFree);
  EXPECT_EQ(at(20, 10), FloorPlan::kOccupied);
  EXPECT_EQ(at(22, 10), FloorPlan::kUnknown);
  std::ostringstream pgm, yaml;
  ASSERT_TRUE(write_pgm(*plan, pgm));
  ASSERT_TRUE(write_map_yaml(*plan, "a \"b\".pgm", yaml));
  const std::string header =
      "P5\n" + std::to_string(plan->width) + " " + std::to_string(plan->height) + "\n255\n";
  EXPECT_EQ(pgm.str().substr(0, header.size()), header);
  EXPECT_EQ(pgm.str().size(), header.size() + plan->cells.size());
  EXPECT_NE(yaml.str().find("image: \"a \\\"b\\\".pgm\"\n"), std::string::npos);
  EXPECT_NE(yaml.str().find("resolution: 0.2\norigin: [-2, -2, 0]"), std::string::npos) << yaml.str();
  EXPECT_EQ(floor_plan(image, 1).reason(), Reason::out_of_range);
  EXPECT_EQ(floor_plan(VoxelImage{}, 0).reason(), Reason::map_empty);
}

}  // namespace
}  // namespace adit::perception
