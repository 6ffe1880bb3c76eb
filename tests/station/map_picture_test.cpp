// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/picture.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "basestation/map/top_view.hpp"
#include "basestation/map/trails.hpp"
#include "tests/folders/folders.hpp"

namespace adit::station {
namespace {

using perception::CoarseBlock;
using CellKind = TopView::Kind;

/// Ground of 2.4 x 0.8 m at z 0; on its right third a wall of 2.4 m, in its middle a thing of 0.6 m.
perception::VoxelImage some_image() {
  constexpr std::uint64_t layer = 0xffff, all = ~std::uint64_t{0};
  std::vector<CoarseBlock> blocks{{{0, 0, 0}, all, layer},
                                  {{1, 0, 0}, all, layer | layer << 16 | layer << 32},
                                  {{2, 0, 0}, all, all},
                                  {{2, 0, 1}, all, all},
                                  {{2, 0, 2}, all, all}};
  perception::VoxelImage image(0.2);
  image.add(Pose3{}, blocks);
  return image;
}

TEST(TopView, TellsGroundFromLowThingsAndWalls) {
  const TopView view(some_image());
  ASSERT_EQ(view.nx(), 12);
  ASSERT_EQ(view.ny(), 4);
  EXPECT_EQ(view.at(1, 1).kind, CellKind::ground);
  EXPECT_EQ(view.at(5, 1).kind, CellKind::low);
  EXPECT_EQ(view.at(9, 1).kind, CellKind::high);
  EXPECT_EQ(view.at(9, 1).height, 12);
}

TEST(TopView, AFlatMapOfAPlanarLidarShowsItsWalls) {
  perception::VoxelImage image(0.2);
  image.add(Pose3{}, std::vector<CoarseBlock>{{{0, 0, 0}, 0xff, 0x01}});
  const TopView view(image);
  EXPECT_EQ(view.at(0, 0).kind, CellKind::high);
  EXPECT_EQ(view.at(1, 1).kind, CellKind::ground);
}

TEST(MapPicture, IsWrittenAsAWhole) {
  const std::string file = scratch_folder() + "/map.png";
  MapPicture picture{.title = "a map", .subtitle = "of a test"};
  picture.robots.push_back(
      {.name = "r1", .label = "wheeled", .trail = {{0, 0, 0}, {1, 0.3, 0}}, .now = {1, 0.3, 0}});
  ASSERT_TRUE(write_map_picture(some_image(), picture, file).ok());
  EXPECT_GT(std::filesystem::file_size(file), 1000U);
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
}

TEST(MapPicture, SaysWhyItCannotBeWritten) {
  EXPECT_EQ(write_map_picture(perception::VoxelImage(0.2), {}, "/nowhere/map.png").reason(),
            Reason::map_empty);
  EXPECT_EQ(write_map_picture(some_image(), {}, "/nowhere/map.png").reason(), Reason::cannot_write);
  EXPECT_EQ(write_map_picture(some_image(), {}, "/dev/full/map.png").reason(), Reason::cannot_write);
}

TEST(Trails, StayBoundedAndKeepBothEnds) {
  Trails trails;
  for (int i = 0; i <= 100'000; ++i) trails.add("r1", {i * 0.1, 0, 0});
  const Trails::Trail& trail = trails.all().at("r1");
  EXPECT_LE(trail.points.size(), Trails::kMaxPoints);
  EXPECT_GT(trail.points.size(), 1000U);
  EXPECT_EQ(trail.points.front().x, 0.0);
  EXPECT_EQ(trail.now.x, 10'000.0);
  for (int i = 0; i < 1000; ++i) trails.add("robot" + std::to_string(i), {});
  EXPECT_LE(trails.all().size(), Trails::kMaxRobots);
}

}  // namespace
}  // namespace adit::station
