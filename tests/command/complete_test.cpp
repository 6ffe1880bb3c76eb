// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "core/command/vocabulary.hpp"
#include "tests/command/later_commands.hpp"

namespace adit::command {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

const std::vector<std::string> kRobots{"r1", "r2"};

TEST(Complete, CommandsThenRobotsThenArguments) {
  EXPECT_THAT(complete({""}, kRobots), Contains("home"));
  EXPECT_THAT(complete({""}, kRobots), Contains("pose"));
  EXPECT_THAT(complete({""}, kRobots), Not(Contains("query")));
  EXPECT_THAT(complete({"home", ""}, kRobots), ElementsAre("r1", "r2"));
  EXPECT_THAT(complete({"pose", ""}, kRobots), ElementsAre("r1", "r2"));
  EXPECT_THAT(complete({"pose", "r1", ""}, kRobots), IsEmpty());
  EXPECT_THAT(complete({"stop", ""}, kRobots), ElementsAre("r1", "r2", "all"));
  EXPECT_THAT(complete({"mode", "r1", ""}, kRobots), Contains("waypoint"));
  EXPECT_THAT(complete({"mode", "r1", ""}, kRobots), Contains("r2"));
  EXPECT_THAT(complete({"mode", ""}, kRobots), ElementsAre("r1", "r2", "all"));
  EXPECT_THAT(complete({"mode", "all", ""}, kRobots), ElementsAre("hold"))
      << "the only mode that all may enter";
  EXPECT_THAT(complete({"yield", "all", ""}, kRobots), ElementsAre("off"));
  EXPECT_THAT(complete({"release", ""}, kRobots), ElementsAre("r1", "r2"));
  EXPECT_THAT(complete({"policy", "r1", ""}, kRobots),
              ElementsAre("planner", "router", "sensors", "map", "stairs", "cameras", "objects"));
  EXPECT_THAT(complete({"policy", "r1", "planner", ""}, kRobots), ElementsAre("auto", "manual"));
  EXPECT_THAT(complete({"help", ""}, kRobots), Contains("goto"));
  EXPECT_THAT(complete({"completion", ""}, kRobots), ElementsAre("bash", "zsh", "fish"));
  EXPECT_THAT(complete({"list", ""}, kRobots), IsEmpty());
  EXPECT_THAT(complete({"nothing", ""}, kRobots), IsEmpty());
}

TEST(Complete, AllWhereTheCommandMovesNoRobot) {
  EXPECT_THAT(complete({"reset", ""}, kRobots), ElementsAre("r1", "r2", "all"));
  EXPECT_THAT(complete({"reset", "all", ""}, kRobots), Contains("--override"));
  EXPECT_THAT(complete({"mode", "all", ""}, kRobots), ElementsAre("hold"));
  EXPECT_THAT(complete({"yield", "all", ""}, kRobots), ElementsAre("off"));
  EXPECT_THAT(complete({"mode", "all", "hold", ""}, kRobots), IsEmpty());
  EXPECT_THAT(complete({"explore", ""}, kRobots), Not(Contains("all")));
}

TEST(Complete, OptionsOnceTheArgumentsAreThere) {
  EXPECT_THAT(complete({"goto", "r1", "1", ""}, kRobots), IsEmpty());
  EXPECT_THAT(complete({"goto", "r1", "1", "2", ""}, kRobots),
              ElementsAre("--wait", "--nearest", "--budget"));
  EXPECT_THAT(complete({"goto", "r1", "1", "2", "--wait", ""}, kRobots),
              ElementsAre("--nearest", "--budget"));
  EXPECT_THAT(complete({"goto", "r1", "1", "2", "--budget", ""}, kRobots), ElementsAre("none"));
  EXPECT_THAT(complete({"reset", "r1", ""}, kRobots), Contains("--override"));
  EXPECT_THAT(complete({"reset", ""}, kRobots), Not(Contains("--override")));
  EXPECT_THAT(complete({"drive", "r1", "1", "0", "0", "--for", ""}, kRobots), IsEmpty());
}

TEST(Complete, KeywordsAndValuesOfOptions) {
  const auto later = [](const std::vector<std::string>& words) { return complete(words, kRobots, kLater); };
  EXPECT_THAT(later({"area", "r1", ""}), ElementsAre("r1", "r2", "add", "remove"));
  EXPECT_THAT(later({"area", "r1", "add", "shaft", ""}), ElementsAre("keep_in", "keep_out", "prefer"));
  EXPECT_THAT(later({"area", "r1", "add", "shaft", "keep_in", "0", "0", "1", "1", ""}),
              ElementsAre("--z", "--weight"));
  EXPECT_THAT(later({"explore", "r1", "--after", ""}), ElementsAre("report", "home", "wait"));
  EXPECT_THAT(later({"goto", "r1", "1", "2", "--budget", ""}), ElementsAre("none"));
}

}  // namespace
}  // namespace adit::command
