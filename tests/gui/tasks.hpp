// SPDX-License-Identifier: Apache-2.0
// The operator's tasks, done in the window by fingers alone: how many inputs each needs, and how long a
// person would take by the keystroke-level model (docs/gui.md).
#pragma once
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/gui/window_fixture.hpp"

namespace adit::gui {

/// A task, and what it needed.
struct TaskResult {
  std::string name{};
  int inputs{};      ///< Taps and long presses.
  double seconds{};  ///< By the keystroke-level model.
  int most{};        ///< Inputs wanted.
  double limit{};    ///< Time wanted, s; 0: none.
  bool done{};       ///< The station got what was meant, or the window showed it.
};

/// The keystroke-level model of Card, Moran and Newell, with Fitts's law in Shannon's form for pointing.
struct KeystrokeModel {
  static constexpr double kMental = 1.35;   ///< Thinking before a step, s.
  static constexpr double kTap = 0.2;       ///< Finger down and up, s.
  static constexpr double kHold = 0.8;      ///< A press that is held, s; more than a tap.
  static constexpr double kPerBit = 0.1;    ///< Time for a bit of Fitts's index of difficulty, s.
  static constexpr double kPlaceMm = 12.0;  ///< Size of a place on the map that is good enough, mm.
  /// Time to reach a target of that size from so far away, in the same unit.
  static double pointing(double distance, double size) { return kPerBit * std::log2(distance / size + 1.0); }
};

/// A window with ten robots, one task, and a hand over the middle of the screen.
class TaskWindow : public Window {
 public:
  explicit TaskWindow(std::string name, int most, double limit = 0.0) {
    result_.name = std::move(name);
    result_.most = most;
    result_.limit = limit;
    hand_ = {window()->width() / 2.0, window()->height() / 2.0};
    settle_layout();
  }
  void TestBody() override {}

  void think() { result_.seconds += KeystrokeModel::kMental; }
  void tap(const QString& name) {
    settle_layout();
    move_to(name);
    touch(middle(name));
  }
  /// Presses until that holds, and then lets go.
  void hold(const QString& name, const std::function<bool()>& until) {
    settle_layout();
    move_to(name);
    result_.seconds += KeystrokeModel::kHold;
    finger_down(middle(name));
    (void)QTest::qWaitFor(until, 30'000);
    finger_up(middle(name));
    settle();
  }
  /// A long press on the map, map frame, m.
  void hold_place(double x, double y) {
    settle_layout();
    const QPoint at = on_map(x, y);
    reach(at, KeystrokeModel::kPlaceMm * Theme::instance().mm());
    result_.seconds += KeystrokeModel::kHold;
    finger_down(at);
    QTest::qWait(GestureArea::kLongPress + 100);
    finger_up(at);
    settle();
  }
  /// The station shows this robot otherwise.
  void change(const std::string& robot, const std::function<void(station::Robot&)>& how) {
    station::World world = control.world();
    for (station::Robot& next : world.robots)
      if (next.name == robot) how(next);
    show(world);
  }
  /// Nothing is wrong with the robots but this one.
  void quiet_but(const std::string& robot) {
    station::World world = control.world();
    for (station::Robot& other : world.robots) {
      if (other.name == robot) continue;
      other.stopped = false;
      other.stops.clear();
      other.troubles.clear();
      other.reason = Reason::none;
      other.goal_state = contract::GoalState::none;
    }
    show(world);
  }
  bool sent(const std::string& line) const { return sink.lines == std::vector{line}; }
  bool last_starts(const std::string& text) const {
    return !sink.lines.empty() && sink.lines.back().starts_with(text);
  }
  void say(const std::string& robot, const std::string& code, const std::string& text) {
    control.add_notice(my_notice(++notice_, robot, code, text));
    show(control.world());
  }
  /// The row of that robot among what needs the operator, as its item has it in its name.
  QString row_of(const std::string& robot) const {
    for (const Need& need : control_.attention()->needs())
      if (need.robots == std::vector{robot}) return QString::fromStdString(need.id);
    return {};
  }
  /// Whether that text can be read in the window now.
  bool reads(const QString& text) { return reads(window()->contentItem(), text); }
  TaskResult result(bool done) {
    result_.done = done;
    return result_;
  }
  Control& state() { return control; }
  FakeSink& station_side() { return sink; }

 private:
  static bool reads(QQuickItem* item, const QString& text) {
    if (!item->isVisible() || item->opacity() <= 0.0) return false;
    if (item->property("text").toString().contains(text) && !item->property("truncated").toBool())
      return true;
    for (QQuickItem* child : item->childItems())
      if (reads(child, text)) return true;
    return false;
  }
  void move_to(const QString& name) {
    const QQuickItem* target = item(name);
    reach(middle(name), std::min(target->width(), target->height()));
  }
  void reach(const QPointF& at, double size) {
    result_.seconds += KeystrokeModel::pointing(std::hypot(at.x() - hand_.x(), at.y() - hand_.y()), size) +
                       KeystrokeModel::kTap;
    ++result_.inputs;
    hand_ = at;
  }

  TaskResult result_{};
  QPointF hand_{};
  std::uint64_t notice_{1000};
  Control& control_{control};
};

/// Does every task, each in a window of its own.
std::vector<TaskResult> do_tasks();

}  // namespace adit::gui
