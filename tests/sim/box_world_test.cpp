// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "sim/world/world.hpp"
#include "tests/sim/scratch.hpp"

namespace adit::sim {
namespace {

double cast(const World& world, const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  return world.grid().cast(world.grid().locate(from), direction.normalized(), 30.0);
}

TEST(BoxWorld, boxes_stand_where_they_were_put) {
  const std::array<Box, 2> boxes{Box{2, 2.1, -1, 1, 0, 3}, Box{-3.15, -3, -1, 1, 0.7, 0.8}};
  const auto world = make_box_world(boxes, 0, 3);
  ASSERT_TRUE(world) << world.error().text;
  EXPECT_NEAR(cast(*world, {0, 0, 0.5}, {1, 0, 0}), 2.0, 1e-9);
  EXPECT_NEAR(cast(*world, {0, 0, 0.75}, {-1, 0, 0}), 3.0, 1e-9) << "the edge of the table";
  EXPECT_TRUE(std::isinf(cast(*world, {0, 0, 0.5}, {-1, 0, 0}))) << "below it";
  EXPECT_TRUE(std::isinf(cast(*world, {0, 1.01, 0.5}, {1, 0, 0}))) << "beside the wall";
  EXPECT_NEAR(cast(*world, {0, 0, 0.5}, {0, 0, 1}), 2.5, 1e-9) << "the ceiling";
  EXPECT_EQ(cast(*world, {50, 0, 0.5}, {-1, 0, 0}), VoxelGrid::kNoHit);
  EXPECT_NEAR(cast(*world, {12, 0, 0.5}, {-1, 0, 0}), 9.9, 1e-9) << "from beside the grid";
}

TEST(BoxWorld, ground_is_the_lowest_floor_with_headroom) {
  const std::array<Box, 3> boxes{Box{0, 1, 0, 1, 0, 0.15}, Box{2, 3, 0, 1, 0.6, 0.7}, Box{4, 5, 0, 1, 0, 3}};
  const auto world = make_box_world(boxes, 0, 3);
  ASSERT_TRUE(world);
  EXPECT_NEAR(*world->ground_height(0.5, 0.5, 0.5), 0.15, 1e-9);
  EXPECT_NEAR(*world->ground_height(2.5, 0.5, 0.5), 0.0, 1e-9) << "under the table";
  EXPECT_NEAR(*world->ground_height(2.5, 0.5, 0.65), 0.7, 1e-9) << "on it";
  EXPECT_EQ(world->ground_height(4.5, 0.5, 0.5).reason(), Reason::out_of_range) << "in the wall";
  EXPECT_NEAR(*world->ground_height(400, 0, 0.5), 0.0, 1e-9) << "the endless room";
  EXPECT_EQ(world->ground_height(400, 0, 3.5).reason(), Reason::out_of_range);
  EXPECT_FALSE(world->ground_height(std::nan(""), 0, 0.5));
}

TEST(BoxWorld, refuses_boxes_turned_inside_out) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const std::array<Box, 2> second_bad{Box{0, 1, 0, 1, 0, 1}, Box{1, 0, 0, 1, 0, 1}};
  const auto turned = make_box_world(second_bad, 0, 3);
  EXPECT_EQ(turned.reason(), Reason::bad_argument);
  EXPECT_NE(turned.error().text.find("box 2"), std::string::npos);
  for (const Box& box : {Box{0, inf, 0, 1, 0, 1}, Box{0, std::nan(""), 0, 1, 0, 1}, Box{0, 1, 0, 0, 0, 1}})
    EXPECT_EQ(make_box_world(std::span(&box, 1), 0, 3).reason(), Reason::bad_argument);
  EXPECT_EQ(make_box_world({}, 3, 3).reason(), Reason::bad_argument);
  const Box huge{-9000, 9000, -9000, 9000, 0, 1};
  EXPECT_EQ(make_box_world(std::span(&huge, 1), 0, 3).reason(), Reason::bad_argument);
}

TEST(FindMap, takes_the_first_folder_that_has_it) {
  const Scratch scratch;
  std::filesystem::create_directories(scratch.path("a"));
  std::filesystem::create_directories(scratch.path("b"));
  scratch.write("b/map.bt", "x");
  const std::array<std::filesystem::path, 2> folders{scratch.path("a"), scratch.path("b")};
  EXPECT_EQ(*find_map("map.bt", folders), scratch.path("b/map.bt"));
  scratch.write("a/map.bt", "x");
  EXPECT_EQ(*find_map("map.bt", folders), scratch.path("a/map.bt"));
  EXPECT_EQ(*find_map(scratch.path("b/map.bt").string(), {}), scratch.path("b/map.bt"));
  const auto missing = find_map("other.bt", folders);
  EXPECT_EQ(missing.reason(), Reason::cannot_read);
  EXPECT_NE(missing.error().text.find("./run setup"), std::string::npos);
}

}  // namespace
}  // namespace adit::sim
