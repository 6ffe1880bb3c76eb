// SPDX-License-Identifier: Apache-2.0
// Commands that are typed in the window.
#include <gmock/gmock.h>

#include "basestation/gui/bridge/typed_line.hpp"
#include "core/time/random.hpp"

namespace adit::gui {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Kind = TypedLine::Kind;

const std::vector<std::string> kRobots{"r1", "r2", "rover"};

TEST(TypedLine, ProposesCommandsRobotsAndWords) {
  EXPECT_THAT(proposals("", kRobots), Contains("take"));
  EXPECT_THAT(proposals("got", kRobots), ElementsAre("goto"));
  EXPECT_THAT(proposals("take ro", kRobots), ElementsAre("rover"));
  EXPECT_THAT(proposals("mode r1 way", kRobots), Contains("waypoint"));
  EXPECT_THAT(proposals("take 'r", kRobots), IsEmpty());
  EXPECT_THAT(proposals("", kRobots), Not(Contains("teleop"))) << "it needs a terminal";
  EXPECT_LE(proposals("", kRobots).size(), kMaxProposals);
}

TEST(TypedLine, IsCompletedAsFarAsItIsClear) {
  EXPECT_EQ(completed("got", kRobots), "goto ");
  EXPECT_EQ(completed("take r", kRobots), "take r");
  EXPECT_EQ(completed("take ro", kRobots), "take rover ");
  EXPECT_EQ(completed("nonsense", kRobots), "nonsense");
  EXPECT_EQ(with_word("take r", "r2"), "take r2 ");
}

TEST(TypedLine, IsAnOrderAStopHelpOrWrong) {
  EXPECT_EQ(read_line("").kind, Kind::nothing);
  EXPECT_EQ(read_line("take r1").kind, Kind::order);
  EXPECT_EQ(read_line("stop all").kind, Kind::stop);
  EXPECT_THAT(read_line("stop all").robots, IsEmpty());
  EXPECT_THAT(read_line("stop r1 r2").robots, ElementsAre("r1", "r2"));
  EXPECT_EQ(read_line("stop").kind, Kind::wrong) << "all is never implied";
  EXPECT_THAT(read_line("help goto").text, HasSubstr("basestation goto"));
  EXPECT_THAT(read_line("teleop r1").text, HasSubstr("only in a terminal"));
  EXPECT_EQ(read_line("goto r1 north").kind, Kind::wrong);
}

TEST(TypedLine, AnyTextIsReadToItsEnd) {
  Random random(7);
  const std::string letters = "gotake r1stop all'\"\\-.0\n\t\x80\xff";
  for (int i = 0; i < 5000; ++i) {
    std::string line;
    for (int n = static_cast<int>(random.uniform() * 20); n > 0; --n)
      line += letters[static_cast<std::size_t>(random.uniform() * static_cast<double>(letters.size() - 1))];
    (void)proposals(line, kRobots);
    (void)completed(line, kRobots);
    if (read_line(line).kind == Kind::stop) {
      EXPECT_THAT(line, HasSubstr("stop"));
    }
  }
}

}  // namespace
}  // namespace adit::gui
