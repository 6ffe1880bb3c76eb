#include <gmock/gmock.h>

#include "core/command/vocabulary.hpp"
#include "tests/command/later_commands.hpp"

namespace adit::command {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

const std::vector<std::string> robots{"r1", "r2"};

TEST(Complete, CommandsThenRobotsThenArguments) {
  EXPECT_THAT(complete({""}, robots), Contains("home"));
  EXPECT_THAT(complete({""}, robots), Contains("pose"));
  EXPECT_THAT(complete({""}, robots), Not(Contains("query")));
  EXPECT_THAT(complete({"home", ""}, robots), ElementsAre("r1", "r2"));
  EXPECT_THAT(complete({"pose", ""}, robots), ElementsAre("r1", "r2"));
  EXPECT_THAT(complete({"pose", "r1", ""}, robots), IsEmpty());
  EXPECT_THAT(complete({"stop", ""}, robots), ElementsAre("r1", "r2", "all"));
  EXPECT_THAT(complete({"mode", "r1", ""}, robots), Contains("waypoint"));
  EXPECT_THAT(complete({"mode", "r1", ""}, robots), Contains("r2"));
  EXPECT_THAT(complete({"mode", ""}, robots), ElementsAre("r1", "r2"));
  EXPECT_THAT(complete({"policy", "r1", ""}, robots), ElementsAre("planner", "router", "sensors"));
  EXPECT_THAT(complete({"policy", "r1", "planner", ""}, robots), ElementsAre("auto", "manual"));
  EXPECT_THAT(complete({"help", ""}, robots), Contains("goto"));
  EXPECT_THAT(complete({"completion", ""}, robots), ElementsAre("bash", "zsh", "fish"));
  EXPECT_THAT(complete({"list", ""}, robots), IsEmpty());
  EXPECT_THAT(complete({"nothing", ""}, robots), IsEmpty());
}

TEST(Complete, OptionsOnceTheArgumentsAreThere) {
  EXPECT_THAT(complete({"goto", "r1", "1", ""}, robots), IsEmpty());
  EXPECT_THAT(complete({"goto", "r1", "1", "2", ""}, robots), ElementsAre("--wait"));
  EXPECT_THAT(complete({"goto", "r1", "1", "2", "--wait", ""}, robots), IsEmpty());
  EXPECT_THAT(complete({"reset", "r1", ""}, robots), Contains("--override"));
  EXPECT_THAT(complete({"reset", ""}, robots), Not(Contains("--override")));
  EXPECT_THAT(complete({"drive", "r1", "1", "0", "0", "--for", ""}, robots), IsEmpty());
}

TEST(Complete, KeywordsAndValuesOfOptions) {
  const auto later = [](const std::vector<std::string>& words) { return complete(words, robots, kLater); };
  EXPECT_THAT(later({"area", "r1", ""}), ElementsAre("r1", "r2", "add", "remove"));
  EXPECT_THAT(later({"area", "r1", "add", "shaft", ""}), ElementsAre("keep_in", "keep_out", "prefer"));
  EXPECT_THAT(later({"area", "r1", "add", "shaft", "keep_in", "0", "0", "1", "1", ""}),
              ElementsAre("--z", "--weight"));
  EXPECT_THAT(later({"explore", "r1", "--after", ""}), ElementsAre("report", "home", "wait"));
  EXPECT_THAT(later({"goto", "r1", "1", "2", "--budget", ""}), ElementsAre("none"));
}

}  // namespace
}  // namespace adit::command
