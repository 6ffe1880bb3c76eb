// SPDX-License-Identifier: Apache-2.0
#include "core/command/parse.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/command/words.hpp"
#include "core/time/random.hpp"

namespace adit::command {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Parse, EveryExampleOfTheTableIsAccepted) {
  for (const CommandInfo& row : table()) {
    if (row.runs == Runs::nobody) continue;
    const auto request = parse(row.example);
    ASSERT_TRUE(request.ok()) << row.example << ": " << request.error().text;
    EXPECT_EQ(request->info, &row) << row.example;
    EXPECT_EQ(request->verb, verb_of(row)) << row.example;
    EXPECT_THAT(help(row), HasSubstr(std::string(row.example)));
  }
}

TEST(Parse, SeveralRobotsEachOnce) {
  EXPECT_THAT(parse("take r1 r2 r1")->robots, ElementsAre("r1", "r2"));
  EXPECT_THAT(parse("mode r1 r2 smart_joystick")->robots, ElementsAre("r1", "r2"));
  EXPECT_EQ(parse("mode r1 r2 smart_joystick")->word("MODE"), "smart_joystick");
  EXPECT_THAT(parse("home r1 r2")->robots, ElementsAre("r1", "r2"));
}

TEST(Parse, TheRobotJudgesTheNameOfAMode) {
  EXPECT_EQ(parse("mode r1 orbit")->word("MODE"), "orbit");
  EXPECT_EQ(parse("mode r1 holt")->word("MODE"), "holt");
}

TEST(Parse, GotoWithAndWithoutHeight) {
  const auto flat = parse("goto r1 12 -0.5");
  EXPECT_EQ(flat->number("X"), 12.0);
  EXPECT_EQ(flat->number("Y"), -0.5);
  EXPECT_TRUE(std::isnan(flat->number("Z")));
  EXPECT_FALSE(flat->has("--wait"));
  const auto high = parse("goto --wait r1 1e1 +2 3.25");
  EXPECT_EQ(high->number("X"), 10.0);
  EXPECT_EQ(high->number("Z"), 3.25);
  EXPECT_TRUE(high->has("--wait"));
}

TEST(Parse, AMarkWithAndWithoutHeightAndText) {
  const auto words = [](const Result<Request>& request) {
    const ArgumentValue* text = request->find("TEXT");
    return text ? text->words : std::vector<std::string>{};
  };
  const auto bare = parse("finding add person 12 -4.5");
  ASSERT_TRUE(bare.ok());
  EXPECT_EQ(bare->word("KIND"), "person");
  EXPECT_EQ(bare->number("Y"), -4.5);
  EXPECT_FALSE(bare->has("Z"));
  const auto text = parse("finding add person 12 4.5 calls for help");
  ASSERT_TRUE(text.ok()) << text.error().text;
  EXPECT_FALSE(text->has("Z"));
  EXPECT_THAT(words(text), ElementsAre("calls", "for", "help"));
  const auto both = parse("finding add person 12 4.5 -3 calls for help");
  EXPECT_EQ(both->number("Z"), -3.0);
  EXPECT_THAT(words(both), ElementsAre("calls", "for", "help"));
  const auto quoted = parse("finding add person 12 4.5 '3 of them'");
  EXPECT_FALSE(quoted->has("Z"));
  EXPECT_THAT(words(quoted), ElementsAre("3 of them"));
  const auto photo = parse("finding add person 12 4.5 calls --photo x.jpg for help");
  EXPECT_EQ(photo->word("--photo"), "x.jpg");
  EXPECT_THAT(words(photo), ElementsAre("calls", "for", "help"));
  EXPECT_EQ(parse("finding photo 3 x.jpg")->word("FILE"), "x.jpg");
  EXPECT_EQ(parse("finding add person 12 4.5 a photo 3 x")->verb, verb("finding add"));
  const auto number = parse("finding 3 note add 1 2");
  EXPECT_EQ(number->verb, verb("finding note"));
  for (const char* line :
       {"finding add", "finding add person", "finding add person 1", "finding add person x 2",
        "finding add 'two words' 1 2", "finding add person nan 2", "finding add person 1 1e9",
        "finding add person 1 2 --picture x.jpg", "finding add person 1 2 --photo", "finding photo 3",
        "finding photo x.jpg", "finding remove", "finding remove x"})
    EXPECT_FALSE(parse(line).ok()) << line;
}

TEST(Parse, PoseOfARobot) {
  const auto pose = parse("pose r1 1 2 0.5");
  EXPECT_EQ(pose->number("X"), 1.0);
  EXPECT_EQ(pose->number("Y"), 2.0);
  EXPECT_EQ(pose->number("YAW"), 0.5);
}

TEST(Parse, DriveWithDuration) {
  EXPECT_EQ(parse("drive r1 0.5 0 -0.2")->number("--for"), 1.0);
  EXPECT_EQ(parse("drive r1 0.5 0 -0.2 --for 3")->number("--for"), 3.0);
  EXPECT_EQ(parse("drive r1 0.5 0 -0.2 --for=2.5")->number("--for"), 2.5);
}

TEST(Parse, StopOfAllAndResetWithOverride) {
  EXPECT_TRUE(parse("stop all")->all);
  EXPECT_TRUE(parse("stop r1 all")->all);
  EXPECT_FALSE(parse("stop r1")->all);
  EXPECT_TRUE(parse("reset r1 --override")->has("--override"));
  EXPECT_EQ(parse("restart r1 planner")->word("COMPONENT"), "planner");
  EXPECT_EQ(parse("policy r1 planner auto")->word("POLICY"), "auto");
  EXPECT_EQ(parse("grant r1 op2")->word("OPERATOR"), "op2");
  EXPECT_TRUE(parse("run demo.yaml --all")->has("--all"));
}

TEST(Parse, AllWhereTheCommandMovesNoRobot) {
  for (const char* line :
       {"reset all", "reset all --override", "take all", "lock all", "unlock all", "mode all hold",
        "yield all off", "actions all", "area all add shaft keep_out 3 20 11 25"}) {
    const auto request = parse(line);
    ASSERT_TRUE(request) << line << ": " << request.error().text;
    EXPECT_TRUE(request->all) << line;
    EXPECT_THAT(request->robots, testing::IsEmpty()) << line;
  }
  EXPECT_TRUE(parse("reset all --override")->has("--override"));
  EXPECT_EQ(parse("mode all hold")->word("MODE"), "hold");
  EXPECT_EQ(parse("area all add shaft keep_out 3 20 11 25")->word("NAME"), "shaft");
  const auto area = parse("area r1 add all keep_out 3 20 11 25");
  ASSERT_TRUE(area) << area.error().text;
  EXPECT_FALSE(area->all) << "here it is the name of the area";
  for (const char* line :
       {"mode all waypoint", "mode r1 all explore", "yield all on", "home all", "explore all", "peeloff all",
        "goto all 1 2", "drive all 1 0 0", "plan all 1 2", "release all", "area all remove shaft"}) {
    const auto request = parse(line);
    EXPECT_FALSE(request) << line;
    if (!request) {
      EXPECT_EQ(request.reason(), Reason::bad_argument) << line;
      EXPECT_THAT(request.error().text, HasSubstr("all")) << line;
    }
  }
  // Robots that wait at an area would drive on, and robots that drive would have no holder.
  for (const char* line : {"release all", "area all remove shaft"})
    EXPECT_THAT(parse(line).error().text, HasSubstr("it does not take all: name each robot"));
}

TEST(Help, ExplainsEveryArgumentAndOption) {
  for (const CommandInfo& row : table()) {
    if (row.runs == Runs::nobody) continue;
    const std::string text = help(row);
    for (const Option& option : row.options)
      if (option) {
        EXPECT_THAT(text, HasSubstr("\n  " + std::string(option.name))) << row.name;
      }
    for (const Argument& argument : row.arguments) {
      if (!argument || argument.type == Type::keyword) continue;
      EXPECT_THAT(text, HasSubstr("\n  " + std::string(argument.name))) << row.name;
      if (!argument.unit.empty()) {
        EXPECT_THAT(text, HasSubstr(" " + std::string(argument.unit) + ", ")) << row.name;
      }
    }
  }
  const std::string go = help(*find_commands("goto").front());
  EXPECT_THAT(go, HasSubstr("--budget M|none"));
  EXPECT_THAT(go, HasSubstr("(m, 0 to 10000 or none)\n"));
  EXPECT_THAT(help(*find_commands("drive").front()), HasSubstr("how long (s, above 0 to 3600; default 1)\n"));
  EXPECT_THAT(help(*find_commands("reset").front()), HasSubstr("all: every robot that you hold\n"));
  EXPECT_THAT(help(*find_commands("mode").front()),
              HasSubstr("all: every robot that you hold, with hold only\n"));
}

struct Bad {
  const char* line;
  Reason reason;
  const char* says;
};

class ParseBad : public testing::TestWithParam<Bad> {};

TEST_P(ParseBad, TellsWhatToDoInOneLine) {
  const auto request = parse(GetParam().line);
  ASSERT_FALSE(request.ok()) << GetParam().line;
  EXPECT_EQ(request.reason(), GetParam().reason);
  EXPECT_THAT(request.error().text, HasSubstr(GetParam().says));
  EXPECT_EQ(request.error().text.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    All, ParseBad,
    testing::Values(Bad{"", Reason::syntax, "no command"},
                    Bad{"tkae r1", Reason::unknown_command, "did you mean take?"},
                    Bad{"foo", Reason::unknown_command, "'foo'; try help"},
                    Bad{"relay r1 on", Reason::unknown_command, "unknown command 'relay'"},
                    Bad{"convoy start r1", Reason::bad_argument, "a follower is missing"},
                    Bad{"convoy start r1 r2 r2", Reason::bad_argument, "r2 is named twice"},
                    Bad{"convoy start r1 r2 --gap 0.1", Reason::out_of_range, "at least 0.5"},
                    Bad{"join r1 r2 3", Reason::unknown_command, "unknown command"},
                    Bad{"peeloff", Reason::bad_argument, "usage: peeloff R..."},
                    Bad{"mop r1 1 2", Reason::unknown_command, "unknown command"},
                    Bad{"mop save x", Reason::unknown_command, "unknown command"},
                    Bad{"map foo", Reason::bad_argument,
                        "map: save or load or picture or status or forget is missing; try help map"},
                    Bad{"stairs r1", Reason::bad_argument, "stairs: takes no arguments"},
                    Bad{"relay r1 on", Reason::unknown_command, "unknown command"},
                    Bad{"take", Reason::bad_argument, "usage: take R..."},
                    Bad{"take r!", Reason::bad_argument, "cannot be a robot's name"},
                    Bad{"stop", Reason::bad_argument, "usage: stop R...|all"},
                    Bad{"list r1", Reason::bad_argument, "takes no arguments"},
                    Bad{"teleop r1 r2", Reason::bad_argument, "takes one robot"},
                    Bad{"mode r1", Reason::bad_argument, "a mode is missing"},
                    Bad{"mode hold", Reason::bad_argument, "a mode is missing"},
                    Bad{"mode r1 'way point'", Reason::mode_unknown, "cannot be a mode's name"},
                    Bad{"goto r1 12", Reason::bad_argument, "usage: goto"},
                    Bad{"plan r1 12", Reason::bad_argument, "usage: plan"},
                    Bad{"plan r1 1 2 --wait", Reason::bad_argument, "no option --wait"},
                    Bad{"goto r1 1 2 3 4", Reason::bad_argument, "usage: goto"},
                    Bad{"goto r1 12 north", Reason::bad_argument, "Y is a number, not 'north'"},
                    Bad{"goto r1 nan 1", Reason::bad_argument, "X is a number"},
                    Bad{"goto r1 0x10 1", Reason::bad_argument, "X is a number"},
                    Bad{"goto r1 1,5 1", Reason::bad_argument, "X is a number"},
                    Bad{"goto r1 1e9 1", Reason::out_of_range, "at most 10000"},
                    Bad{"goto r1 1 1 --for 3", Reason::bad_argument, "no option --for"},
                    Bad{"drive r1 1 0", Reason::bad_argument, "usage: drive"},
                    Bad{"drive r1 inf 0 0", Reason::bad_argument, "VX is a number"},
                    Bad{"drive r1 99 0 0", Reason::out_of_range, "VX is at most 20"},
                    Bad{"drive r1 1 0 0 --for", Reason::bad_argument, "--for wants"},
                    Bad{"drive r1 1 0 0 --for 0", Reason::out_of_range, "more than 0"},
                    Bad{"drive r1 1 0 0 --for x", Reason::bad_argument, "--for is a number"},
                    Bad{"drive r1 1 0 0 --for 99999", Reason::out_of_range, "at most 3600"},
                    Bad{"grant r1", Reason::bad_argument, "an operator is missing"},
                    Bad{"grant r1 op!", Reason::bad_argument, "cannot be an operator's name"},
                    Bad{"restart r1", Reason::bad_argument, "a component"},
                    Bad{"restart r1 r2 planner", Reason::bad_argument, "a component"},
                    Bad{"restart r1 pl/anner", Reason::bad_argument, "component's name"},
                    Bad{"policy r1 planner", Reason::bad_argument, "auto or manual"},
                    Bad{"policy r1 planner never", Reason::bad_argument, "neither auto nor manual"},
                    Bad{"reset r1 --force", Reason::bad_argument, "no option --force"},
                    Bad{"run", Reason::bad_argument, "a file is missing"},
                    Bad{"run a b", Reason::bad_argument, "takes one file"},
                    Bad{"query", Reason::unknown_command, "unknown command"},
                    Bad{"home", Reason::bad_argument, "a robot is missing"},
                    Bad{"pose r1 1 2", Reason::bad_argument, "YAW is missing"},
                    Bad{"pose r1 1 2 7", Reason::out_of_range, "YAW is at most 6.3"},
                    Bad{"take \"r1", Reason::syntax, "not closed"}));

TEST(Parse, MutatedLinesNeverHarm) {
  Random random(7);
  const std::string alphabet = "abr1 \"'\\-.0+e\t\x01\xff";
  int accepted = 0;
  for (int round = 0; round < 20000; ++round) {
    const auto rows = table();
    std::string line(rows[random.below(rows.size())].example);
    for (std::uint64_t i = 0, n = random.below(4); i < n; ++i) {
      const std::size_t at = random.below(line.size() + 1);
      const char c = alphabet[random.below(alphabet.size())];
      if (random.chance(0.5) || at == line.size())
        line.insert(at, 1, c);
      else
        line[at] = c;
    }
    const auto request = parse(line);
    if (!request.ok()) {
      EXPECT_FALSE(request.error().text.empty());
      EXPECT_EQ(request.error().text.find('\n'), std::string::npos) << line;
      continue;
    }
    ++accepted;
    for (const std::string& robot : request->robots) EXPECT_TRUE(valid_name(robot)) << line;
    for (const ArgumentValue& value : request->values)
      for (const double number : value.numbers) EXPECT_TRUE(std::isfinite(number)) << line;
    EXPECT_TRUE(!request->has("--for") || request->number("--for") > 0.0) << line;
  }
  EXPECT_GT(accepted, 2000);
}

}  // namespace
}  // namespace adit::command
