// SPDX-License-Identifier: Apache-2.0
// One operator with the window alone, by touch, against ten operators with a shell each: ten robots, forty
// goals, ten interventions. ADIT_CREW_LENGTH (m), ADIT_CREW_SPEED (m/s) and ADIT_CREW_SEED choose the
// mission.
#include <cstdio>
#include <cstdlib>

#include "basestation/client/paths.hpp"
#include "tests/gui/crew/operators.hpp"
// Qt's keywords are macros, so its headers come after those of others.
#include "tests/gui/station_window.hpp"

namespace adit::gui {
namespace {

using crew::Crew;
using crew::kGoals;
using crew::kRobots;
using crew::Mission;
using crew::Place;
using crew::Progress;
using crew::ShellOperators;
using crew::steady_now;
using crew::Step;

double given(const char* variable, double otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atof(text) : otherwise;
}

struct Result {
  double seconds{};
  int commands{}, refused{}, done{}, touched{};
  std::vector<std::string> events{};
};

int goals_done(const std::array<Progress, kRobots>& progress) {
  std::size_t done = 0;
  for (const Progress& at : progress) done += at.goals_sent - (at.goals_sent > 0 && !at.arrived ? 1 : 0);
  return static_cast<int>(done);
}

/// One operator's finger on the window.
class CrewWindow : public StationWindow {
 protected:
  static constexpr double kLimit = 2400.0;  // s

  void SetUp() override {
    static const std::string why = hosts::Hosts::refused();
    if (!why.empty()) GTEST_SKIP() << "no network namespaces here (they need root): " << why;
  }
  void open_window(const Crew& crew) {
    for (const auto& [key, value] : crew.environment()) ::setenv(key.c_str(), value.c_str(), 1);
    ASSERT_NO_FATAL_FAILURE(open_station("op1"));
    window()->resize(1920, 1080);
    ASSERT_TRUE(QTest::qWaitFor([&] { return control->robot_count() == static_cast<int>(kRobots); }, 20'000));
    settle_layout();
  }
  QString card(std::size_t robot) { return "card_" + QString::fromStdString(crew::name_of(robot)); }
  crew::Seen seen(std::size_t robot) {
    const auto text_of = [&](const char* what) {
      return item(card(robot))->parentItem()->property(what).toString().toStdString();
    };
    return {text_of("holder"), text_of("headline"), text_of("detail")};
  }
  void select(std::size_t robot) {
    if (control->selection() == std::vector<std::string>{crew::name_of(robot)}) return;
    show_card(robot);
    touch(middle(card(robot)));
    EXPECT_EQ(control->selection(), std::vector<std::string>{crew::name_of(robot)});
  }
  /// Drags the list of cards until that one is in it.
  void show_card(std::size_t robot) {
    const QQuickItem* list = item("fleet");
    const QRectF frame = list->mapRectToScene({0, 0, list->width(), list->height()});
    for (int tries = 0; tries < 10; ++tries) {
      const QQuickItem* wanted = item(card(robot));
      const QRectF place = wanted->mapRectToScene({0, 0, wanted->width(), wanted->height()});
      const double below = place.bottom() - frame.bottom(), above = frame.top() - place.top();
      if (below <= 0.5 && above <= 0.5) return;
      drag(frame.center().toPoint(), static_cast<int>(below > 0 ? -below - 20 : above + 20));
    }
  }
  void drag(const QPoint& from, int by) {
    constexpr int kSteps = 10;
    finger_down(from);
    for (int step = 1; step <= kSteps; ++step) {
      QTest::touchEvent(window(), finger).move(0, from + QPoint(0, by * step / kSteps), window());
      QTest::qWait(20);
    }
    QTest::qWait(200);  // At rest, so that the list does not go on by itself.
    finger_up(from + QPoint(0, by));
    settle();
  }
  /// Presses until the ring is full.
  void hold_item(const QString& name) {
    const QPoint at = middle(name);
    finger_down(at);
    QTest::qWait(900);
    finger_up(at);
  }
  /// Presses a button of the action bar as long as its ring needs, and waits for the answer.
  void command(std::size_t robot, const QString& slot, bool hold = false) {
    select(robot);
    settle_layout();
    if (hold)
      hold_item("button_" + slot);
    else
      touch(middle("button_" + slot));
    answered();
  }
  /// Presses on the map until the place is shown there, and lets go.
  void send(std::size_t robot, const Place& place) {
    select(robot);
    settle_layout();
    const QPoint at = on_map(place.x, place.y);
    finger_down(at);
    EXPECT_TRUE(QTest::qWaitFor([&] { return map().aims(); }, 3000));
    finger_up(at);
    answered();
  }
  void answered() {
    ++result.commands;
    (void)QTest::qWaitFor([&] { return control->outcome_kind() != "sent"; }, 4000);
    if (control->outcome_kind() == "done") return;
    ++result.refused;
    std::printf("%s: %s\n", control->outcome_kind().toUtf8().data(), control->outcome().toUtf8().data());
    std::fflush(stdout);
  }
  /// Grants what another operator asks for in the line of what needs the operator.
  bool grant_what_is_asked() {
    const std::vector<Need> needs = control->attention()->needs();  // They change while the window runs.
    for (const Need& need : needs) {
      if (need.grant_line.empty()) continue;
      control->attention()->set_open(true);
      settle_layout();
      hold_item("grant_" + QString::fromStdString(need.id));
      control->attention()->set_open(false);
      answered();
      return true;
    }
    return false;
  }
  /// Serves a robot; true if there was something to do.
  bool serve(const Mission& mission, std::size_t robot) {
    Progress& at = progress[robot];
    if (at.done()) return false;
    const crew::Seen now = seen(robot);
    at.see(now);
    switch (next_step(now)) {
      case Step::wait:
        return false;
      case Step::take:
        command(robot, "take");
        return true;
      case Step::lock:
        command(robot, "lock");
        return true;
      case Step::reset:
        command(robot, "reset", true);
        return true;
      case Step::go_on:
        command(robot, "mode_waypoint");
        return true;
      case Step::another_way:
        send(robot, mission.instead(robot, at.goals_sent - 1));
        return true;
      case Step::next_goal:
        break;
    }
    if (at.goals_sent > 0 && now.detail == "ready") {
      send(robot, mission.goals[robot][at.goals_sent - 1]);
      return true;
    }
    if (at.goals_sent > 0 && (!at.arrived || at.done())) return false;
    const int refused = result.refused;
    send(robot, mission.goals[robot][at.goals_sent]);
    if (result.refused == refused) at = {at.goals_sent + 1, false, false};
    return true;
  }

  /// Takes all robots at once: the first is touched, on the others the finger rests.
  void take_all() {
    select(0);
    for (std::size_t robot = 1; robot < kRobots; ++robot) {
      show_card(robot);
      const QPoint at = middle(card(robot));
      finger_down(at);
      EXPECT_TRUE(QTest::qWaitFor([&] { return control->selection().size() == robot + 1; }, 3000));
      finger_up(at);
    }
    settle_layout();
    for (const char* slot : {"take", "lock"}) {
      hold_item(QString("button_") + slot);
      answered();
      settle_layout();
    }
  }

  Result by_window(const Mission& mission, double speed) {
    Crew robots(mission, speed);
    EXPECT_EQ(robots.failure(), "");
    if (!robots.failure().empty()) return {};
    open_window(robots);
    if (!control) return {};
    const double begun = steady_now();
    take_all();
    picture("crew_begin");
    while (goals_done(progress) < static_cast<int>(kRobots * kGoals) && steady_now() - begun < kLimit) {
      robots.tick(progress);
      bool busy = grant_what_is_asked();
      for (std::size_t robot = 0; robot < kRobots; ++robot) {
        busy = serve(mission, robot) || busy;
        robots.tick(progress);
      }
      if (!busy) QTest::qWait(100);
      if (static_cast<int>(steady_now() - begun) % 30 == 29) picture("crew_later");
    }
    result.seconds = steady_now() - begun;
    result.done = goals_done(progress);
    picture("crew");
    close_window();
    EXPECT_EQ(robots.open(), 0U);
    result.touched = robots.contacts();
    result.events = robots.events();
    return result;
  }

  static Result by_shells(const Mission& mission, double speed) {
    Crew robots(mission, speed);
    EXPECT_EQ(robots.failure(), "");
    if (!robots.failure().empty()) return {};
    ShellOperators operators(mission, robots);
    Result out{};
    const double begun = steady_now();
    while (goals_done(operators.progress()) < static_cast<int>(kRobots * kGoals) &&
           steady_now() - begun < kLimit) {
      robots.tick(operators.progress());
      QTest::qWait(100);
    }
    out.seconds = steady_now() - begun;
    out.done = goals_done(operators.progress());
    out.commands = operators.commands();
    out.refused = operators.refused();
    EXPECT_EQ(robots.open(), 0U);
    out.touched = robots.contacts();
    out.events = robots.events();
    return out;
  }

  std::array<Progress, kRobots> progress{};
  Result result{};
};

void print(const char* who, const Result& r) {
  std::printf(
      "%s: %d of %zu goals after %.0f s, %d commands (%.2f per robot and minute), %d refused, %d touched\n",
      who, r.done, kRobots * kGoals, r.seconds, r.commands,
      r.commands / (static_cast<double>(kRobots) * r.seconds / 60.0), r.refused, r.touched);
  for (const std::string& event : r.events) std::printf("  %s\n", event.c_str());
  std::fflush(stdout);
}

TEST_F(CrewWindow, OneOperatorWithTheWindowIsNearlyAsFastAsTenWithShells) {
  const double speed = given("ADIT_CREW_SPEED", 0.5);
  const Mission mission =
      Mission::draw(static_cast<std::uint64_t>(given("ADIT_CREW_SEED", 1)), given("ADIT_CREW_LENGTH", 95.0));
  const Result window = by_window(mission, speed);
  print("one operator, window", window);
  const Result shells = by_shells(mission, speed);
  print("ten operators, shells", shells);
  std::printf("ratio of times: %.2f\n", window.seconds / shells.seconds);
  for (const Result* r : {&window, &shells}) {
    EXPECT_EQ(r->done, static_cast<int>(kRobots * kGoals));
    EXPECT_EQ(r->events.size(), 10U);
    EXPECT_EQ(r->touched, 0);
  }
  EXPECT_LE(window.seconds, 1.2 * shells.seconds);
  EXPECT_LE(window.commands, 0.5 * kRobots * window.seconds / 60.0);
}

}  // namespace
}  // namespace adit::gui
