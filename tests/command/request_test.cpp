// SPDX-License-Identifier: Apache-2.0
// What travels to a robot, and rows of every shape.
#include "core/command/request.hpp"

#include <gmock/gmock.h>

#include "core/command/parse.hpp"
#include "core/time/random.hpp"
#include "tests/command/later_commands.hpp"

namespace adit::command {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Result<Request> later(std::string_view line) { return parse(line, kLater); }

TEST(Request, ARectangleAndAPolygonWithOptions) {
  const auto area = later("area r1 r2 add shaft keep_in 0 0 4 0 4 4 --z -1 2.5 --weight 3");
  ASSERT_TRUE(area) << area.error().text;
  EXPECT_EQ(area->info->name, "area add");
  EXPECT_THAT(area->robots, ElementsAre("r1", "r2"));
  EXPECT_EQ(area->word("NAME"), "shaft");
  EXPECT_THAT(area->numbers("X Y"), ElementsAre(0, 0, 4, 0, 4, 4));
  EXPECT_THAT(area->numbers("--z"), ElementsAre(-1, 2.5));
  EXPECT_EQ(later("area r1 remove shaft")->info->name, "area remove");
  EXPECT_TRUE(later("area r1 add a prefer 0 0 1 1"));
}

TEST(Request, PolygonsHaveTwoToSixteenPoints) {
  EXPECT_EQ(later("area r1 add a keep_in 0 0").reason(), Reason::bad_argument);
  EXPECT_EQ(later("area r1 add a keep_in 0 0 1 1 2").reason(), Reason::bad_argument);
  std::string line = "area r1 add a keep_in";
  for (int i = 0; i < 16; ++i) line += " 1 2";
  EXPECT_TRUE(later(line));
  EXPECT_EQ(later(line + " 1 2").reason(), Reason::bad_argument);
  EXPECT_EQ(later("area r1 add a keep_in 0 nan 1 1").reason(), Reason::bad_argument);
  EXPECT_THAT(later("area r1 shaft").error().text, HasSubstr("add or remove is missing"));
}

TEST(Request, OtherShapes) {
  EXPECT_THAT(later("convoy start r1 r2 r3 --gap 2 --speed 0.5")->robots, ElementsAre("r1", "r2", "r3"));
  EXPECT_FALSE(later("convoy start r1"));
  EXPECT_EQ(later("convoy stop r1")->info->name, "convoy stop");
  EXPECT_EQ(later("explore r1 r2 --area shaft --after home --for 60")->word("--after"), "home");
  EXPECT_FALSE(later("explore r1 --after never"));
  EXPECT_EQ(later("map save x.bt --robot r1 --resolution 0.1")->word("FILE"), "x.bt");
  EXPECT_TRUE(later("map status"));
  EXPECT_EQ(later("camera r1 shot x.jpg")->info->name, "camera shot");
  EXPECT_TRUE(std::isinf(later("goto r1 1 2 --nearest --budget none")->number("--budget")));
  EXPECT_EQ(later("goto r1 1 2 --budget 20")->number("--budget"), 20.0);
  EXPECT_EQ(usage(kLater[2]),
            "area R... add NAME keep_in|keep_out|prefer X0 Y0 X1 Y1 [X2 Y2 ...] [--z Z0 Z1] [--weight W]");
  EXPECT_EQ(usage(kLater[11]), "goto R X Y [Z] [--nearest] [--budget M|none]");
}

/// Everything but the robots comes through.
void expect_round_trip(const Request& request, Table rows) {
  const auto back = unpack(pack(request), rows);
  ASSERT_TRUE(back) << request.info->name << ": " << back.error().text;
  EXPECT_EQ(back->info, request.info);
  EXPECT_EQ(back->verb, request.verb);
  std::size_t sent = 0;
  for (const ArgumentValue& value : request.values) {
    if (const auto local = std::find_if(request.info->options.begin(), request.info->options.end(),
                                        [&](const Option& o) { return o.name == value.name && o.local; });
        local != request.info->options.end())
      continue;
    ++sent;
    ASSERT_TRUE(back->has(value.name)) << value.name;
    EXPECT_EQ(back->find(value.name)->words, value.words);
    EXPECT_EQ(back->find(value.name)->numbers, value.numbers);
  }
  EXPECT_EQ(back->values.size(), sent);
}

TEST(Request, TravelsAsItWasTyped) {
  for (const CommandInfo& row : table()) {
    if (row.number < 0 || row.runs == Runs::nobody) continue;
    expect_round_trip(*parse(row.example), table());
  }
  for (const char* line :
       {"goto r1 1 2 3", "goto r1 1 2 --wait", "reset r1 --override", "mode r1 r2 waypoint"})
    expect_round_trip(*parse(line), table());
  for (const char* line :
       {"area r1 add a keep_in 0 0 4 0 4 4 --z -1 2.5 --weight 3", "area r1 add a keep_in 0 0 1 1 --weight 2",
        "explore r1", "explore r1 --for 60 --area b", "goto r1 1 2 --budget none", "goto r1 1 2 3 --nearest",
        "convoy start r1 r2 --speed 1", "camera r1 on"})
    expect_round_trip(*later(line), kLater);
}

TEST(Request, WhatIsReceivedIsCheckedAgainstTheTable) {
  EXPECT_EQ(unpack({999, {}, {}, 0}).reason(), Reason::unknown_command);
  EXPECT_EQ(unpack({-1, {}, {}, 0}).reason(), Reason::unknown_command);
  const int go = info(verb("goto")).number;
  EXPECT_EQ(unpack({go, {}, {1.0}, 0}).reason(), Reason::bad_argument);
  EXPECT_EQ(unpack({go, {}, {1.0, 2.0, 3.0, 4.0}, 0}).reason(), Reason::bad_argument);
  EXPECT_EQ(unpack({go, {}, {1.0, std::nan("")}, 0}).reason(), Reason::out_of_range);
  EXPECT_EQ(unpack({go, {}, {1.0, 2e4}, 0}).reason(), Reason::out_of_range);
  EXPECT_EQ(unpack({go, {}, {1.0, 2.0}, 1}).reason(), Reason::bad_argument) << "--wait is the station's";
  EXPECT_EQ(unpack({go, {"x"}, {1.0, 2.0}, 0}).reason(), Reason::bad_argument);
  EXPECT_TRUE(unpack({info(verb("mode")).number, {"orbit"}, {}, 0}).ok()) << "a robot knows its own modes";
  EXPECT_EQ(unpack({info(verb("mode")).number, {"fly high"}, {}, 0}).reason(), Reason::mode_unknown);
  EXPECT_EQ(unpack({info(verb("grant")).number, {"op 2"}, {}, 0}).reason(), Reason::bad_argument);
  EXPECT_EQ(unpack({info(verb("take")).number, {}, {}, 0x8000}).reason(), Reason::bad_argument);
}

TEST(Request, AnyPayloadIsReadOrRefused) {
  Random random(3);
  int read = 0;
  for (int round = 0; round < 20000; ++round) {
    Payload payload{.number = static_cast<int>(random.below(30))};
    for (std::uint64_t i = random.below(4); i > 0; --i)
      payload.words.push_back(std::array{"r1", "on", "add", "keep_in", "", "\xff"}[random.below(6)]);
    for (std::uint64_t i = random.below(8); i > 0; --i)
      payload.numbers.push_back(random.uniform() * 3e4 - 1.5e4);
    payload.options = static_cast<std::uint16_t>(random.below(8));
    const auto request = unpack(payload, round % 2 == 0 ? table() : Table(kLater));
    if (request) ++read;
    EXPECT_TRUE(request || !request.error().text.empty());
  }
  EXPECT_GT(read, 10);
}

TEST(Request, AnswersComeOutOfTheTable) {
  EXPECT_EQ(done_text(*parse("goto r1 12 -0.5")), "driving to 12.00 -0.50");
  EXPECT_EQ(done_text(*parse("goto r1 12 0 --wait")), "arrived at 12.00 0.00");
  EXPECT_EQ(done_text(*parse("grant r1 op2")), "granted to op2");
  EXPECT_EQ(done_text(*parse("drive r1 1 0 0")), "drove for 1.0 s");
  EXPECT_EQ(done_text(*parse("drive r1 1 0 0 --for 2.5")), "drove for 2.5 s");
  EXPECT_EQ(done_text(*parse("policy r1 planner auto")), "planner has the restart policy auto");
  EXPECT_EQ(done_text(*parse("home r1")), "driving home");
}

}  // namespace
}  // namespace adit::command
