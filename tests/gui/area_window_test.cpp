// SPDX-License-Identifier: Apache-2.0
// Areas that are drawn on the map.
#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

class AreaWindow : public Window {
 protected:
  void begin(const QString& robot) {
    control.select(robot, false);
    settle_layout();
    touch(middle("areaToggle"));
  }
};

TEST_F(AreaWindow, IsDrawnFromCornerToCornerAndGivenToTheSelectedRobots) {
  begin("r1");
  control.select("r3", true);  // op2 holds it: it gets nothing.
  const Camera before = map().camera();
  drag(on_map(4, 1), on_map(8, -1));
  control.select("r4", true);
  settle();
  EXPECT_EQ(map().camera(), before) << "the drag draws, and does not move the map";
  ASSERT_TRUE(control.area()->ready());
  EXPECT_TRUE(text("areaText").endsWith("for r1 r4")) << text("areaText").toStdString();
  EXPECT_THAT(sink.lines, IsEmpty()) << "nothing is sent before its meaning is known";
  picture("area");
  settle_layout();
  touch(middle("area_keep_out"));
  ASSERT_THAT(sink.lines, SizeIs(1));
  char robots[32] = {};
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  ASSERT_EQ(std::sscanf(sink.lines[0].c_str(), "area %31[^a] add a1 keep_out %lf %lf %lf %lf", robots, &x0,
                        &y0, &x1, &y1),
            5)
      << sink.lines[0];
  EXPECT_EQ(std::string(robots), "r1 r4 ");
  EXPECT_NEAR(x0, 4, 0.06);
  EXPECT_NEAR(y0, 1, 0.06);
  EXPECT_NEAR(x1, 8, 0.06);
  EXPECT_NEAR(y1, -1, 0.06);
  EXPECT_FALSE(control.area()->active());
  EXPECT_THAT(control.area()->sketch(), IsEmpty());
}

TEST_F(AreaWindow, NeedsARobotOfMine) {
  begin("r3");
  EXPECT_FALSE(control.area()->active());
  EXPECT_EQ(control.outcome_kind(), "refused");
}

TEST_F(AreaWindow, EscapeASmallDragAndASecondFingerTakeItBack) {
  begin("r1");
  drag(on_map(4, 1), on_map(4, 1) + QPoint(1, 1));
  EXPECT_FALSE(control.area()->ready());
  EXPECT_TRUE(control.area()->active()) << "it can be drawn again";
  const QPoint at = on_map(4, 1);
  finger_down(at);
  QTest::touchEvent(window(), finger).move(0, at + QPoint(60, 60), window());
  EXPECT_TRUE(QTest::qWaitFor([&] { return control.area()->sketch().size() == 4; }));
  QTest::touchEvent(window(), finger).stationary(0).press(1, at + QPoint(90, 0), window());
  EXPECT_THAT(control.area()->sketch(), IsEmpty());
  QTest::touchEvent(window(), finger).release(0, at, window()).release(1, at, window());
  QTest::keyClick(window(), Qt::Key_Escape);
  EXPECT_FALSE(control.area()->active());
  EXPECT_THAT(sink.lines, IsEmpty());
}

TEST(AreaName, IsOneThatNoRobotHas) {
  station::World world = ten_robots();
  EXPECT_EQ(free_area_name(world), "a1");
  world.robots[1].areas = {{.name = "a1"}, {.name = "a2"}};
  world.robots[4].areas = {{.name = "a3"}};
  EXPECT_EQ(free_area_name(world), "a4");
}

}  // namespace
}  // namespace adit::gui
