// SPDX-License-Identifier: Apache-2.0
// All that is known of the selected robots, as rows.
#include <gmock/gmock.h>

#include <limits>

#include "basestation/gui/bridge/details.hpp"
#include "tests/gui/fixture.hpp"

namespace adit::gui {
namespace {

using testing::HasSubstr;

const Detail* find(const std::vector<Detail>& rows, const std::string& label) {
  for (const Detail& row : rows)
    if (row.label == label) return &row;
  return nullptr;
}

std::string value(const std::vector<Detail>& rows, const std::string& label) {
  const Detail* row = find(rows, label);
  return row ? row->value : "(none)";
}

TEST(Details, OfOneRobotAreItsStatus) {
  const auto rows = details_of(ten_robots(), {"r4"}, 0.0);
  EXPECT_EQ(value(rows, "holder"), "you, locked");
  EXPECT_THAT(value(rows, "mode"), HasSubstr("waypoint: "));
  EXPECT_EQ(value(rows, "goal"), "blocked: 20.0 -2.0, 4.0 m away");
  EXPECT_EQ(value(rows, "place"), "x 16.0  y -2.0  z 0.0 m, heading 0 degrees");
  EXPECT_EQ(value(rows, "size"), "0.90 x 0.60 x 0.50 m");
  EXPECT_EQ(value(rows, "convoy"), "(none)");
  EXPECT_EQ(value(details_of(ten_robots(), {"r5"}, 2.0), "heard"), "49 s ago, LOST");
}

TEST(Details, OfSeveralRobotsAreOnceWhereTheyAreTheSame) {
  const auto rows = details_of(ten_robots(), {"r1", "r2"}, 0.0);
  EXPECT_EQ(value(rows, "holder"), "you");
  EXPECT_FALSE(find(rows, "holder")->differs);
  EXPECT_EQ(value(rows, "kind"), "r1: wheeled  ·  r2: legged");
  EXPECT_TRUE(find(rows, "kind")->differs);
  EXPECT_EQ(value(rows, "stopped by"), "r2: op2") << "what one robot alone has names it";
  for (const Detail& row : rows) EXPECT_EQ(row.action, DetailAction{}) << row.label;
}

TEST(Details, WithoutASelectionAreTheSumsOfAllRobots) {
  const auto rows = details_of(ten_robots(), {}, 0.0);
  EXPECT_EQ(value(rows, "robots"), "10");
  EXPECT_EQ(value(rows, "yours"), "5");
  EXPECT_EQ(value(rows, "lost"), "1");
  EXPECT_EQ(value(details_of({}, {"r1"}, 0.0), "robots"), "0") << "a robot that is not known is none";
}

TEST(Details, OfferWhatTheRobotsOwnWordWouldChange) {
  station::World world = ten_robots();
  EXPECT_EQ(find(details_of(world, {"r1"}, 0.0), "make way")->action.line, "yield r1 on");
  world.robots[0].yields = true;
  EXPECT_EQ(find(details_of(world, {"r1"}, 0.0), "make way")->action.line, "yield r1 off");
  EXPECT_EQ(value(details_of(world, {"r1"}, 0.0), "make way"), "allowed");
  EXPECT_EQ(find(details_of(world, {"r3"}, 0.0), "make way"), nullptr) << "op2 holds it";
}

TEST(Details, HandARobotOverToAStationThatIsHeard) {
  station::World world = ten_robots();
  const Detail grant = *find(details_of(world, {"r1"}, 0.0), "hand to op2");
  EXPECT_EQ(grant.action.line, "grant r1 op2");
  EXPECT_TRUE(grant.action.hold);
  EXPECT_EQ(find(details_of(world, {"r8"}, 0.0), "hand to op2"), nullptr) << "it is not mine";
  world.stations[1].lost = true;
  EXPECT_EQ(find(details_of(world, {"r1"}, 0.0), "hand to op2")->action.line, "");
}

TEST(Details, RemoveAnAreaOnlyByANameThatIsOne) {
  station::World world = ten_robots();
  world.robots[0].areas = {{.name = "shaft", .kind = AreaKind::keep_out},
                           {.name = "a --all; stop", .kind = AreaKind::keep_in}};
  const auto rows = details_of(world, {"r1"}, 0.0);
  EXPECT_EQ(find(rows, "area shaft")->action.line, "area r1 remove shaft");
  EXPECT_EQ(find(rows, "area a --all; stop")->action.line, "");
}

TEST(Details, SayNothingOfValuesThatMeanNothing) {
  station::World world = ten_robots();
  world.robots[0].x = 1e30F;
  world.robots[0].battery = std::numeric_limits<float>::quiet_NaN();
  world.robots[0].age = std::numeric_limits<double>::infinity();
  const auto rows = details_of(world, {"r1"}, 0.0);
  EXPECT_THAT(value(rows, "place"), HasSubstr("x -"));
  EXPECT_EQ(value(rows, "battery"), "- %");
  EXPECT_EQ(value(rows, "heard"), "- ago");
}

}  // namespace
}  // namespace adit::gui
