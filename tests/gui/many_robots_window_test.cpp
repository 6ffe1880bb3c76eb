// SPDX-License-Identifier: Apache-2.0
// What commands more than three robots at once needs a press that is held, by every way of input.
#include "basestation/gui/bridge/action_bar.hpp"
#include "basestation/gui/scene/map_view_3d.hpp"
#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr int kHeldMs = GestureArea::kHold + 100;

class ManyRobots : public Window {
 protected:
  ManyRobots() {
    station::World world = ten_robots();
    for (station::Robot& robot : world.robots)
      if (robot.mine) {
        robot = mine(gui::robot(robot.name, robot.x, robot.y));
        robot.mode = "waypoint";
      }
    show(world);
    select({"r1", "r4", "r6", "r9"});
  }
  void select(const std::vector<std::string>& robots) {
    for (std::size_t i = 0; i < robots.size(); ++i) control.select(QString::fromStdString(robots[i]), i > 0);
    settle_layout();
  }
  /// Presses on a view of the map until it shows the place, or until the ring is full.
  void press_map(GestureArea& view, const QPoint& at, bool held) {
    const auto clock = view.pressed_for;
    if (!held) view.pressed_for = [] { return qint64{GestureArea::kLongPress}; };
    finger_down(at);
    EXPECT_TRUE(QTest::qWaitFor([&] { return view.aims(); }, 30'000));
    if (held) QTest::qWait(kHeldMs);
    if (held) picture("many_robots");
    finger_up(at);
    view.pressed_for = clock;
    settle();
  }
  QPoint free_place() { return on_map(12, 0.5); }
};

TEST_F(ManyRobots, ATapAfterGoToSendsNoneAndAPressThatIsHeldSendsAll) {
  press_slot("goto");
  ASSERT_TRUE(control.aiming());
  touch(free_place());
  EXPECT_THAT(sink.lines, IsEmpty()) << "a tap";
  EXPECT_TRUE(control.outcome().contains("hold")) << control.outcome().toStdString();
  EXPECT_TRUE(control.aiming()) << "the place can be pressed again";
  press_map(map(), free_place(), true);
  EXPECT_THAT(sink.lines, SizeIs(4));
  EXPECT_FALSE(control.aiming());
}

TEST_F(ManyRobots, ThreeAreSentByATap) {
  select({"r1", "r4", "r6"});
  press_slot("goto");
  touch(free_place());
  EXPECT_THAT(sink.lines, SizeIs(3));
}

TEST_F(ManyRobots, AShortPressOnTheMapSendsNoneInBothViews) {
  press_map(map(), free_place(), false);
  EXPECT_THAT(sink.lines, IsEmpty());
  press_map(map(), free_place(), true);
  EXPECT_THAT(sink.lines, SizeIs(4));
  control.set_solid(true);
  settle_layout();
  auto& solid = *static_cast<MapView3D*>(item("solid"));
  const auto seen = solid.camera().project({12.0, 3.0, 0.0});
  ASSERT_TRUE(seen);
  const QPoint at = solid.mapToScene({seen->at.x, seen->at.y}).toPoint();
  sink.lines.clear();
  press_map(solid, at, false);
  EXPECT_THAT(sink.lines, IsEmpty());
  press_map(solid, at, true);
  EXPECT_THAT(sink.lines, SizeIs(4)) << control.outcome().toStdString();
}

TEST_F(ManyRobots, ARightClickSendsNoneAndARightPressThatIsHeldSendsAll) {
  QTest::mouseClick(window(), Qt::RightButton, {}, free_place());
  EXPECT_THAT(sink.lines, IsEmpty());
  QTest::mousePress(window(), Qt::RightButton, {}, free_place());
  QTest::qWait(kHeldMs);
  QTest::mouseRelease(window(), Qt::RightButton, {}, free_place());
  EXPECT_THAT(sink.lines, SizeIs(4));
}

TEST_F(ManyRobots, NoButtonButStopAndHoldActsByATapOrAKeyAlone) {
  for (const Slot& slot : kSlots) {
    const std::string id = slot.id;
    if (id == "stop" || id == "mode_hold") continue;
    press_slot(slot.id);
    if (id == "goto") touch(free_place());
    if (*slot.key != 0) QTest::keyClick(window(), *slot.key);
    if (id == "goto") touch(free_place());
    control.set_aiming(false);
    EXPECT_THAT(sink.lines, IsEmpty()) << id;
  }
  press_slot("mode_hold");
  press_slot("stop");
  EXPECT_THAT(sink.lines, ElementsAre("mode r1 r4 r6 r9 hold", "STOP r1 r4 r6 r9"));
}

TEST_F(ManyRobots, FollowersPeelOffByHolding) {
  station::World world = control.world();
  for (station::Robot& robot : world.robots)
    if (robot.mine) robot.convoy = {"r2", "r1", "r4", "r6", "r9"};
  show(world);
  press_slot("convoy");
  EXPECT_THAT(sink.lines, IsEmpty());
}

TEST_F(ManyRobots, AnAreaForThemIsHeld) {
  touch(middle("areaToggle"));
  finger_down(on_map(4, 1));
  QTest::touchEvent(window(), finger).move(0, on_map(8, -1), window());
  finger_up(on_map(8, -1));
  settle_layout();
  ASSERT_TRUE(control.area()->ready());
  touch(middle("area_keep_out"));
  EXPECT_THAT(sink.lines, IsEmpty());
  const QPoint at = middle("area_keep_out");
  finger_down(at);
  EXPECT_TRUE(QTest::qWaitFor([&] { return !sink.lines.empty(); }, 30'000));
  finger_up(at);
  EXPECT_THAT(sink.lines, SizeIs(1));
}

TEST_F(ManyRobots, ALineThatIsComposedByTouchIsHeldAndEnterConfirmsATypedOne) {
  control.command_line()->set_open(true);
  control.command_line()->set_line("home r1 r4 r6 r9");
  settle_layout();
  touch(middle("commandRun"));
  EXPECT_THAT(sink.lines, IsEmpty());
  const QPoint at = middle("commandRun");
  finger_down(at);
  EXPECT_TRUE(QTest::qWaitFor([&] { return !sink.lines.empty(); }, 30'000));
  finger_up(at);
  control.command_line()->set_line("home r1 r4 r6 r9");
  settle();
  QTest::keyClick(window(), Qt::Key_Return);
  EXPECT_THAT(sink.lines, SizeIs(2));
  control.command_line()->set_line("mode r1 r4 r6 r9 hold");
  settle_layout();
  touch(middle("commandRun"));
  EXPECT_THAT(sink.lines, SizeIs(3)) << "a hold needs no confirmation";
}

}  // namespace
}  // namespace adit::gui
