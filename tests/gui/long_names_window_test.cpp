// SPDX-License-Identifier: Apache-2.0
// Texts that state a danger are never cut, also with the longest names, at 1280x720.
#include "tests/gui/fake_drive.hpp"
#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

/// A name of 32 characters, the most that there are.
std::string longest(const std::string& kind, int number) {
  std::string name = kind + "-of-the-north-wing-and-shaft";
  name.resize(30, 'x');
  return name + (number < 10 ? "0" : "") + std::to_string(number);
}

class LongNames : public Window {
 protected:
  LongNames() {
    world = ten_robots();
    for (std::size_t i = 0; i < world.robots.size(); ++i)
      world.robots[i].name = longest("rescue-robot", static_cast<int>(i) + 1);
    const std::string op2 = longest("operator", 2), op3 = longest("operator", 3);
    world.stations[1].name = op2;
    world.stations.push_back({.name = op3, .age = 1.0});
    for (station::Robot& robot : world.robots) {
      for (std::string& stopper : robot.stops) stopper = op2;
      if (!robot.holder.empty() && !robot.mine) robot.holder = op2;
    }
    world.robots[1].stops = {op2, op3};
    world.robots[6].mode = "smart_joystick";
    world.robots[6].reason = Reason::odometry_jumped;
    world.robots[8].troubles = {"planner hung", "router failed", "sensors failed", "map failed"};
    show(world);
  }
  std::string name(int number) const { return world.robots[static_cast<std::size_t>(number) - 1].name; }
  void select(const std::vector<int>& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      control.select(QString::fromStdString(name(numbers[i])), i > 0);
  }
  void say(int robot, const std::string& code, const std::string& text) {
    control.add_notice(my_notice(++id, name(robot), code, text));
    show(world);
  }
  /// Fails for every such text that is shown and cut. Returns how many are shown.
  int expect_whole(const char* state) {
    settle();
    int shown = 0;
    const auto walk = [&](auto&& self, QQuickItem* item) -> void {
      if (!item->isVisible() || item->opacity() <= 0.0) return;
      if (item->inherits("QQuickText") && !item->property("text").toString().isEmpty()) {
        const QString group = item->objectName().section('_', 0, 0);
        if (kDangers.contains(group)) {
          ++shown;
          EXPECT_FALSE(item->property("truncated").toBool())
              << state << ", " << group.toStdString() << ": "
              << item->property("text").toString().toStdString();
        }
      }
      for (QQuickItem* child : item->childItems()) self(self, child);
    };
    walk(walk, window()->contentItem());
    picture(QString("long_names_") + state);
    return shown;
  }

  /// What a robot does or suffers, who did it, and what a press would do to whom.
  static inline const QStringList kDangers{
      "buttonHint", "buttonLabel", "need",       "who",      "headlineText", "detail",    "stopText",
      "silent",     "outcome",     "driveTitle", "driveWhy", "reason",       "driveAsked"};
  station::World world{};
  std::uint64_t id{100};
};

TEST_F(LongNames, OnCardsAndAtTheButtons) {
  EXPECT_GT(expect_whole("nothing_selected"), 20);
  select({3});
  EXPECT_GT(expect_whole("take_from_another"), 30);
  select({2});
  expect_whole("stops_of_others");
  select({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  control.set_reasons_open(true);
  expect_whole("all_selected");
  control.set_reasons_open(false);
  QTest::keyClick(window(), Qt::Key_T);
  EXPECT_EQ(control.outcome_kind(), "sent");
  expect_whole("key_asks_for_enter");
}

TEST_F(LongNames, OfAStop) {
  control.stopAll();
  station::CommandOutcome outcome{.exit_code = 3};
  for (const station::Robot& robot : world.robots) {
    outcome.answers.push_back({.robot = robot.name});
    outcome.error += robot.name + ": no answer [no_answer]\n";
  }
  sink.pending.back()(outcome);
  expect_whole("stop_without_answers");
  EXPECT_TRUE(text("stopText").contains("no answer")) << text("stopText").toStdString();
}

TEST_F(LongNames, OfWhatNeedsTheOperator) {
  say(4, "asked", world.stations[1].name + " asked for " + name(4));
  expect_whole("asked");
  control.attention()->set_open(true);
  expect_whole("asked_open");
  for (const int robot : {1, 2, 4, 6}) {
    world.robots[static_cast<std::size_t>(robot) - 1].stopped = true;
    world.robots[static_cast<std::size_t>(robot) - 1].stops = {world.stations[1].name};
  }
  control.attention()->set_open(false);
  for (const int robot : {1, 2, 4, 6})
    say(robot, "stopped", world.stations[1].name + " stopped " + name(robot));
  expect_whole("stopped");
  control.attention()->set_open(true);
  expect_whole("stopped_open");
}

TEST_F(LongNames, OfASilentStationAndWhileDriving) {
  control.show_link(true, 4.0, "");
  expect_whole("silent");
  control.show_link(false, 4.0, "the station ended: its socket was closed by the other side, status 137");
  expect_whole("ended");
  FakeDrive drive_sink;
  world.robots[0].mode = "smart_joystick";
  show(world);
  drive_sink.show(world);
  control.drive()->use(drive_sink, [] { return [] { return station::input::Gamepad::State{}; }; });
  control.drive()->begin(name(1));
  ASSERT_TRUE(QTest::qWaitFor([&] { return control.drive()->driving(); }));
  expect_whole("driving");
  control.drive()->stop_using();
}

TEST_F(Window, AStopByAnotherIsReadInTheStripAndAtTheButton) {
  control.select("r2", false);
  settle();
  QString shown;
  const auto read = [&](auto&& self, QQuickItem* item) -> void {
    if (!item->isVisible()) return;
    if (item->inherits("QQuickText") && !item->property("truncated").toBool())
      shown += item->property("text").toString() + "\n";
    for (QQuickItem* child : item->childItems()) self(self, child);
  };
  read(read, window()->contentItem());
  EXPECT_TRUE(shown.contains("hold: stop of op2")) << shown.toStdString();
  control.select("r3", false);
  settle();
  shown.clear();
  read(read, window()->contentItem());
  EXPECT_TRUE(shown.contains("hold: from op2")) << shown.toStdString();
}

}  // namespace
}  // namespace adit::gui
