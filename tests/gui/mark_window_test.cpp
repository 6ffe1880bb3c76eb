// SPDX-License-Identifier: Apache-2.0
// Marks that the operator sets on the map.
#include "tests/gui/tabs_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

class MarkWindow : public TabsTest {
 protected:
  /// Reads the place from a line, m.
  static Point place_of(const std::string& line) {
    Point place{};
    EXPECT_EQ(std::sscanf(line.c_str(), "finding add %*s %lf %lf", &place.x, &place.y), 2) << line;
    return place;
  }
};

TEST_F(MarkWindow, ATapWithTheToolThenAKindSendsTheMark) {
  control.select("r1", false);
  settle_layout();
  touch(middle("markToggle"));
  ASSERT_TRUE(control.mark()->active());
  touch(on_map(6, 1));
  ASSERT_TRUE(control.mark()->ready());
  EXPECT_FALSE(control.mark()->active());
  EXPECT_THAT(sink.lines, IsEmpty()) << "no robot drives, and nothing is marked without a kind";
  settle_layout();
  touch(middle("markText"));
  type("knocks's");
  EXPECT_THAT(sink.lines, IsEmpty()) << "letters are text";
  picture("mark_menu");
  touch(middle("mark_person"));
  ASSERT_THAT(sink.lines, SizeIs(1));
  EXPECT_THAT(sink.lines[0], StartsWith("finding add person "));
  EXPECT_TRUE(QString::fromStdString(sink.lines[0]).endsWith(" 'knocks'\\''s'")) << sink.lines[0];
  EXPECT_NEAR(place_of(sink.lines[0]).x, 6, 0.06);
  EXPECT_NEAR(place_of(sink.lines[0]).y, 1, 0.06);
  EXPECT_FALSE(control.mark()->ready());
}

TEST_F(MarkWindow, TheRightButtonAndALongPressMarkWhereNoRobotIsSelected) {
  settle_layout();
  ASSERT_THAT(control.selection(), IsEmpty());
  QTest::mouseClick(window(), Qt::RightButton, {}, on_map(6, 1));
  EXPECT_TRUE(control.mark()->ready());
  QTest::keyClick(window(), Qt::Key_Escape);
  EXPECT_FALSE(control.mark()->ready());
  finger_down(on_map(4, -1));
  QTest::qWait(GestureArea::kLongPress + 100);
  finger_up(on_map(4, -1));
  EXPECT_TRUE(control.mark()->ready());
  settle_layout();
  touch(middle("mark_cancel"));
  EXPECT_FALSE(control.mark()->ready());
  EXPECT_THAT(sink.lines, IsEmpty());
  control.select("r1", false);
  QTest::mouseClick(window(), Qt::RightButton, {}, on_map(6, 1));
  EXPECT_FALSE(control.mark()->ready()) << "the selected robot is sent there";
}

TEST_F(MarkWindow, ATextThatIsANumberIsNotTheHeight) {
  control.mark()->choose({1, 2}, std::nullopt);
  control.mark()->apply("gas", "40");
  control.mark()->choose({1, 2}, 3.5);
  control.mark()->apply("gas", "");
  EXPECT_THAT(sink.lines, ElementsAre("finding add gas 1.00 2.00 0.00 40", "finding add gas 1.00 2.00 3.50"));
}

TEST_F(MarkWindow, HasAFlagAndARowFromWhichItIsRemoved) {
  station::FoundReport found = some_findings();
  found.findings.push_back({.number = 4,
                            .robot = control.world().station,
                            .kind = "exit",
                            .position = {8, 1, 0},
                            .text = "the way out",
                            .mark = true});
  open("findings");
  answer(answer_of(found));
  settle_layout();
  picture("mark");
  EXPECT_FALSE(item("remove_2")->isVisible()) << "a robot found it";
  touch(middle("remove_4"));
  EXPECT_THAT(sink.lines, ElementsAre("finding remove 4"));
}

}  // namespace
}  // namespace adit::gui
