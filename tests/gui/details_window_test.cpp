// SPDX-License-Identifier: Apache-2.0
// The pane with the details of the selected robots.
#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;

TEST_F(Window, DetailsOpenByAKeyAndByAButtonAndKeepTheMapInView) {
  const double before = map().width();
  QTest::keyClick(window(), Qt::Key_I);
  settle();
  EXPECT_TRUE(control.details()->is_open());
  EXPECT_EQ(text("detail_robots"), "10");
  EXPECT_LT(map().width(), before - 200);
  settle_layout();
  touch(middle("closeDetails"));
  EXPECT_FALSE(control.details()->is_open());
  touch(middle("detailsToggle"));
  EXPECT_TRUE(control.details()->is_open());
}

TEST_F(Window, DetailsAllowARobotToMakeWayAndHandItOverOnlyByHolding) {
  control.details()->set_open(true);
  control.select("r1", false);
  settle_layout();
  EXPECT_EQ(text("detail_make way"), "not allowed");
  touch(middle("detailAction_make way"));
  EXPECT_THAT(sink.lines, ElementsAre("yield r1 on"));
  const QPoint at = middle("detailAction_hand to op2");
  touch(at);
  EXPECT_EQ(sink.lines.size(), 1U);
  finger_down(at);
  ASSERT_TRUE(QTest::qWaitFor([&] { return sink.lines.size() == 2; }, 30'000));
  finger_up(at);
  EXPECT_EQ(sink.lines.back(), "grant r1 op2");
}

TEST_F(Window, DetailsOfASilentStationOfferNothing) {
  control.details()->set_open(true);
  control.select("r1", false);
  control.show_link(true, 3.0, "");
  settle();
  EXPECT_FALSE(item("detailAction_make way")->isVisible());
}

TEST_F(Window, PicturesOfDetails) {
  control.details()->set_open(true);
  control.select("r4", false);
  picture("details");
  window()->resize(1920, 1080);
  control.select("r1", true);
  settle();
  picture("details_two_1080");
}

}  // namespace
}  // namespace adit::gui
