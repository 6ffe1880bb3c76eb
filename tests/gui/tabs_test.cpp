// SPDX-License-Identifier: Apache-2.0
// The tabs at the bottom of the window.
#include <QDir>
#include <QFile>
#include <QTemporaryDir>

#include "tests/gui/tabs_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

QStringList column(QAbstractItemModel* model, int role) {
  QStringList out;
  for (int i = 0; i < model->rowCount(); ++i)
    out << model->data(model->index(i, 0), Qt::UserRole + role).toString();
  return out;
}

TEST_F(TabsTest, KeysAndFingersOpenTabsAndTheActionBarStaysWhereItIs) {
  const QPoint hold = middle("button_mode_hold");
  const QStringList names{"log", "findings", "health", "network", "stairs", "cameras", "settings"};
  EXPECT_EQ(control.tabs()->open(), "log");
  EXPECT_GT(map().height(), 0.5 * window()->height()) << "with the log open";
  for (int i = 1; i < names.size(); ++i) {
    QTest::keyClick(window(), static_cast<Qt::Key>(Qt::Key_F2 + i));
    settle();
    EXPECT_EQ(control.tabs()->open(), names[i]);
    EXPECT_GT(panel_height(), 60.0);
    EXPECT_EQ(middle("button_mode_hold"), hold);
    touch(middle("tab_" + names[i]));
    EXPECT_EQ(control.tabs()->open(), "log");
  }
  QTest::keyClick(window(), Qt::Key_F2);
  settle();
  EXPECT_EQ(control.tabs()->open(), "");
  EXPECT_EQ(middle("button_mode_hold"), hold);
  EXPECT_THAT(sink.lines, IsEmpty());
}

TEST_F(TabsTest, EscapeClosesThePanelThatCoversTheMapAndNothingElse) {
  control.select("r1", false);
  open("health");
  QTest::keyClick(window(), Qt::Key_Escape);
  EXPECT_EQ(control.tabs()->open(), "log");
  EXPECT_THAT(control.selection(), ElementsAre("r1"));
  QTest::keyClick(window(), Qt::Key_Escape);
  EXPECT_EQ(control.tabs()->open(), "log");
  EXPECT_THAT(control.selection(), IsEmpty());
}

TEST_F(TabsTest, AFingerOnAPanelReachesNoRobotBelowIt) {
  control.select("r1", false);
  open("network");
  QQuickItem* panel = item("panel");
  const QPoint at = panel->mapToScene({panel->width() / 2, panel->height() / 2}).toPoint();
  finger_down(at);
  QTest::qWait(GestureArea::kLongPress + 100);
  finger_up(at);
  click(at);
  QTest::mouseClick(window(), Qt::RightButton, {}, at);
  EXPECT_THAT(sink.lines, IsEmpty());
  EXPECT_THAT(control.selection(), ElementsAre("r1"));
}

TEST_F(TabsTest, TheStationIsAskedOnlyWhileATabWantsIt) {
  QTest::qWait(500);  // Findings, once there is a station.
  EXPECT_THAT(sink.queries, ElementsAre("findings"));
  answer(answer_of(some_findings()), "findings");
  EXPECT_EQ(text("count_findings"), "1");
  open("health");
  EXPECT_EQ(sink.queries.size(), 2U);
  QTest::qWait(1200);
  EXPECT_EQ(sink.queries.size(), 2U) << "not again before the answer";
  answer(answer_of(health_of_ten()));
  EXPECT_TRUE(QTest::qWaitFor([&] { return sink.queries.size() == 3; }, 30'000));
  EXPECT_EQ(sink.queries.back(), "health");
  answer(answer_of(health_of_ten()));
  open("log");
  QTest::qWait(1200);
  EXPECT_EQ(sink.queries.size(), 3U);
}

TEST_F(TabsTest, HealthShowsEachStateInWordAndShape) {
  open("health");
  answer(answer_of(health_of_ten()));
  const QStringList cells = column(control.tabs()->cells(), 0);
  const auto cell = [&](const QString& robot, const QString& component, int role) {
    const qsizetype row = cells.indexOf(robot + "\n" + component);
    EXPECT_GE(row, 0);
    return column(control.tabs()->cells(), role)[row];
  };
  EXPECT_EQ(cell("r1", "planner", 3), "up");
  EXPECT_EQ(cell("r1", "planner", 5), "disc");
  EXPECT_EQ(cell("r2", "router", 3), "waits");
  EXPECT_EQ(cell("r2", "router", 5), "triangle");
  EXPECT_EQ(cell("r3", "map", 5), "ring");
  EXPECT_EQ(cell("r4", "planner", 3), "FAILED");
  EXPECT_EQ(cell("r4", "planner", 4), "3 restarts");
  EXPECT_EQ(cell("r4", "planner", 5), "square");
  EXPECT_EQ(cell("r9", "planner", 4), "2 restarts, 2 threads");
  EXPECT_EQ(cell("r8", "map", 3), "") << "not this robot's";
  EXPECT_EQ(cell("r5", "", 4), "no report");
  EXPECT_EQ(cell("r5", "map", 3), "");
  picture("health");
}

TEST_F(TabsTest, AComponentIsRestartedOnlyByHoldingAndOnlyByTheHolder) {
  open("health");
  answer(answer_of(health_of_ten()));
  settle_layout();
  touch(middle("health_r4_planner"));
  EXPECT_EQ(text("healthTitle"), "r4 planner: FAILED");
  EXPECT_TRUE(text("healthText").contains("the costmap has no cell"));
  settle_layout();
  touch(middle("healthRestart"));
  EXPECT_THAT(sink.lines, IsEmpty()) << "a tap";
  hold("healthRestart", 1);
  EXPECT_THAT(sink.lines, ElementsAre("restart r4 planner"));
  sink.pending[0]({.text = "r4: planner is restarted\n"});
  EXPECT_EQ(text("outcome"), "✓ r4: planner is restarted");
  hold("healthPolicy", 2);
  ASSERT_EQ(sink.lines.size(), 2U);
  EXPECT_EQ(sink.lines[1], "policy r4 planner auto");
  touch(middle("health_r3_map"));
  EXPECT_TRUE(text("healthText").contains("you do not hold the robot"));
  settle_layout();
  finger_down(middle("healthRestart"));
  QTest::qWait(1000);
  finger_up(middle("healthRestart"));
  EXPECT_EQ(sink.lines.size(), 2U);
}

TEST_F(TabsTest, NetworkShowsBudgetsLossAndSilence) {
  open("network");
  answer(answer_of(network_of_ten()));
  const QStringList agents = column(control.tabs()->network(), 0);
  EXPECT_EQ(agents.front(), "op1 (this station)");
  ASSERT_EQ(agents.size(), 10);
  const QStringList loss = column(control.tabs()->network(), 1),
                    budget = column(control.tabs()->network(), 5),
                    shape = column(control.tabs()->network(), 8);
  EXPECT_EQ(budget[1], "sends 6.1 kB/s of 62.5 kB/s, mesh_500k, most bulk");
  EXPECT_EQ(budget[3], "sends 18.3 kB/s, unlimited");
  EXPECT_TRUE(loss[4].startsWith("does not hear us")) << loss[4].toStdString();
  EXPECT_TRUE(loss[5].startsWith("SILENT for 47 s")) << loss[5].toStdString();
  EXPECT_EQ(budget[6], "no report yet");
  EXPECT_TRUE(loss[9].startsWith("link is full"));
  EXPECT_EQ(shape[1], "disc");
  EXPECT_EQ(shape[5], "square");
  EXPECT_EQ(shape[9], "triangle");
  picture("network");
}

TEST_F(TabsTest, FindingsAreJudgedByATapAndTakenBack) {
  open("findings");
  answer(answer_of(some_findings()));
  settle_layout();
  EXPECT_EQ(text("missing"), "3 are still at r4, r5 had no room for 2");
  touch(middle("confirm_2"));
  touch(middle("reject_2"));
  touch(middle("confirm_1"));
  EXPECT_THAT(sink.lines, ElementsAre("finding 2 confirm", "finding 2 reject", "finding 1 reopen"));
  picture("findings");
  QTest::qWait(400);  // The first question, as there is a station.
  sink.queries.clear();
  control.add_command({.id = 1, .ended = true, .line = "finding 2 confirm", .mine = true});
  QTest::qWait(400);
  EXPECT_THAT(sink.queries, IsEmpty()) << "a question is under way";
  answer(answer_of(some_findings()));
  EXPECT_TRUE(QTest::qWaitFor([&] { return !sink.queries.empty(); }, 30'000))
      << "the list is asked for again";
}

TEST_F(TabsTest, ANoteIsTypedWithoutGivingCommands) {
  open("findings");
  answer(answer_of(some_findings()));
  control.select("r1", false);
  settle_layout();
  touch(middle("note_2"));
  settle();
  type("sh it's");
  EXPECT_THAT(sink.lines, IsEmpty()) << "letters are text";
  QTest::keyClick(window(), Qt::Key_Pause);
  EXPECT_THAT(sink.lines, ElementsAre("STOP")) << "in every state";
  QTest::keyClick(window(), Qt::Key_Return);
  ASSERT_EQ(sink.lines.size(), 2U);
  EXPECT_EQ(sink.lines[1], "finding 2 note 'sh it'\\''s'");
  settle_layout();
  touch(middle("note_2"));
  type("w");
  QTest::keyClick(window(), Qt::Key_Escape);
  settle();
  EXPECT_EQ(control.tabs()->open(), "findings");
  QTest::keyClick(window(), Qt::Key_S);
  EXPECT_EQ(sink.lines.size(), 3U) << "letters are commands again";
}

TEST_F(TabsTest, TheLogIsFiltered) {
  control.add_notice(blocked_notice());
  control.add_notice({{.code = "granted", .text = "granted by op2", .robot = "r3"}});
  control.add_command(
      {.id = 1, .ended = true, .line = "mode r1 explore", .mine = true, .text = "r1: exploring\n"});
  const auto lines = [&] { return column(control.tabs()->log()->lines(), 4); };
  EXPECT_EQ(lines().size(), 3);
  settle_layout();
  touch(middle("logWarnings"));
  EXPECT_EQ(lines(), QStringList{"every path is blocked"});
  touch(middle("logWarnings"));
  control.select("r1", false);
  touch(middle("logSelected"));
  ASSERT_EQ(lines().size(), 1);
  EXPECT_TRUE(lines()[0].startsWith("mode r1 explore"));
  control.select("r3", false);
  EXPECT_EQ(lines(), QStringList{"granted by op2"});
  touch(middle("logSelected"));
  click(middle("logText"));
  type("OP2");
  EXPECT_EQ(lines(), QStringList{"granted by op2"});
  EXPECT_THAT(sink.lines, IsEmpty());
  QTest::keyClick(window(), Qt::Key_F2);  // A field that is not seen any more takes no keys.
  settle();
  QTest::keyClick(window(), Qt::Key_Pause);
  EXPECT_THAT(sink.lines, ElementsAre("STOP"));
}

TEST_F(TabsTest, TheLogDoesNotMoveWhileItIsRead) {
  for (int i = 0; i < 40; ++i) control.add_remark(QString("line %1").arg(i));
  settle();
  QQuickItem* list = item("log");
  list->setProperty("contentY", list->property("originY").toDouble() + 50.0);
  settle();
  const double at = list->property("contentY").toDouble();
  for (int i = 0; i < 12; ++i) control.add_remark(QString("new %1").arg(i));
  settle();
  EXPECT_EQ(list->property("contentY").toDouble(), at);
  EXPECT_EQ(control.tabs()->log()->lines()->rowCount(), 40);
  EXPECT_EQ(text("logWaiting"), "▴ 12 new");
  settle_layout();
  touch(middle("logWaiting"));
  settle();
  EXPECT_EQ(control.tabs()->log()->lines()->rowCount(), 52);
  EXPECT_FALSE(item("logWaiting")->isVisible());
}

TEST_F(TabsTest, TheLogAndTheFindingsAreExportedAndThePathIsShown) {
  const QTemporaryDir folder;
  qputenv("HOME", folder.path().toUtf8());
  qputenv("XDG_STATE_HOME", (folder.path() + "/state").toUtf8());
  qputenv("XDG_CONFIG_HOME", (folder.path() + "/config").toUtf8());
  control.add_remark("a line\x1b[31m with odd bytes");
  settle_layout();
  touch(middle("logExport"));
  EXPECT_TRUE(text("outcome").contains(folder.path())) << text("outcome").toStdString();
  open("findings");
  answer(answer_of(some_findings()));
  control.tabs()->exportFindings();
  const QDir state(folder.path() + "/state/adit");
  const QStringList names = state.entryList(QDir::Files);
  ASSERT_EQ(names.size(), 4) << names.join(" ").toStdString();
  for (const QString& name : names) {
    QFile file(state.filePath(name));
    ASSERT_TRUE(file.open(QIODevice::ReadOnly));
    const QByteArray all = file.readAll();
    EXPECT_TRUE(name.endsWith("log.txt") ? all.contains("a line") : all.contains("a red backpack"));
  }
}

TEST_F(TabsTest, WhatDoesNotFitIsSaidAndTheRestStays) {
  open("health");
  answer(answer_of(health_of_ten()));
  const int cells = control.tabs()->cells()->rowCount();
  answer({.json = R"({"robots": [{"robot": 5}]})"});
  EXPECT_EQ(control.tabs()->cells()->rowCount(), cells);
  EXPECT_TRUE(control.tabs()->problem().contains("does not fit"));
  open("network");
  answer({.exit_code = 3, .error = "no station is running; this was not sent\n"});
  EXPECT_TRUE(control.tabs()->problem().contains("no station"));
  open("findings");
  answer({.json = "no JSON"});
  EXPECT_FALSE(control.tabs()->problem().isEmpty());
}

TEST_F(TabsTest, HostileNamesAndTwoHundredRobotsDoNoHarm) {
  station::HealthReport health;
  station::NetworkReport net;
  station::FoundReport found;
  for (int i = 0; i < 200; ++i) {
    const std::string name = i == 0 ? "<b>x</b>\n\x1b[31m" : "r" + std::to_string(i);
    station::RobotHealth robot{.robot = name};
    for (int k = 0; k < 40; ++k)
      robot.components.push_back({.name = i % 2 == 0 ? "c" + std::to_string(k) : std::string(200, 'W'),
                                  .state = static_cast<PartState>(k % 5),
                                  .silent_for = 1e30F,
                                  .text = "<img src='file:///etc/passwd'>"});
    health.robots.push_back(robot);
    net.links.push_back({.agent = name, .age = 1e300, .lost_from = 1e9, .signal = -1e300});
    found.findings.push_back({.number = static_cast<std::uint32_t>(i),
                              .robot = name,
                              .kind = std::string(32, 'k'),
                              .position = {1e30, -1e30, 0},
                              .text = std::string(128, '<'),
                              .note = "<h1>note</h1>"});
  }
  QElapsedTimer timer;
  timer.start();
  open("health");
  answer(answer_of(health));
  window()->grabWindow();
  EXPECT_LE(control.tabs()->column_count(), 24);
  open("network");
  answer(answer_of(net));
  window()->grabWindow();
  open("findings");
  answer(answer_of(found));
  window()->grabWindow();
  EXPECT_LT(timer.elapsed(), 10000);
  picture("hostile_findings");
}

}  // namespace
}  // namespace adit::gui
