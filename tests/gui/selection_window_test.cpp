// SPDX-License-Identifier: Apache-2.0
#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;

TEST_F(Window, AFingerThatRestsOnACardAddsItOrTakesItOut) {
  settle_layout();
  touch(middle("card_r1"));
  EXPECT_THAT(control.selection(), ElementsAre("r1"));
  const auto rest_on = [&](const QString& card, std::size_t robots) {
    const QPoint at = middle(card);
    finger_down(at);
    EXPECT_TRUE(QTest::qWaitFor([&] { return control.selection().size() == robots; }, 30'000));
    finger_up(at);
    settle();
  };
  rest_on("card_r2", 2);
  EXPECT_THAT(control.selection(), ElementsAre("r1", "r2")) << "the end of the press selects nothing";
  rest_on("card_r1", 1);
  EXPECT_THAT(control.selection(), ElementsAre("r2"));
}

TEST_F(Window, AKeySelectsTheRobotThatHasItsNumber) {
  station::World world = ten_robots();
  world.robots.insert(world.robots.begin() + 1, robot("r10", 3, 3));
  world.robots.insert(world.robots.begin(), robot("amber", 4, 4));
  show(world);
  for (const auto& [key, name] : {std::pair{Qt::Key_1, "r1"}, {Qt::Key_2, "r2"}, {Qt::Key_9, "r9"}}) {
    QTest::keyClick(window(), key);
    EXPECT_THAT(control.selection(), ElementsAre(name));
  }
  for (int row = 0; row < control.robots()->rowCount(); ++row) {
    const auto cell = [&](int role) {
      return control.robots()->data(control.robots()->index(row, 0), Qt::UserRole + role).toString();
    };
    if (cell(0).startsWith("r") && cell(0) != "rx") {
      EXPECT_EQ("r" + cell(1), cell(0)) << "the number on the card";
    }
  }
  QStringList labels;
  for (const MapLabel& label : map().marks().labels) labels << QString::fromStdString(label.text);
  EXPECT_TRUE(labels.contains("10") && labels.contains("11")) << "r10 and amber on the map";
}

}  // namespace
}  // namespace adit::gui
