// SPDX-License-Identifier: Apache-2.0
// Selecting, ordering and looking in the whole window.
#include <cmath>
#include <cstdio>
#include <limits>

#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;

TEST_F(Window, LoadsWithoutAnyWarning) {
  ASSERT_NE(window(), nullptr);
  EXPECT_EQ(text("counts"), "10 robots   5 mine");
  EXPECT_EQ(control.attention()->needs().at(0).who, "r2") << "op2 stopped it";
  EXPECT_EQ(text("stopText"), "1/10 stopped");
}

TEST_F(Window, OldValuesAreFadedAndSaidToBeOld) {
  EXPECT_EQ(item("values_r1")->opacity(), 1.0);
  EXPECT_FALSE(text("age_r1").contains("old"));
  EXPECT_EQ(item("values_r7")->opacity(), 0.5);
  EXPECT_TRUE(text("age_r7").contains("old"));
}

TEST_F(Window, AStopOfAllLeavesAtFingerDown) {
  const QPoint at = middle("stopAll");
  finger_down(at);
  ASSERT_THAT(sink.lines, ElementsAre("STOP"));
  finger_up(at);
  settle();
  EXPECT_EQ(sink.lines.size(), 1U) << "a touch counts once";
  sink.pending[0]({.exit_code = 3, .error = "r5: no answer [no_answer]\n", .answers = {{.robot = "r5"}}});
  EXPECT_EQ(text("stopText"), "1/10 stopped, no answer: r5");
  QTest::keyClick(window(), Qt::Key_Pause);
  QTest::keyClick(window(), Qt::Key_S, Qt::ShiftModifier);
  EXPECT_EQ(sink.lines.size(), 3U);
}

TEST_F(Window, AStopOfAllWorksWithTwoFingersAndBesideAFingerOnTheMap) {
  const QPoint at = middle("stopAll");
  QTest::touchEvent(window(), finger).press(0, at, window()).press(1, at + QPoint(9, 0), window());
  EXPECT_EQ(sink.lines.size(), 1U);
  QTest::touchEvent(window(), finger).release(0, at, window()).release(1, at + QPoint(9, 0), window());
  finger_down(on_map(9, 0.5));
  QTest::touchEvent(window(), finger).stationary(0).press(1, at, window());
  EXPECT_EQ(sink.lines.size(), 2U);
  QTest::touchEvent(window(), finger).release(0, on_map(9, 0.5), window()).release(1, at, window());
  EXPECT_THAT(sink.lines, ElementsAre("STOP", "STOP"));
}

TEST_F(Window, ATapOnARobotSelectsItAndShiftAddsAnother) {
  settle_layout();
  touch(on_map(2, 0));
  EXPECT_THAT(control.selection(), ElementsAre("r1"));
  click(middle("card_r3"), Qt::ShiftModifier);
  EXPECT_THAT(control.selection(), ElementsAre("r1", "r3"));
  EXPECT_EQ(text("selection"), "r1 r3");
  click(on_map(16, -2));
  EXPECT_THAT(control.selection(), ElementsAre("r4"));
  QTest::keyClick(window(), Qt::Key_2);
  EXPECT_THAT(control.selection(), ElementsAre("r2"));
  QTest::keyClick(window(), Qt::Key_3, Qt::ShiftModifier);
  EXPECT_THAT(control.selection(), ElementsAre("r2", "r3"));
  QTest::keyClick(window(), Qt::Key_Escape);
  EXPECT_TRUE(control.selection().empty());
}

TEST_F(Window, ANewlyHeardRobotKeepsTheSelection) {
  control.select("r1", false);
  station::World world = ten_robots();
  world.robots.insert(world.robots.begin(), robot("a0", 3, 3));
  show(world);
  EXPECT_THAT(control.selection(), ElementsAre("r1"));
  EXPECT_EQ(text("selection"), "r1");
}

void expect_goto(const std::string& line, const std::string& robot, double x, double y) {
  char name[16] = {};
  double got_x = 0, got_y = 0;
  ASSERT_EQ(std::sscanf(line.c_str(), "goto %15s %lf %lf", name, &got_x, &got_y), 3) << line;
  EXPECT_EQ(name, robot);
  EXPECT_NEAR(got_x, x, 0.06);  // A pixel is 5.4 cm.
  EXPECT_NEAR(got_y, y, 0.06);
}

TEST_F(Window, ALongPressSendsTheSelectionThereAtTheReleaseOfTheFinger) {
  control.select("r1", false);
  const QPoint at = on_map(9, 0.5);
  finger_down(at);
  QTest::qWait(GestureArea::kLongPress + 100);
  EXPECT_TRUE(sink.lines.empty()) << "only a ghost";
  picture("ghost");
  finger_up(at);
  ASSERT_EQ(sink.lines.size(), 1U);
  const Point meant = map().camera().to_map(map().mapFromScene(at).x(), map().mapFromScene(at).y());
  expect_goto(sink.lines[0], "r1", meant.x, meant.y);
  sink.pending[0]({.text = "r1: driving to 9.00 0.50\n"});
  EXPECT_EQ(text("outcome"), "✓ r1: driving to 9.00 0.50");
}

TEST_F(Window, AFingerThatMovesPansAndSendsNothing) {
  control.select("r1", false);
  const double before = map().camera().x;
  const QPoint at = on_map(9, 0.5);
  finger_down(at);
  QTest::qWait(GestureArea::kLongPress + 100);
  QTest::touchEvent(window(), finger).move(0, at + QPoint(60, 0), window());
  finger_up(at + QPoint(60, 0));
  EXPECT_TRUE(sink.lines.empty());
  EXPECT_NEAR(map().camera().x, before - 60 / map().camera().scale, 1e-6);
  EXPECT_FALSE(map().fitting());
  ASSERT_TRUE(sink.looked);
  EXPECT_NEAR(sink.looked->x, map().camera().x, 1e-6);
  EXPECT_TRUE(station::valid(*sink.looked));
  map().fitAll();
  EXPECT_FALSE(sink.looked) << "who sees all looks at no place";
}

TEST_F(Window, AShortTapOnTheFloorSendsNothing) {
  control.select("r1", false);
  touch(on_map(7, 0.8));
  EXPECT_TRUE(sink.lines.empty());
  EXPECT_THAT(control.selection(), ElementsAre("r1"));
}

TEST_F(Window, GoToByKeyThenATap) {
  control.select("r1", false);
  QTest::keyPress(window(), Qt::Key_G);
  EXPECT_FALSE(control.aiming()) << "letters that start motion act at the release";
  QTest::keyRelease(window(), Qt::Key_G);
  EXPECT_TRUE(control.aiming());
  const QPoint at = on_map(12, -1);
  touch(at);
  ASSERT_EQ(sink.lines.size(), 1U);
  const QPointF local = map().mapFromScene(at);
  const Point meant = map().camera().to_map(local.x(), local.y());
  expect_goto(sink.lines[0], "r1", meant.x, meant.y);
  EXPECT_FALSE(control.aiming());
}

TEST_F(Window, ARightClickSendsSeveralRobotsApart) {
  control.select("r1", false);
  control.select("r4", true);
  control.select("r3", true);  // Another operator's: it is left out.
  QTest::mouseClick(window(), Qt::RightButton, {}, on_map(12, 0));
  ASSERT_EQ(sink.lines.size(), 2U);
  EXPECT_TRUE(sink.lines[0].starts_with("goto r1 "));
  EXPECT_TRUE(sink.lines[1].starts_with("goto r4 "));
  EXPECT_NE(sink.lines[0].substr(8), sink.lines[1].substr(8));
}

TEST_F(Window, TwoFingersZoomAboutTheirMiddleAndAThirdIsAPalm) {
  const QPoint at = on_map(10, 0);
  const double before = map().camera().scale;
  const Point place = map().camera().to_map(map().mapFromScene(at).x(), map().mapFromScene(at).y());
  QTest::touchEvent(window(), finger)
      .press(0, at - QPoint(50, 0), window())
      .press(1, at + QPoint(50, 0), window());
  QTest::touchEvent(window(), finger)
      .move(0, at - QPoint(100, 0), window())
      .move(1, at + QPoint(100, 0), window());
  QTest::touchEvent(window(), finger)
      .release(0, at - QPoint(100, 0), window())
      .release(1, at + QPoint(100, 0), window());
  EXPECT_NEAR(map().camera().scale, 2 * before, 0.05 * before);
  const Point after = map().camera().to_map(map().mapFromScene(at).x(), map().mapFromScene(at).y());
  EXPECT_NEAR(after.x, place.x, 0.05);
  const double scale = map().camera().scale;
  QTest::touchEvent(window(), finger)
      .press(0, at, window())
      .press(1, at + QPoint(30, 0), window())
      .press(2, at + QPoint(60, 0), window());
  QTest::touchEvent(window(), finger).move(0, at - QPoint(90, 0), window()).stationary(1).stationary(2);
  QTest::touchEvent(window(), finger)
      .release(0, at, window())
      .release(1, at, window())
      .release(2, at, window());
  EXPECT_EQ(map().camera().scale, scale);
  EXPECT_TRUE(sink.lines.empty());
}

TEST_F(Window, TakesWhatNobodyHoldsByATap) {
  control.select("r7", false);
  press_slot("take");
  ASSERT_THAT(sink.lines, ElementsAre("take r7")) << text("outcome").toStdString();
  sink.pending[0]({.exit_code = 1, .error = "r7: refused: locked by op2 [locked]\n"});
  EXPECT_EQ(text("outcome"), "r7: refused: locked by op2 [locked]");
}

TEST_F(Window, WhatWasTakenBackIsNotSentByAFingerThatIsStillDown) {
  const QPoint at = on_map(9, 0.5);
  const std::vector<std::function<void()>> ways{[&] { control.stopAll(); },
                                                [&] { QTest::keyClick(window(), Qt::Key_Escape); },
                                                [&] { control.select("r6", false); }};
  for (const auto& take_back : ways) {
    control.select("r1", false);
    finger_down(at);
    QTest::qWait(GestureArea::kLongPress + 100);
    take_back();
    QTest::qWait(GestureArea::kLongPress + 100);
    finger_up(at);
    settle();
  }
  EXPECT_THAT(sink.lines, ElementsAre("STOP"));
  control.select("r1", false);
  finger_down(at);
  QTest::qWait(GestureArea::kLongPress + 100);
  finger_up(at);
  settle();
  EXPECT_EQ(sink.lines.size(), 2U) << "the next press counts again";
}

TEST_F(Window, AStopAndAnotherSelectionTakeBackWhatKeysBegan) {
  control.select("r2", false);
  QTest::keyClick(window(), Qt::Key_E, Qt::ShiftModifier);
  QTest::keyClick(window(), Qt::Key_Pause);
  QTest::keyClick(window(), Qt::Key_Return);
  EXPECT_THAT(sink.lines, ElementsAre("STOP"));
  control.select("r1", false);
  QTest::keyPress(window(), Qt::Key_W);
  QTest::keyClick(window(), Qt::Key_Pause);
  QTest::keyRelease(window(), Qt::Key_W);
  EXPECT_THAT(sink.lines, ElementsAre("STOP", "STOP"));
  QTest::keyPress(window(), Qt::Key_W);
  QTest::keyClick(window(), Qt::Key_Up);
  QTest::keyRelease(window(), Qt::Key_W);
  EXPECT_EQ(sink.lines.size(), 2U);
  QTest::keyClick(window(), Qt::Key_W, Qt::AltModifier);
  EXPECT_EQ(sink.lines.size(), 2U);
  QTest::keyClick(window(), Qt::Key_W);
  EXPECT_EQ(sink.lines.size(), 3U) << "alone, it is sent";
}

TEST_F(Window, ASecondTapOnLockDoesNotUnlock) {
  control.select("r1", false);
  press_slot("lock");
  ASSERT_THAT(sink.lines, ElementsAre("lock r1"));
  station::World world = ten_robots();
  world.robots[0].locked = true;
  show(world);
  touch(middle("button_lock"));
  EXPECT_EQ(sink.lines.size(), 1U);
  press_slot("lock");
  EXPECT_THAT(sink.lines, ElementsAre("lock r1", "unlock r1"));
}

TEST_F(Window, TakesFromAnotherOperatorOnlyByHolding) {
  control.select("r3", false);
  press_slot("take");
  EXPECT_TRUE(sink.lines.empty());
  const QPoint at = middle("button_take");
  finger_down(at);
  QTest::qWait(200);
  picture("holding");
  EXPECT_TRUE(sink.lines.empty());
  QTest::qWait(1000);
  EXPECT_THAT(sink.lines, ElementsAre("take r3"));
  finger_up(at);
  settle();
  EXPECT_EQ(sink.lines.size(), 1U);
  // By keyboard: the key, then Enter.
  QTest::keyClick(window(), Qt::Key_T);
  EXPECT_EQ(sink.lines.size(), 1U);
  QTest::keyClick(window(), Qt::Key_Return);
  EXPECT_EQ(sink.lines.size(), 2U);
  QTest::keyClick(window(), Qt::Key_Return);
  EXPECT_EQ(sink.lines.size(), 2U);
}

TEST_F(Window, WhatIsNotPossibleSaysWhyAndOffersTheCure) {
  control.select("r7", false);
  settle_layout();
  EXPECT_TRUE(text("notNow").startsWith("not now ("));
  touch(middle("notNow"));
  EXPECT_TRUE(control.reasons_open());
  settle_layout();
  picture("reasons");
  touch(middle("cure_0"));
  EXPECT_THAT(sink.lines, ElementsAre("take r7"));
  press_slot("goto");
  EXPECT_TRUE(text("outcome").contains("r7:")) << text("outcome").toStdString();
  EXPECT_FALSE(control.aiming());
}

TEST_F(Window, APressOnAButtonThatChangesUnderTheFingerCountsForNothing) {
  control.select("r7", false);
  settle_layout();
  const QPoint at = middle("button_take");
  finger_down(at);
  control.select("rx", false);  // It could be taken, too.
  finger_up(at);
  settle();
  EXPECT_TRUE(sink.lines.empty());
}

TEST_F(Window, ASilentStationIsSaidAndOnlyAStopIsTried) {
  control.select("r1", false);
  control.show_link(true, 4.0, "");
  settle_layout();
  EXPECT_TRUE(item("silent")->isVisible());
  EXPECT_TRUE(text("silent").startsWith("STATION SILENT for 4.0 s"));
  touch(middle("button_mode_hold"));
  EXPECT_TRUE(sink.lines.empty());
  touch(middle("button_stop"));
  EXPECT_THAT(sink.lines, ElementsAre("STOP r1"));
  picture("silent");
  control.show_link(false, 9.0, "the station ended");
  EXPECT_TRUE(text("silent").startsWith("NO STATION: the station ended"));
  show(ten_robots());
  control.show_link(true, 0.0, "");
  EXPECT_FALSE(item("silent")->isVisible());
}

TEST_F(Window, TextsByRadioAreNeverMarkup) {
  station::World world{.station = "op1"};
  world.robots = {robot("<b>x</b>", 0, 0)};
  world.robots[0].troubles = {"<img src='file:///etc/passwd'>"};
  show(world);
  control.add_notice({{.code = "found", .text = "<h1>hello</h1>", .robot = "<b>x</b>"}});
  settle();
  EXPECT_EQ(text("cardName"), "<b>x</b>");
  int texts = 0;
  const auto check = [&](auto&& self, QQuickItem* top) -> void {
    for (QQuickItem* child : top->childItems()) {
      if (const QVariant format = child->property("textFormat"); format.isValid()) {
        EXPECT_EQ(format.toInt(), 0) << child->property("text").toString().toStdString();  // Text.PlainText
        ++texts;
      }
      self(self, child);
    }
  };
  check(check, window()->contentItem());
  EXPECT_GT(texts, 30);
}

TEST_F(Window, PlacesThatAreNoPlacesDoNoHarm) {
  station::World world = ten_robots();
  world.robots[0].x = 1e30F;
  world.robots[1].y = std::numeric_limits<float>::quiet_NaN();
  world.robots[2].goal = {std::numeric_limits<double>::infinity(), 0, 0};
  world.robots[3].vx = 1e30F;
  show(world);
  map().fitAll();
  settle();
  EXPECT_TRUE(std::isfinite(map().camera().scale));
  EXPECT_LT(std::abs(map().camera().x), 100.0);
}

TEST_F(Window, AFingerThatDragsTheCardsScrollsAndSelectsNothing) {
  settle_layout();
  const QPoint at = middle("card_r3");
  finger_down(at);
  for (int i = 1; i <= 10; ++i) {
    QTest::touchEvent(window(), finger).move(0, at - QPoint(0, 12 * i), window());
    QTest::qWait(20);  // Moves within a frame are one.
  }
  finger_up(at - QPoint(0, 120));
  settle();
  EXPECT_TRUE(control.selection().empty());
  EXPECT_GT(item("fleet")->property("contentY").toDouble(), 20.0);
}

TEST_F(Window, AStationOfAnotherVersionIsSaid) {
  control.show_link(true, 0.0, "the station speaks another version: 'robots' does not fit");
  EXPECT_TRUE(item("silent")->isVisible());
  EXPECT_TRUE(text("silent").contains("another version"));
}

TEST_F(Window, TwoHundredRobotsAreShownInTime) {
  station::World world{.station = "op1"};
  for (int i = 0; i < 200; ++i)
    world.robots.push_back(mine(robot("r" + std::to_string(1000 + i), static_cast<float>(i % 20) * 3,
                                      static_cast<float>(i / 20) * 3)));
  show(world);
  settle();
  QElapsedTimer timer;
  timer.start();
  for (int i = 0; i < 10; ++i) {
    for (station::Robot& robot : world.robots) robot.x += 0.2F;
    show(world);
    window()->grabWindow();
  }
  EXPECT_LT(timer.elapsed(), 10000) << "ten snapshots";
  picture("two_hundred");
}

TEST_F(Window, ACommandOfAnotherProgramIsInTheLog) {
  control.add_command(
      {.id = 1, .ended = true, .line = "take r1", .front_end = "shell", .pid = 1, .text = "r1: taken\n"});
  control.add_notice(blocked_notice());
  EXPECT_EQ(control.log()->rowCount(), 2);
  EXPECT_EQ(control.log()->data(control.log()->index(1, 0), Qt::UserRole + 3).toString(), "in another shell");
  for (int i = 0; i < 10000; ++i) control.add_remark("line");
  EXPECT_EQ(control.log()->rowCount(), static_cast<int>(Control::kMaxLog));
  settle();
}

TEST_F(Window, NothingIsRepaintedWhileNothingChanges) {
  QTest::qWait(200);
  int frames = 0;
  QObject::connect(window(), &QQuickWindow::frameSwapped, [&] { ++frames; });
  QTest::qWait(300);
  EXPECT_EQ(frames, 0);
}

// What the user page shows; also what the author looked at.
TEST_F(Window, PicturesOfBothThemesAndSizes) {
  control.add_notice(blocked_notice());
  control.add_notice({{.code = "taken", .text = "taken by op2", .robot = "r3"}});
  control.add_command({.id = 1,
                       .ended = true,
                       .line = "mode r6 explore",
                       .front_end = "shell",
                       .pid = 1,
                       .text = "r6: exploring\n"});
  control.select("r1", false);
  control.select("r4", true);
  picture("window");
  picture("grey", true);
  Theme::instance().set_light(true);
  picture("light");
  control.select("r3", false);
  control.set_reasons_open(true);
  window()->resize(1920, 1080);
  settle();
  picture("light_1080");
  Theme::instance().set_light(false);
  picture("dark_1080");
  QQuickItem* stop = item("stopAll");
  EXPECT_LT(stop->mapToScene({stop->width(), 0}).x(), 1920.0);
}

}  // namespace
}  // namespace adit::gui
