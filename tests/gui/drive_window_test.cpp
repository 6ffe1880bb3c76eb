// SPDX-License-Identifier: Apache-2.0
// Driving by hand in the whole window: what reaches the station.
#include <atomic>
#include <mutex>

#include "tests/gui/fake_drive.hpp"
#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

using station::input::Gamepad;
using testing::ElementsAre;

class DriveWindow : public Window {
 protected:
  DriveWindow() {
    drive_sink.show(manual("r1"));
    control.drive()->use(drive_sink, [this] {
      InputThread::Pad out([this] {
        const std::lock_guard guard(pad_mutex);
        return pad;
      });
      out.rumble = [this](double strength, std::chrono::milliseconds) { rumble = strength; };
      return out;
    });
  }
  ~DriveWindow() override { operator_window.reset(); }
  /// The ten robots, that one in a mode by hand.
  static station::World manual(const std::string& name) {
    station::World world = ten_robots();
    for (station::Robot& robot : world.robots)
      if (robot.name == name) robot.mode = "smart_joystick", robot.goal_state = contract::GoalState::none;
    return world;
  }
  void set_pad(const Gamepad::State& state) {
    const std::lock_guard guard(pad_mutex);
    pad = state;
  }
  void begin(const QString& robot = "r1") {
    control.select(robot, false);
    QTest::keyClick(window(), Qt::Key_M);
    ASSERT_TRUE(QTest::qWaitFor([&] { return control.drive()->driving(); }));
    settle();
  }
  static bool soon(const std::function<bool()>& holds, int ms = 30'000) { return QTest::qWaitFor(holds, ms); }
  bool moves() { return drive_sink.last().vx != 0.0 || drive_sink.last().wz != 0.0; }

  std::mutex pad_mutex{};
  Gamepad::State pad{};
  std::atomic<double> rumble{0.0};
  std::uint64_t notices{1000};
  FakeDrive drive_sink{};
  struct Release {  // The thread ends before what it uses.
    Control& control;
    ~Release() { control.drive()->stop_using(); }
  } release{control};
};

TEST_F(DriveWindow, AFingerOnTheStickDrivesAndALiftedOneIsZero) {
  begin();
  EXPECT_THAT(drive_sink.robots(), ElementsAre("r1"));
  EXPECT_EQ(text("driveTitle"), "DRIVING r1");
  const QPoint at = middle("touchStick");
  finger_down(at - QPoint(0, 40));
  ASSERT_TRUE(soon([&] { return drive_sink.last().vx > 0.1; }));
  picture("driving");
  QTest::touchEvent(window(), finger).move(0, at - QPoint(40, 0), window());
  ASSERT_TRUE(soon([&] { return drive_sink.last().wz > 0.1 && drive_sink.last().vx < 0.1; }))
      << "left turns left";
  finger_up(at - QPoint(40, 0));
  EXPECT_TRUE(soon([&] { return !moves(); }));
}

TEST_F(DriveWindow, TheStickIsBoundToItsRobotAndNotToTheSelection) {
  begin();
  control.select("r4", false);
  const QPoint at = middle("touchStick");
  finger_down(at - QPoint(0, 40));
  ASSERT_TRUE(soon([&] { return moves(); }));
  EXPECT_EQ(drive_sink.last_drive(), 1);
  EXPECT_THAT(drive_sink.robots(), ElementsAre("r1")) << "r4 is selected and not driven";
  EXPECT_EQ(text("driveTitle"), "DRIVING r1");
  finger_up(at);
}

TEST_F(DriveWindow, KeysDriveWhileTheyAreDown) {
  begin();
  QTest::keyPress(window(), Qt::Key_Up);
  ASSERT_TRUE(soon([&] { return drive_sink.last().vx > 0.1; }));
  QTest::keyRelease(window(), Qt::Key_Up);
  EXPECT_TRUE(soon([&] { return !moves(); }));
  QTest::keyPress(window(), Qt::Key_W);
  ASSERT_TRUE(soon([&] { return moves(); }));
  control.forgetKeys();  // The window is not active any more: no release will come.
  EXPECT_TRUE(soon([&] { return !moves(); }));
  EXPECT_TRUE(sink.lines.empty()) << "letters are no actions while driving";
}

TEST_F(DriveWindow, EscapeLetsGoAndThePauseKeyStopsAll) {
  begin();
  QTest::keyClick(window(), Qt::Key_Pause);
  EXPECT_THAT(sink.lines, ElementsAre("STOP"));
  QTest::keyClick(window(), Qt::Key_Escape);
  EXPECT_TRUE(soon([&] { return !control.drive()->driving(); }));
  EXPECT_EQ(drive_sink.cancelled(), 1U);
  EXPECT_FALSE(moves());
  EXPECT_THAT(control.selection(), ElementsAre("r1")) << "one key, one step";
}

TEST_F(DriveWindow, AFrozenWindowLetsGoAndThePadStillStops) {
  set_pad({.present = true, .stick = {1.0, 0, 0}, .shoulder = true});
  begin();
  ASSERT_TRUE(soon([&] { return moves(); }));
  // The window's thread hangs: no event loop runs, and no sign of life is given.
  const auto hangs_until = [](const std::function<bool()>& holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!holds() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    return holds();
  };
  EXPECT_TRUE(hangs_until([&] { return !moves(); })) << "zero comes without it";
  set_pad({.present = true, .stick = {1.0, 0, 0}, .shoulder = true, .stop_all = true});
  EXPECT_TRUE(hangs_until([&] { return !drive_sink.halts().empty(); }));
  EXPECT_THAT(drive_sink.halts(), ElementsAre("all"));
}

TEST_F(DriveWindow, APadThatIsPulledOutEndsItAndSaysSo) {
  set_pad({.present = true, .stick = {1.0, 0, 0}, .shoulder = true});
  begin();
  ASSERT_TRUE(soon([&] { return moves(); }));
  set_pad({});
  ASSERT_TRUE(soon([&] { return !control.drive()->driving(); }));
  EXPECT_FALSE(moves());
  EXPECT_TRUE(control.outcome().contains("game controller is gone")) << control.outcome().toStdString();
}

TEST_F(DriveWindow, AStopButtonOfThePadStopsTheDrivenRobotAlone) {
  set_pad({.present = true});
  begin();
  control.select("r4", false);
  set_pad({.present = true, .stop = true});
  ASSERT_TRUE(soon([&] { return !drive_sink.halts().empty(); }));
  EXPECT_THAT(drive_sink.halts(), ElementsAre("r1"));
}

TEST_F(DriveWindow, AnOldStateIsZeroAndTheFrameSaysSo) {
  begin();
  const QPoint at = middle("touchStick");
  finger_down(at - QPoint(0, 40));
  ASSERT_TRUE(soon([&] { return moves(); }));
  drive_sink.silent = 1.0;
  EXPECT_TRUE(soon([&] { return !moves(); }));
  ASSERT_TRUE(soon([&] { return text("driveWhy").contains("state is old"); }));
  finger_up(at);
}

TEST_F(DriveWindow, WhatTheStationRefusesIsShownAndDrivesNothing) {
  begin();
  drive_sink.done()({.exit_code = 1, .error = "r1: refused: the planner starts\n"});
  ASSERT_TRUE(soon([&] { return !control.drive()->driving(); }));
  EXPECT_TRUE(control.outcome().contains("the planner starts"));
  // The outcome of an earlier drive ends nothing.
  const DriveSink::Done earlier = drive_sink.done();
  begin();
  earlier({.exit_code = 1, .error = "cancelled"});
  settle();
  EXPECT_TRUE(control.drive()->driving());
}

TEST_F(DriveWindow, OnlyOneRobotOfMineCanBeDriven) {
  control.select("r3", false);
  QTest::keyClick(window(), Qt::Key_M);
  EXPECT_FALSE(control.drive()->driving());
  EXPECT_EQ(control.outcome_kind(), "refused");
  control.select("r1", false);
  control.select("r4", true);
  QTest::keyClick(window(), Qt::Key_M);
  EXPECT_FALSE(control.drive()->driving());
  EXPECT_TRUE(drive_sink.robots().empty());
}

TEST_F(DriveWindow, TheDirectionalPadSelectsTheNextRobotWhileNoneIsDriven) {
  control.select("r1", false);
  set_pad({.present = true});
  ASSERT_TRUE(soon([&] { return control.drive()->pad(); }));
  set_pad({.present = true, .next = true});
  EXPECT_TRUE(soon([&] { return control.selection() == std::vector<std::string>{"r2"}; }));
  set_pad({.present = true, .previous = true});
  EXPECT_TRUE(soon([&] { return control.selection() == std::vector<std::string>{"r1"}; }));
}

TEST_F(DriveWindow, XTakesAFreeRobotAtOnceAndOneOfAnotherOnlyWhenHeld) {
  set_pad({.present = true});
  ASSERT_TRUE(soon([&] { return control.drive()->pad(); }));
  control.select("r7", false);
  set_pad({.present = true, .take = true});
  ASSERT_TRUE(soon([&] { return !sink.lines.empty(); }));
  EXPECT_THAT(sink.lines, ElementsAre("take r7"));
  set_pad({.present = true});
  control.select("r3", false);
  settle_layout();
  set_pad({.present = true, .take = true});
  ASSERT_TRUE(soon([&] { return control.outcome().contains("keep the button held"); }));
  EXPECT_THAT(sink.lines, ElementsAre("take r7"));
  ASSERT_TRUE(soon([&] { return sink.lines.size() == 2; }));
  EXPECT_EQ(sink.lines.back(), "take r3");
}

TEST_F(DriveWindow, TheControllerVibratesForUrgentAlertsAndForObstaclesOfTheDrivenRobot) {
  begin();
  const auto notice = [&](const char* robot, const char* code) {
    rumble = 0.0;
    control.add_notice(my_notice(++notices, robot, code, code));
  };
  notice("r4", "arrived");
  notice("r4", "obstacle_near");
  QTest::qWait(100);
  EXPECT_EQ(rumble, 0.0);
  notice("r1", "obstacle_near");
  EXPECT_TRUE(soon([&] { return rumble == 0.5; }));
  notice("r4", "stopped");
  EXPECT_TRUE(soon([&] { return rumble == 1.0; }));
}

}  // namespace
}  // namespace adit::gui
