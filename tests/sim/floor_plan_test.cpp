// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "sim/world/noise.hpp"
#include "sim/world/pgm.hpp"
#include "sim/world/world.hpp"
#include "tests/sim/scratch.hpp"

namespace adit::sim {
namespace {

const std::string kYaml =
    "image: plan.pgm\nresolution: 0.5\norigin: [-1.0, 2.0, 0.0]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
// Four columns, three rows from the top: the left top corner is a wall, right of it free, then unknown grey.
const std::string kPlain = "P2\n# a comment\n4 3\n255\n0 254 205 254\n254 254 254 254\n254 254 254 0\n";

bool solid(const World& world, double x, double y) {
  return world.grid().solid(world.grid().column_x(x), world.grid().column_y(y), 0);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(FloorPlan, rows_run_from_the_top_and_unknown_is_solid) {
  const Scratch scratch;
  scratch.write("plan.pgm", kPlain);
  const auto world = load_floor_plan(scratch.write("map.yaml", kYaml));
  ASSERT_TRUE(world) << world.error().text;
  EXPECT_TRUE(solid(*world, -0.75, 3.25));
  EXPECT_FALSE(solid(*world, -0.25, 3.25));
  EXPECT_TRUE(solid(*world, 0.25, 3.25)) << "unknown";
  EXPECT_TRUE(solid(*world, 0.75, 2.25));
  EXPECT_NEAR(*world->ground_height(0.25, 2.75, 1.0), 0.0, 1e-9);
  EXPECT_FALSE(world->ground_height(-5.0, 2.75, 1.0)) << "beside the plan";
  const auto start = world->grid().locate({0.25, 2.25, 1.0});
  EXPECT_NEAR(world->grid().cast(start, {1, 0, 0}, 30.0), 0.25, 1e-9);
  EXPECT_NEAR(world->grid().cast(start, {-1, 0, 0}, 30.0), 1.25, 1e-9);
}

TEST(FloorPlan, negate_swaps_black_and_white) {
  const Scratch scratch;
  scratch.write("plan.pgm", kPlain);
  const auto world = load_floor_plan(scratch.write("map.yaml", replaced(kYaml, "negate: 0", "negate: 1")));
  ASSERT_TRUE(world) << world.error().text;
  EXPECT_FALSE(solid(*world, -0.75, 3.25));
  EXPECT_TRUE(solid(*world, -0.25, 3.25));
}

TEST(FloorPlan, names_the_error_and_its_place) {
  const Scratch scratch;
  scratch.write("plan.pgm", kPlain);
  const auto error = [&](const std::string& content) {
    const auto world = load_floor_plan(scratch.write("map.yaml", content));
    EXPECT_FALSE(world) << content;
    return world ? Error{Reason::none, ""} : world.error();
  };
  EXPECT_EQ(error(kYaml + "colour: red\n").reason, Reason::unknown_key);
  EXPECT_NE(error(kYaml + "colour: red\n").text.find("map.yaml:7"), std::string::npos);
  EXPECT_EQ(error(replaced(kYaml, "resolution: 0.5\n", "")).reason, Reason::missing_key);
  EXPECT_EQ(error(replaced(kYaml, "image: plan.pgm\n", "")).reason, Reason::missing_key);
  EXPECT_EQ(error(replaced(kYaml, "0.65", "much")).reason, Reason::wrong_type);
  EXPECT_EQ(error(replaced(kYaml, "0.65", "1.5")).reason, Reason::out_of_range);
  EXPECT_EQ(error(replaced(kYaml, "resolution: 0.5", "resolution: .nan")).reason, Reason::out_of_range);
  EXPECT_EQ(error(replaced(kYaml, "[-1.0, 2.0, 0.0]", "[-1.0, 2.0]")).reason, Reason::wrong_type);
  EXPECT_EQ(error(replaced(kYaml, "2.0, 0.0]", "2.0, 0.3]")).reason, Reason::not_supported);
  EXPECT_EQ(error(replaced(kYaml, "plan.pgm", "other.pgm")).reason, Reason::cannot_read);
  EXPECT_EQ(error("image: [").reason, Reason::syntax);
  EXPECT_EQ(error("- 1\n- 2\n").reason, Reason::wrong_type);
  EXPECT_EQ(error("").reason, Reason::wrong_type);
  EXPECT_EQ(error("mode: raw\n" + kYaml).reason, Reason::not_supported);
  EXPECT_EQ(load_floor_plan(scratch.path("none.yaml")).reason(), Reason::cannot_read);
}

TEST(Pgm, plain_and_raw_read_the_same) {
  const auto a = parse_pgm("P2 2 2 # sizes\n100\n0 50 100 7", "a");
  const auto b = parse_pgm(std::string_view("P5\n2 2\n100\n\0\x32\x64\x07", 16), "b");
  ASSERT_TRUE(a) << a.error().text;
  ASSERT_TRUE(b) << b.error().text;
  EXPECT_EQ(a->pixels, (std::vector<std::uint8_t>{0, 127, 255, 17}));
  EXPECT_EQ(a->pixels, b->pixels);
}

TEST(Pgm, refuses_damaged_files) {
  for (const std::string_view bad :
       {"", "P", "P2", "P2 2", "P2 2 2", "P2 2 2 255", "P2 2 2 255 1 2 3", "P2 2 2 255 1 2 3 256",
        "P2 0 2 255 1", "P2 -1 2 255 1", "P2 99999999999 2 255 1", "P2 60000 60000 255 1", "P2 2 2 0 1 2 3 4",
        "P5 2 2 255 abc", "P2 2 2 255 1 2 x 4", "P2 #", "P2 2 2 255 1 2 3 #"})
    EXPECT_FALSE(parse_pgm(bad, "bad")) << bad;
  EXPECT_EQ(parse_pgm("P6 1 1 255 abc", "x").reason(), Reason::not_supported);
  EXPECT_EQ(parse_pgm("P5 1 1 65535 ab", "x").reason(), Reason::not_supported);
  Random random(5);
  for (int round = 0; round < 2000; ++round) {
    std::string content = kPlain.substr(0, random.below(kPlain.size() + 1));
    if (!content.empty()) content[random.below(content.size())] = static_cast<char>(random.next());
    const auto image = parse_pgm(content, "fuzz");
    if (!image) continue;
    EXPECT_EQ(image->pixels.size(), static_cast<std::size_t>(image->width) * image->height);
  }
}

}  // namespace
}  // namespace adit::sim
