// SPDX-License-Identifier: Apache-2.0
// The strip of what needs the operator, in the whole window.
#include <QTime>

#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;

class AttentionWindow : public Window {
 protected:
  /// The alerts of the ten robots that a fresh window finds.
  void say(const std::string& robot, const std::string& code, const std::string& text) {
    control.add_notice(my_notice(++id, robot, code, text));
    show(ten_robots());
    settle();
  }
  /// The first row of that robot, or the one in which somebody asks for it.
  const Need& need_of(const std::string& robot, bool asked = false) {
    for (const Need& need : control.attention()->needs())
      if (need.robots == std::vector{robot} && (!asked || !need.grant_label.empty())) return need;
    ADD_FAILURE() << robot;
    static const Need none{};
    return none;
  }
  QString item_of(const QString& part, const std::string& robot, bool asked = false) {
    return part + "_" + QString::fromStdString(need_of(robot, asked).id);
  }
  std::uint64_t id{100};
};

TEST_F(AttentionWindow, ATapOnARowSelectsTheRobotAndBringsItIntoTheMiddle) {
  say("r4", "blocked", "every path is blocked");
  settle_layout();
  control.attention()->set_open(true);
  settle_layout();
  touch(middle(item_of("need", "r4")));
  EXPECT_THAT(control.selection(), ElementsAre("r4"));
  EXPECT_EQ(on_map(16, -2), map().mapToScene({map().width() / 2, map().height() / 2}).toPoint());
  EXPECT_FALSE(map().fitting());
}

TEST_F(AttentionWindow, TheKeyTabGoesThroughAllOfThemAndStartsAgain) {
  std::vector<std::string> order;
  const int count = control.attention()->count();
  ASSERT_GT(count, 2);
  for (int i = 0; i <= count; ++i) {
    QTest::keyClick(window(), Qt::Key_Tab);
    order.push_back(control.selection().at(0));
  }
  EXPECT_EQ(order.front(), order.back());
  EXPECT_TRUE(sink.lines.empty());
}

TEST_F(AttentionWindow, AStopByAnotherIsOnTopUntilSeen) {
  say("r4", "blocked", "every path is blocked");
  say("r2", "stopped", "op2 stopped r2");
  EXPECT_EQ(control.attention()->needs().front().who, "r2");
  EXPECT_TRUE(need_of("r2").urgent);
  settle_layout();
  touch(middle(item_of("see", "r2")));
  EXPECT_FALSE(need_of("r2").urgent);
  EXPECT_TRUE(control.selection().empty()) << "the button is not the row";
}

TEST_F(AttentionWindow, AGrantIsHeldAndATapIsNotEnough) {
  say("r4", "asked", "op2 asked for r4");
  settle_layout();
  control.attention()->set_open(true);
  settle_layout();
  const QPoint at = middle(item_of("grant", "r4", true));
  touch(at);
  EXPECT_TRUE(sink.lines.empty());
  finger_down(at);
  ASSERT_TRUE(QTest::qWaitFor([&] { return !sink.lines.empty(); }, 30'000));
  finger_up(at);
  EXPECT_THAT(sink.lines, ElementsAre("grant r4 op2"));
}

TEST_F(AttentionWindow, LaterHidesARowAndANewNotificationShowsItAgain) {
  say("r4", "blocked", "every path is blocked");
  const int count = control.attention()->count();
  control.attention()->later(QString::fromStdString(need_of("r4").id));
  EXPECT_EQ(control.attention()->count(), count - 1);
  say("r4", "blocked", "every path is blocked");
  EXPECT_EQ(control.attention()->count(), count);
}

TEST_F(AttentionWindow, AWindowThatIsOpenedLaterShowsWhatHappenedBefore) {
  Control late(sink);
  station::World world = ten_robots();
  world.notices = {{{.code = "blocked", .text = "no way", .robot = "r4"}, 7, 65.0, true}};
  late.add_notice(world.notices[0]);  // It came by itself before the snapshot that has it.
  late.show(std::make_shared<station::World>(world), 500.0);
  EXPECT_EQ(late.log()->rowCount(), 1);
  const QTime said =
      QTime::fromString(late.log()->data(late.log()->index(0, 0), Qt::UserRole + 1).toString(), "HH:mm:ss");
  const int ago = (said.secsTo(QTime::currentTime()) + 86400) % 86400;
  EXPECT_TRUE(said.isValid()) << "the time of the day, also of what was before the window was opened";
  EXPECT_GE(ago, 65);
  EXPECT_LT(ago, 75);
  ASSERT_FALSE(late.attention()->needs().empty());
  EXPECT_EQ(late.attention()->needs()[0].since, "65 s");
  late.show(std::make_shared<station::World>(world), 501.0);
  EXPECT_EQ(late.log()->rowCount(), 1) << "once";
  late.show_link(false, 0.0, "ended");
  world.notices = {{{.code = "arrived", .text = "another run", .robot = "r1"}, 1, 0.0, true}};
  late.show_link(true, 0.0, "");
  late.show(std::make_shared<station::World>(world), 502.0);
  EXPECT_EQ(late.log()->rowCount(), 2) << "another run of the station counts from 1";
}

TEST_F(AttentionWindow, TenThousandNotificationsStayBounded) {
  for (int i = 0; i < 10'000; ++i)
    control.add_notice(
        my_notice(++id, "x" + std::to_string(i), "battery_low", std::string(200, 'w') + "\n<b>line</b>"));
  show(ten_robots());
  settle();
  EXPECT_LE(control.attention()->count(), static_cast<int>(station::AlertQueue::kMaxAlerts) + 10);
  control.attention()->set_open(true);
  settle();
  picture("needs_many");
}

TEST_F(AttentionWindow, Pictures) {
  say("r4", "blocked", "every path is blocked");
  say("r2", "stopped", "op2 stopped r2");
  say("r4", "asked", "op2 asked for r4");
  picture("needs_720");
  control.attention()->set_open(true);
  picture("needs");
  Theme::instance().set_light(true);
  window()->resize(1920, 1080);
  picture("needs_light_1080");
}

}  // namespace
}  // namespace adit::gui
