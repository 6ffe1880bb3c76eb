// SPDX-License-Identifier: Apache-2.0
// What tabs show and settings files say, without Qt.
#include "basestation/gui/bridge/tables.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "basestation/gui/bridge/settings_file.hpp"
#include "basestation/model/found_file.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Tables, AMatrixHasAPlaceForEachComponentOfAnyRobot) {
  station::World world;
  world.robots.resize(2);
  world.robots[0].name = "r1";
  world.robots[0].mine = true;
  world.robots[1].name = "r2";
  world.robots[1].lost = true;
  station::HealthReport report;
  report.robots = {{.robot = "r1", .components = {{.name = "planner", .state = PartState::up}}},
                   {.robot = "r2", .components = {{.name = "map", .state = PartState::hung, .hung = 1}}}};
  const HealthTable table = health_table(report, world);
  EXPECT_THAT(table.columns, ElementsAre("planner", "map"));
  ASSERT_EQ(table.cells.size(), 6U);
  EXPECT_EQ(table.cells[1].text, "up, not well") << "a component that says that it is not healthy";
  EXPECT_EQ(table.cells[1].shape, "triangle");
  EXPECT_EQ(table.cells[2].text, "");
  EXPECT_EQ(table.cells[3].hint, "LOST");
  EXPECT_TRUE(table.cells[5].old);
  EXPECT_EQ(table.cells[5].hint, "1 thread");
  EXPECT_TRUE(health_detail(report, world, "r1", "planner").mine);
  EXPECT_FALSE(health_detail(report, world, "r2", "map").mine);
  EXPECT_THAT(health_detail(report, world, "r2", "map").text, HasSubstr("you do not hold the robot"));
  for (const char* part : {"driver", "store"}) {
    report.robots[0].components[0].name = part;
    EXPECT_FALSE(health_detail(report, world, "r1", part).mine) << part << " cannot be restarted";
    EXPECT_THAT(health_detail(report, world, "r1", part).text, HasSubstr("no command restarts it"));
  }
  EXPECT_EQ(health_detail(report, world, "r2", "planner").title, "");
  EXPECT_EQ(health_detail(report, world, "r9", "map").title, "");
}

TEST(Tables, NumbersThatAreNoneHaveNoBar) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  station::NetworkReport report;
  report.agents = {{.agent = "r1", .total_out = 1e30F}};
  report.links = {
      {.agent = "r1",
       .lost_from = kNan,
       .round_trip = kNan,
       .sender = station::SenderReport{.link = "x", .bandwidth = 8.0, .queue = kNan}},
      {.agent = "r2", .sender = station::SenderReport{.link = "y", .bandwidth = kNan, .queue = 0.0}}};
  const auto rows = network_rows(report, "op1");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].share, 1.0);
  EXPECT_LT(rows[1].share, 0.0);
  EXPECT_EQ(rows[1].budget, "no report yet");
}

TEST(Tables, ACsvHoldsItsCellsTogetherAndComputesNothing) {
  station::FoundReport report;
  report.findings = {{.number = 4, .robot = "r1", .kind = "=1+1", .text = "a \"b\", c", .note = "-x"}};
  EXPECT_THAT(station::found_csv(report), HasSubstr("4,\"r1\",\"\",\"'=1+1\",0,0.000,0.000,0.000,,open,"
                                                    "\"a \"\"b\"\", c\",\"'-x\",no,no\r\n"));
  report.findings[0].withdrawn = true;
  EXPECT_THAT(station::found_csv(report), HasSubstr("\"'-x\",yes,no\r\n"));
}

TEST(Tables, OnlyMarksOfThisStationCanBeRemoved) {
  station::FoundReport report;
  report.findings = {{.number = 1, .robot = "op1", .mark = true},
                     {.number = 2, .robot = "op2", .mark = true},
                     {.number = 3, .robot = "op1"},
                     {.number = 4, .robot = "op1", .withdrawn = true, .mark = true}};
  const auto rows = found_rows(report, "op1");
  EXPECT_TRUE(rows[0].removable);
  EXPECT_EQ(rows[0].robot, "op1 (mark)");
  for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_FALSE(rows[i].removable) << i;
}

TEST(Tables, APhotoIsNamedByThePartThatIsHere) {
  using station::PhotoHere;
  const auto words = [](PhotoHere here, std::uint8_t percent) {
    station::FoundReport report;
    report.findings = {{.number = 1, .photo = station::FoundPhoto{here, percent, 1000, "00ff"}}};
    return found_rows(report, "op1")[0].photo_state;
  };
  EXPECT_EQ(words(PhotoHere::none, 0), "none yet");
  EXPECT_EQ(words(PhotoHere::thumbnail, 0), "thumbnail");
  EXPECT_EQ(words(PhotoHere::thumbnail, 40), "40 %");
  EXPECT_EQ(words(PhotoHere::whole, 100), "whole");
  station::FoundReport without;
  without.findings = {{.number = 1}};
  EXPECT_EQ(found_rows(without, "op1")[0].photo_state, "");
}

TEST(Tables, ACaptionSaysWhatWhoWhereWhenAndWhichPart) {
  station::FoundItem item{.number = 2,
                          .robot = "r3",
                          .id = "00000000000000a2",
                          .kind = "person",
                          .position = {12, 4, 0.2},
                          .text = "sits at the wall",
                          .age = 75.0,
                          .photo = station::FoundPhoto{station::PhotoHere::thumbnail, 40, 1000, "00ff"}};
  const PhotoCaption caption = photo_caption(item);
  EXPECT_EQ(caption.title, "2  person");
  EXPECT_EQ(caption.text, "sits at the wall");
  EXPECT_EQ(caption.line, "found by r3   at 12.0 4.0 0.2   75 s ago   id 00000000000000a2");
  EXPECT_EQ(caption.state, "thumbnail, enlarged; 40 % of the photo is here");
  item.photo->here = station::PhotoHere::whole;
  item.age.reset();
  item.mark = true;
  EXPECT_EQ(photo_caption(item).state, "the whole photo");
  EXPECT_EQ(photo_caption(item).line,
            "marked by r3   at 12.0 4.0 0.2   at an unknown time   id 00000000000000a2");
  item.photo->here = station::PhotoHere::none;
  EXPECT_EQ(photo_caption(item).state, "its thumbnail is not here yet; 40 % of the photo is here");
}

TEST(Tables, FindingsThatAreWithdrawnAreGrey) {
  station::FoundReport report;
  report.findings = {{.number = 1, .withdrawn = true},
                     {.number = 2, .verdict = station::Verdict::confirmed, .withdrawn = true},
                     {.number = 3, .verdict = station::Verdict::confirmed}};
  const auto rows = found_rows(report, "op1");
  EXPECT_EQ(rows[0].token, Token::dim);
  EXPECT_EQ(rows[1].token, Token::dim);
  EXPECT_TRUE(rows[1].withdrawn);
  EXPECT_EQ(rows[2].token, Token::ok);
  EXPECT_FALSE(rows[2].withdrawn);
}

TEST(Tables, StaircasesSayWhoMayClimbThemAndWhyOthersMayNot) {
  station::StairsReport report;
  report.stairs = {{.number = 4,
                    .stairs = {.foot = {1, 2, 0.1},
                               .heading = -1.5707963,
                               .rise = 0.2,
                               .run = 0.3,
                               .width = 1.2,
                               .steps = 6,
                               .sigma = {.width = 0.05}},
                    .robots = {"r1", "r3"},
                    .fleet = {{.robot = "r1", .may = true}, {.robot = "r2", .reason = "climbs no stairs"}}},
                   {.number = 5, .verdict = station::Verdict::rejected}};
  const auto rows = stairs_rows(report);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0], (StairsRow{.number = 4,
                                .direction = "270°",
                                .turn = -180.0,
                                .steps = "6 steps",
                                .floors = "0.0 to 1.2 m",
                                .step = "rise 0.20 m, run 0.30 m",
                                .breadth = "width 1.20 ± 0.05 m",
                                .robots = "r1, r3",
                                .verdict = "new",
                                .climbers = "r1",
                                .others = "r2 climbs no stairs",
                                .token = Token::text}));
  EXPECT_EQ(rows[1].climbers, "no robot");
  EXPECT_EQ(rows[1].token, Token::dim);
}

TEST(Settings, ComeBackAsTheyWere) {
  for (const SettingsValues& values : {SettingsValues{}, SettingsValues{true, true, 1.25}}) {
    const SettingsRead read = read_settings(settings_text(values));
    EXPECT_EQ(read.values, values);
    EXPECT_THAT(read.problems, IsEmpty());
  }
  EXPECT_THAT(read_settings("").problems, IsEmpty());
}

TEST(Settings, WrongLinesAreNamedAndTheRestIsUsed) {
  const SettingsRead read = read_settings(
      "theme: light\n"
      "glove_mod: true\n"
      "scale: 40\n"
      "colour: red\n"
      "glove_mode: yes\n");
  EXPECT_TRUE(read.values.light);
  EXPECT_TRUE(read.values.glove);
  EXPECT_EQ(read.values.scale, 1.0);
  EXPECT_THAT(read.problems, ElementsAre("line 2: unknown setting 'glove_mod', did you mean glove_mode?",
                                         "line 3: scale is a number from 0.6 to 2.5, not 40",
                                         "line 4: unknown setting 'colour'"));
}

TEST(Settings, WhatIsNoSettingsFileDoesNoHarm) {
  for (const char* text :
       {"[1, 2]", "5", "theme: [", "theme: [a]", "scale: .nan", "scale: {a: b}", "glove_mode: maybe",
        "? [a]\n: b", "*a", "\x01\x02", "theme: &a {b: *a}", "- theme: dark"}) {
    const SettingsRead read = read_settings(text);
    EXPECT_EQ(read.values, SettingsValues{}) << text;
    ASSERT_FALSE(read.problems.empty()) << text;
    EXPECT_TRUE(read.problems[0].starts_with("line ")) << read.problems[0];
  }
}

}  // namespace
}  // namespace adit::gui
