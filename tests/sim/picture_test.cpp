// SPDX-License-Identifier: Apache-2.0
#include "sim/picture/picture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "sim/picture/ground_plan.hpp"
#include "sim/world/read_file.hpp"
#include "tests/sim/scratch.hpp"

namespace adit::sim {
namespace {

World open_room() {
  const std::array<Box, 3> boxes{Box{0, 8, -0.2, 0, 0, 3}, Box{0, 8, 4, 4.2, 0, 3}, Box{3, 4, 1, 2, 0, 0.8}};
  return *make_box_world(boxes, 0, 3);
}

PictureSpec run() {
  PictureSpec spec;
  spec.title = "A room";
  spec.trails.push_back({"r1", "wheeled", {{1, 1, 0}, {1, 3, 0}, {6, 3, 0}}, 0.6, 0.5});
  spec.goals.push_back({"r1", {6, 3}});
  for (int n = 0; n < 60; ++n)
    spec.events.push_back({{2, 2}, std::to_string(n) + " happened at the same place as all else"});
  return spec;
}

TEST(Picture, the_same_run_gives_the_same_file) {
  const Scratch scratch;
  const World world = open_room();
  ASSERT_TRUE(write_picture(world, run(), scratch.path("a.png")));
  ASSERT_TRUE(write_picture(world, run(), scratch.path("b.png")));
  const std::string a = *read_file(scratch.path("a.png")), b = *read_file(scratch.path("b.png"));
  EXPECT_EQ(a.find("PNG"), 1u);
  EXPECT_TRUE(a == b);
  PictureSpec other = run();
  other.trails[0].poses.back().x = 5.0;
  ASSERT_TRUE(write_picture(world, other, scratch.path("c.png")));
  EXPECT_FALSE(a == *read_file(scratch.path("c.png")));
}

TEST(Picture, shows_people_where_they_walked) {
  const Scratch scratch;
  const World world = open_room();
  const auto drawn = [&](const char* name, std::vector<Pose2> poses) {
    PictureSpec spec = run();
    if (!poses.empty()) spec.people.push_back({std::move(poses), 0.45});
    EXPECT_TRUE(write_picture(world, spec, scratch.path(name)));
    return *read_file(scratch.path(name));
  };
  const std::string none = drawn("none.png", {}), here = drawn("here.png", {{5, 1, 0}, {5, 2, 0}}),
                    there = drawn("there.png", {{5, 1, 0}, {7, 2, 0}});
  EXPECT_FALSE(none == here);
  EXPECT_FALSE(here == there);
}

TEST(Picture, an_empty_run_is_a_map) {
  const Scratch scratch;
  PictureSpec spec;
  spec.width = 400;
  spec.trails.push_back({"r1", "never moved", {}, 0.6, 0.5});
  EXPECT_TRUE(write_picture(open_room(), spec, scratch.path("map.png")));
  EXPECT_TRUE(write_picture(*make_box_world({}, 0, 3), {}, scratch.path("empty.png")));
}

TEST(Picture, names_the_error) {
  const Scratch scratch;
  const auto nowhere = write_picture(open_room(), run(), scratch.path("no/such/folder.png"));
  EXPECT_EQ(nowhere.reason(), Reason::cannot_write);
  EXPECT_NE(nowhere.error().text.find("folder.png"), std::string::npos);
  PictureSpec spec = run();
  spec.width = 10;
  EXPECT_EQ(write_picture(open_room(), spec, scratch.path("a.png")).reason(), Reason::bad_argument);
  spec = run();
  spec.trails[0].poses.push_back({std::numeric_limits<double>::infinity(), 0, 0});
  EXPECT_EQ(write_picture(open_room(), spec, scratch.path("a.png")).reason(), Reason::bad_argument);
}

TEST(GroundPlan, distinguishes_walls_from_furniture) {
  const World world = open_room();
  const GroundPlan plan = make_ground_plan(world, 0.5);
  const auto kind = [&](double x, double y) {
    return plan.at(world.grid().column_x(x), world.grid().column_y(y));
  };
  EXPECT_EQ(kind(1.02, 2.02), GroundPlan::floor);
  EXPECT_EQ(kind(1.02, 4.02), GroundPlan::wall);
  EXPECT_EQ(kind(3.02, 1.52), GroundPlan::furniture);
  EXPECT_EQ(kind(3.52, 1.52), GroundPlan::glimpsed) << "the middle of the table";
}

}  // namespace
}  // namespace adit::sim
