// SPDX-License-Identifier: Apache-2.0
// The command line of the window.
#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;

class CommandLineWindow : public Window {
 protected:
  void type(const char* text) {
    for (; *text != 0; ++text) QTest::keyClick(window(), *text);
  }
  void open_line() {
    QTest::keyClick(window(), Qt::Key_K, Qt::ControlModifier);
    settle();
    ASSERT_TRUE(control.command_line()->is_open());
  }
};

TEST_F(CommandLineWindow, RunsWhatWasTypedAndShowsTheAnswerInPlace) {
  open_line();
  type("got");
  QTest::keyClick(window(), Qt::Key_Tab);
  type("r1 3 4");
  EXPECT_EQ(control.command_line()->line(), "goto r1 3 4");
  EXPECT_TRUE(sink.lines.empty());
  QTest::keyClick(window(), Qt::Key_Return);
  ASSERT_THAT(sink.lines, ElementsAre("goto r1 3 4"));
  EXPECT_EQ(text("commandAnswer"), "…");
  sink.pending[0]({.text = "r1: driving to 3.00 4.00\nsecond line\n"});
  EXPECT_EQ(text("commandAnswer"), "r1: driving to 3.00 4.00\nsecond line");
  picture("command");
  QTest::keyClick(window(), Qt::Key_Up);
  EXPECT_EQ(control.command_line()->line(), "goto r1 3 4");
  QTest::keyClick(window(), Qt::Key_Escape);
  EXPECT_FALSE(control.command_line()->is_open());
  QTest::keyClick(window(), Qt::Key_1);
  EXPECT_THAT(control.selection(), ElementsAre("r1")) << "keys mean actions again";
}

TEST_F(CommandLineWindow, LettersAreTextAndNoActions) {
  control.select("r1", false);
  open_line();
  type("trlhwxgse");
  EXPECT_TRUE(sink.lines.empty());
  EXPECT_EQ(control.command_line()->line(), "trlhwxgse");
}

TEST_F(CommandLineWindow, ThePauseKeyStopsAllWhileTyping) {
  open_line();
  type("goto r1 ");
  QTest::keyClick(window(), Qt::Key_Pause);
  EXPECT_THAT(sink.lines, ElementsAre("STOP"));
}

TEST_F(CommandLineWindow, CanBeOpenedAndComposedByTouch) {
  settle_layout();
  touch(middle("commandToggle"));
  ASSERT_TRUE(control.command_line()->is_open());
  type("tak");
  settle();
  touch(middle("proposal_take"));
  EXPECT_EQ(control.command_line()->line(), "take ");
  touch(middle("proposal_r2"));
  touch(middle("commandRun"));
  EXPECT_THAT(sink.lines, ElementsAre("take r2"));
}

TEST_F(CommandLineWindow, WrongLinesAreNotSentAndSayWhatIsRight) {
  open_line();
  type("goto r1 north");
  QTest::keyClick(window(), Qt::Key_Return);
  EXPECT_TRUE(sink.lines.empty());
  EXPECT_TRUE(control.command_line()->refused());
  EXPECT_NE(text("commandAnswer"), "");
  EXPECT_EQ(control.command_line()->line(), "goto r1 north") << "it can be mended";
  control.show_link(false, 5.0, "ended");
  control.command_line()->set_line("take r1");
  control.command_line()->run();
  EXPECT_TRUE(sink.lines.empty()) << "nothing is sent without a station";
}

TEST_F(CommandLineWindow, AStopGoesTheWayOfStops) {
  open_line();
  type("stop r1 r2");
  QTest::keyClick(window(), Qt::Key_Return);
  EXPECT_THAT(sink.lines, ElementsAre("STOP r1 r2"));
}

TEST_F(CommandLineWindow, AnswersAndHistoryStayBounded) {
  open_line();
  for (int i = 0; i < 300; ++i) {
    control.command_line()->set_line(QString("status r%1").arg(i));
    control.command_line()->run();
  }
  sink.pending.back()({.text = std::string(100'000, 'w')});
  EXPECT_LE(control.command_line()->answer().size(), CommandLine::kMaxAnswer + 10);
  for (int i = 0; i < 200; ++i) control.command_line()->recall(-1);
  EXPECT_EQ(control.command_line()->line(), "status r200");
  settle();
}

}  // namespace
}  // namespace adit::gui
