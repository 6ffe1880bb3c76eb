// SPDX-License-Identifier: Apache-2.0
// The map follows a robot: by the key, and while it is driven by hand.
#include <cmath>

#include "basestation/gui/scene/map_view_3d.hpp"
#include "tests/gui/camera_fixture.hpp"
#include "tests/gui/fake_drive.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;

class FollowWindow : public CameraWindow {
 protected:
  FollowWindow() {
    world = ten_robots();
    world.robots[0].mode = "smart_joystick";
    world.robots[0].goal_state = contract::GoalState::none;
    drive_sink.show(world);
    show(world);
    control.drive()->use(drive_sink,
                         [] { return InputThread::Pad([] { return station::input::Gamepad::State{}; }); });
  }
  ~FollowWindow() override { operator_window.reset(); }
  void move_r1(float x, float y, float yaw) {
    world.robots[0].x = x;
    world.robots[0].y = y;
    world.robots[0].yaw = yaw;
    show(world);
    settle();
  }
  void drive_r1() {
    control.select("r1", false);
    control.drive()->begin("r1");
    ASSERT_TRUE(QTest::qWaitFor([&] { return control.drive()->driving(); }, 10'000));
    ASSERT_TRUE(QTest::qWaitFor([&] { return control.follow()->robot() == "r1"; }, 10'000));
    show(world);
    settle_layout();
  }
  void let_go() {
    control.drive()->letGo();
    ASSERT_TRUE(QTest::qWaitFor([&] { return !control.drive()->driving(); }, 10'000));
    settle_layout();
  }
  /// Where r1 is in the view of the map, as shares of its width and height.
  Point r1_at() {
    const Point at = map().camera().to_screen(world.robots[0].x, world.robots[0].y);
    return {at.x / map().width(), at.y / map().height()};
  }
  /// How far the heading of r1 is from up on the screen, rad.
  double heading_off() {
    const station::Robot& robot = world.robots[0];
    const Point from = map().camera().to_screen(robot.x, robot.y);
    const Point to = map().camera().to_screen(robot.x + std::cos(robot.yaw), robot.y + std::sin(robot.yaw));
    return std::abs(std::atan2(to.x - from.x, from.y - to.y));
  }

  station::World world{};
  FakeDrive drive_sink{};
  struct Release {  // The thread ends before what it uses.
    Control& control;
    ~Release() { control.drive()->stop_using(); }
  } release{control};
};

TEST_F(FollowWindow, TheKeyKeepsTheSelectedRobotInTheMiddleOfTheMapFromAbove) {
  QTest::keyClick(window(), Qt::Key_F);
  EXPECT_EQ(control.follow()->robot(), "") << "none is selected";
  control.select("r1", false);
  QTest::keyClick(window(), Qt::Key_F);
  EXPECT_EQ(control.follow()->robot(), "r1");
  EXPECT_FALSE(map().fitting());
  move_r1(18, 5, 1.0F);
  EXPECT_NEAR(r1_at().x, 0.5, 0.01);
  EXPECT_NEAR(r1_at().y, 0.5, 0.01);
  EXPECT_EQ(map().camera().turn, 0.0) << "north is up";
  const double scale = map().camera().scale;
  QTest::keyClick(window(), Qt::Key_Plus);
  EXPECT_GT(map().camera().scale, scale);
  QTest::keyClick(window(), Qt::Key_Minus);
  EXPECT_NEAR(map().camera().scale, scale, 1e-6);
  const QPoint aside = on_map(18, 5) + QPoint(120, 80);
  QWheelEvent wheel(aside, window()->mapToGlobal(aside), {}, {0, 240}, {}, {}, Qt::NoScrollPhase, false);
  QGuiApplication::sendEvent(window(), &wheel);
  EXPECT_GT(map().camera().scale, scale);
  EXPECT_NEAR(r1_at().x, 0.5, 0.01) << "the robot stays where it is, not the place under the mouse";
  picture("follow");
  settle_layout();
  touch(middle("followToggle"));
  EXPECT_EQ(control.follow()->robot(), "");
  move_r1(2, 0, 0.0F);
  EXPECT_FALSE(map().camera().shows({2, 0}) && std::abs(r1_at().x - 0.5) < 0.01);
}

TEST_F(FollowWindow, MovingTheMapEndsIt) {
  control.select("r1", false);
  QTest::keyClick(window(), Qt::Key_F);
  const QPoint at = on_map(2, 0) + QPoint(60, 60);
  drag(at, at + QPoint(100, 0));
  EXPECT_EQ(control.follow()->robot(), "");
}

TEST_F(FollowWindow, TwoFingersZoomAndTheRobotStays) {
  control.select("r1", false);
  QTest::keyClick(window(), Qt::Key_F);
  move_r1(6, 1, 0.0F);
  const QPoint at = on_map(6, 1) + QPoint(20, 60), apart(40, 0);
  /// From `apart` about the place to `wide`, whose middle is `by` away.
  const auto pinch = [&](const QPoint& wide, const QPoint& by) {
    QTest::touchEvent(window(), finger).press(0, at - apart, window()).press(1, at + apart, window());
    QTest::touchEvent(window(), finger).move(0, at - wide + by, window()).move(1, at + wide + by, window());
    QTest::touchEvent(window(), finger)
        .release(0, at - wide + by, window())
        .release(1, at + wide + by, window());
    settle();
  };
  const double scale = map().camera().scale;
  pinch(2 * apart, {0, 3});  // Fingers never spread about one place exactly.
  EXPECT_EQ(control.follow()->robot(), "r1");
  EXPECT_NEAR(map().camera().scale, 2 * scale, 0.05 * scale);
  pinch(apart, {0, 120});
  EXPECT_EQ(control.follow()->robot(), "") << "they moved the map";
}

TEST_F(FollowWindow, WhileDrivingTheHeadingIsUpAndTheRobotIsLargeEnough) {
  const Camera before = map().camera();
  ASSERT_TRUE(map().fitting());
  drive_r1();
  move_r1(6, 1, 2.2F);
  EXPECT_LT(heading_off(), 0.01);
  EXPECT_NEAR(r1_at().x, 0.5, 0.02);
  EXPECT_GT(r1_at().y, 0.5) << "there is more room ahead";
  EXPECT_GE(world.robots[0].size.length * map().camera().scale, 10.0 * Theme::instance().mm());
  picture("drive_heading_up");
  const double scale = map().camera().scale;
  QTest::keyClick(window(), Qt::Key_Minus);
  move_r1(7, 1, -2.9F);
  EXPECT_LT(map().camera().scale, scale);
  EXPECT_LT(heading_off(), 0.01);
  EXPECT_EQ(control.follow()->robot(), "r1");
  let_go();
  EXPECT_EQ(control.follow()->robot(), "");
  EXPECT_EQ(map().camera().turn, 0.0);
  EXPECT_TRUE(map().fitting());
  EXPECT_NEAR(map().camera().scale, before.scale, 1e-6) << "as before";
}

TEST_F(FollowWindow, AfterDrivingTheMapShowsThePlaceOfBefore) {
  QTest::keyClick(window(), Qt::Key_Plus);
  const QPoint at = on_map(2, 0) + QPoint(60, 60);
  drag(at, at + QPoint(100, 45));
  const Camera before = map().camera();
  ASSERT_FALSE(map().fitting());
  drive_r1();
  move_r1(6, 1, 2.2F);
  ASSERT_GT(std::abs(map().camera().x - before.x), 0.5);
  let_go();
  EXPECT_NEAR(map().camera().x, before.x, 1e-6);
  EXPECT_NEAR(map().camera().y, before.y, 1e-6);
  EXPECT_NEAR(map().camera().scale, before.scale, 1e-6);
}

TEST_F(FollowWindow, AMapThatWasMovedWhileDrivingStays) {
  drive_r1();
  const QPoint at = on_map(5, -1);
  drag(at, at + QPoint(100, 45));
  ASSERT_EQ(control.follow()->robot(), "");
  const Camera moved = map().camera();
  let_go();
  EXPECT_FALSE(map().fitting());
  EXPECT_NEAR(map().camera().scale, moved.scale, 1e-6);
}

TEST_F(FollowWindow, NorthCanBeUpWhileDriving) {
  drive_r1();
  settle_layout();
  touch(middle("headingToggle"));
  move_r1(6, 1, 2.2F);
  EXPECT_EQ(map().camera().turn, 0.0);
  EXPECT_EQ(control.follow()->robot(), "r1");
  let_go();
  drive_r1();
  EXPECT_FALSE(control.follow()->heading_up()) << "it stays as the operator chose it";
  QTest::keyClick(window(), Qt::Key_U);
  EXPECT_TRUE(control.follow()->heading_up());
  move_r1(6, 1, 2.0F);
  EXPECT_LT(heading_off(), 0.01);
}

TEST_F(FollowWindow, TheCameraHidesNeitherTheRobotNorTheButtons) {
  world.robots[0].cameras = {{.name = "front"}};
  drive_sink.show(world);
  show(world);
  drive_r1();
  ASSERT_TRUE(asked());
  take().done(outcome_of(corridor(120, 90), 3));
  move_r1(6, 1, 0.4F);
  QQuickItem* camera = item("driveCamera");
  const double left = camera->mapToScene({0, 0}).x();
  EXPECT_LT(on_map(6, 1).x(), left - 20);
  for (const char* button : {"followToggle", "headingToggle", "zoomIn"}) {
    const QQuickItem* shown = item(button);
    EXPECT_LE(shown->mapToScene({shown->width(), 0}).x(), left) << button;
  }
  picture("drive_view");
  window()->resize(1920, 1080);
  settle_layout();
  move_r1(6, 1, 0.41F);
  picture("drive_view_1080");
}

TEST_F(FollowWindow, AGoalIsSentToThePlaceUnderTheFingerOfATurnedMap) {
  control.select("r1", false);
  control.follow()->toggleHeading();
  move_r1(6, 1, 1.9F);
  ASSERT_LT(heading_off(), 0.01);
  press_slot("goto");
  ASSERT_TRUE(control.aiming());
  touch(on_map(8, 1));
  ASSERT_EQ(sink.lines.size(), 1U);
  EXPECT_TRUE(sink.lines[0].starts_with("goto r1 8.0") || sink.lines[0].starts_with("goto r1 7.9"))
      << sink.lines[0];
  EXPECT_EQ(map().marks().robot_at(map().camera().to_screen(6, 1).x, map().camera().to_screen(6, 1).y), "r1");
}

TEST_F(FollowWindow, TheMapInThreeDimensionsLooksAlongTheHeading) {
  control.set_solid(true);
  auto& solid = *static_cast<MapView3D*>(item("solid"));
  ASSERT_TRUE(QTest::qWaitFor([&] { return solid.voxels().paintings() > 0; }));
  drive_r1();
  move_r1(6, 1, 2.2F);
  EXPECT_EQ(solid.followed(), "r1");
  EXPECT_NEAR(solid.camera().yaw, 2.2, 0.01);
  QTest::qWait(300);
  picture("drive_solid");
  let_go();
  EXPECT_EQ(solid.followed(), "");
}

}  // namespace
}  // namespace adit::gui
