// SPDX-License-Identifier: Apache-2.0
// Live pictures of a robot's camera in the pane of its details.
#include "tests/gui/camera_fixture.hpp"
#include "tests/gui/fake_drive.hpp"

namespace adit::gui {
namespace {

TEST_F(CameraWindow, PicturesAreAskedForOnlyWhileTheyAreShown) {
  open_details();
  EXPECT_TRUE(sink.cameras.empty()) << "the details alone cause no traffic";
  touch(middle("cameraSwitch"));
  ASSERT_TRUE(asked());
  EXPECT_EQ(sink.cameras.front().request.robot, "r1");
  EXPECT_EQ(sink.cameras.front().request.camera, "front");
  EXPECT_GT(sink.cameras.front().request.width, 200);
  EXPECT_EQ(caption(), "r1 front: waits for a picture");
  take().done(outcome_of(corridor(170, 30), 7));
  ASSERT_TRUE(asked()) << "the next one";
  EXPECT_EQ(sink.cameras.front().request.after, 7U);
  const QColor wall = colour_at(0.05, 0.3);
  EXPECT_GT(wall.red(), 140) << wall.name().toStdString();
  EXPECT_TRUE(caption().startsWith("r1 front, 0.")) << caption().toStdString();
  picture("detail_camera");
  control.details()->set_open(false);
  take().done(outcome_of(corridor(170, 30), 8));
  QTest::qWait(50);
  EXPECT_TRUE(sink.cameras.empty()) << "no one looks";
}

TEST_F(CameraWindow, APictureOfAnotherCameraNeverStaysInView) {
  open_details();
  control.details()->set_camera_on(true);
  ASSERT_TRUE(asked());
  take().done(outcome_of(corridor(170, 30), 7));
  ASSERT_TRUE(asked());
  auto late = take();
  touch(middle("nextCamera"));
  ASSERT_TRUE(asked());
  EXPECT_EQ(sink.cameras.front().request.camera, "back");
  EXPECT_EQ(sink.cameras.front().request.after, 0U);
  EXPECT_TRUE(camera()->is_empty());
  late.done(outcome_of(corridor(170, 30), 8));
  QTest::qWait(50);
  EXPECT_TRUE(camera()->is_empty()) << "an answer for the camera before";
  control.select("r3", false);
  settle_layout();
  EXPECT_FALSE(find_item(window(), "detailCamera")->isVisible()) << "r3 has no camera";
}

TEST_F(CameraWindow, AnOldPictureIsGreyAndSaysItsAge) {
  open_details();
  control.details()->set_camera_on(true);
  ASSERT_TRUE(asked());
  take().done(outcome_of(corridor(170, 30), 7, 4.0));
  ASSERT_TRUE(QTest::qWaitFor([&] { return camera()->is_stale(); }, 10'000));
  const QColor wall = colour_at(0.05, 0.3);
  EXPECT_LT(std::abs(wall.red() - wall.green()), 12) << wall.name().toStdString();
  EXPECT_TRUE(caption().startsWith("r1 front, 4")) << caption().toStdString();
  picture("detail_camera_old");
}

TEST_F(CameraWindow, LostStripesAreMarked) {
  open_details();
  control.details()->set_camera_on(true);
  ASSERT_TRUE(asked());
  take().done(outcome_of(corridor(170, 30), 7));
  ASSERT_TRUE(asked());
  // Of two stripes of 160 pixels in each row of 16, both of the fifth row.
  take().done(outcome_of(corridor(170, 30), 8, 0.2, {0, 0b11}));
  ASSERT_TRUE(asked());
  const QColor lost = colour_at(0.05, 72.0 / 240.0), fresh = colour_at(0.05, 40.0 / 240.0);
  EXPECT_LT(std::abs(lost.red() - lost.green()), 20) << lost.name().toStdString();
  EXPECT_GT(fresh.red() - fresh.green(), 100) << fresh.name().toStdString();
  EXPECT_TRUE(caption().endsWith("parts lost")) << caption().toStdString();
  picture("detail_camera_lost");
}

TEST_F(CameraWindow, WhatCannotBeShownSaysWhy) {
  open_details();
  control.details()->set_camera_on(true);
  ASSERT_TRUE(asked());
  take().done({.exit_code = 1, .error = "more than 16 cameras at once\n"});
  ASSERT_TRUE(QTest::qWaitFor([&] { return caption().contains("more than 16"); }, 10'000));
  ASSERT_TRUE(asked()) << "it tries again";
  take().done({.json = "{\"robot\":\"r1\",\"number\":3,\"jpeg\":\"AAAA\",\"width\":9}"});
  ASSERT_TRUE(QTest::qWaitFor([&] { return caption().contains("do not fit"); }, 10'000));
}

TEST_F(CameraWindow, TheKeyCShowsAndHidesIt) {
  show_cameras();
  control.select("r1", false);
  settle_layout();
  QTest::keyClick(window(), Qt::Key_C);
  ASSERT_TRUE(asked());
  EXPECT_TRUE(control.details()->is_open());
  QTest::keyClick(window(), Qt::Key_C);
  settle_layout();
  EXPECT_FALSE(find_item(window(), "detailCamera")->isVisible());
}

TEST_F(CameraWindow, WhoDrivesSeesThePictureBesideTheMapAndCanStopTheRobot) {
  FakeDrive drive;
  station::World world = ten_robots();
  world.robots[0].cameras = {{.name = "front"}};
  world.robots[0].mode = "smart_joystick";
  world.robots[0].goal_state = contract::GoalState::none;
  drive.show(world);
  show(world);
  control.drive()->use(drive,
                       [] { return InputThread::Pad([] { return station::input::Gamepad::State{}; }); });
  struct Release {  // The thread ends before what it uses.
    Control& control;
    ~Release() { control.drive()->stop_using(); }
  } release{control};
  EXPECT_FALSE(find_item(window(), "driveCamera")->isVisible());
  control.drive()->begin("r1");
  ASSERT_TRUE(QTest::qWaitFor([&] { return control.drive()->driving(); }, 10'000));
  settle_layout();
  ASSERT_TRUE(asked());
  EXPECT_GT(sink.cameras.front().request.width, 300);
  take().done(outcome_of(corridor(120, 90), 3));
  ASSERT_TRUE(QTest::qWaitFor([&] { return text("driveCameraCaption").contains("old"); }, 10'000));
  picture("driving_with_camera");
  touch(middle("driveStop"));
  EXPECT_TRUE(std::ranges::find(sink.lines, "STOP r1") != sink.lines.end());
}

}  // namespace
}  // namespace adit::gui
