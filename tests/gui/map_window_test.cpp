// SPDX-License-Identifier: Apache-2.0
// The window for a second screen: the map and the cameras, no orders but stops.
#include "basestation/gui/scene/map_view_3d.hpp"
#include "tests/gui/camera_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class MapWindow : public Fingers {
 protected:
  MapWindow() {
    show(robots_with_cameras());
    control.show_map(std::make_shared<station::TileMap>(corridors()));
    open(control, WindowKind::map);
    for (const auto& [line, done] : std::exchange(sink.asked, {}))
      if (line == "net") done({.json = station::line_of(station::json_of(network_of_ten()))});
  }
  ~MapWindow() override { operator_window.reset(); }
  void show(const station::World& world) {
    control.show(std::make_shared<station::World>(world), now += 0.2);
  }
  /// Gives pictures to all who asked.
  void give_pictures() {
    for (int i = 0; i < 20; ++i) {
      for (const FakeSink::AskedCamera& asked : std::exchange(sink.cameras, {})) {
        const auto hue = static_cast<std::uint8_t>(60 + 17 * asked.request.robot.back() % 120);
        asked.done(outcome_of(corridor(hue, 120), ++number, 0.2, {}, asked.request.robot));
      }
      settle();
    }
  }

  FakeSink sink{};
  Control control{sink, Control::Orders::view_only};
  double now{100.0};
  std::uint64_t number{};
};

TEST_F(MapWindow, TheMapAndTheCamerasFillItAndStopAllIsAtItsPlace) {
  const QPoint stop = middle("stopAll");
  for (const char* absent : {"touchStick", "button_mode_hold", "tab_log", "driveStop", "commandToggle"})
    EXPECT_EQ(find_item(window(), absent), nullptr) << absent;
  EXPECT_GT(map().width(), 0.6 * window()->width());
  EXPECT_GT(map().height(), 0.9 * window()->height());
  EXPECT_TRUE(QTest::qWaitFor([&] { return sink.cameras.size() == 7; }, 10'000))
      << "but r5, which is lost, and r1's second one";
  EXPECT_TRUE(item("cameraChoose_r3_front")->isVisible());
  finger_down(stop);
  EXPECT_THAT(sink.lines, ElementsAre("STOP")) << "as soon as the finger is down";
  finger_up(stop);
  give_pictures();
  picture("map_window");
  control.set_solid(true);
  QTest::qWait(400);
  picture("map_window_solid");
  window()->resize(1920, 1080);
  QTest::qWait(400);
  give_pictures();
  picture("map_window_1080");
  operator_window.reset();
  FakeSink other_sink;
  Control other(other_sink);
  open(other);
  EXPECT_EQ(middle("stopAll"), stop) << "as in the main window";
  operator_window.reset();
}

TEST_F(MapWindow, NoKeyAndNoPressOrdersARobot) {
  control.select("r1", false);
  for (const Qt::Key key :
       {Qt::Key_T, Qt::Key_R, Qt::Key_L, Qt::Key_H, Qt::Key_W, Qt::Key_G, Qt::Key_X, Qt::Key_M, Qt::Key_E,
        Qt::Key_S, Qt::Key_Return, Qt::Key_Colon, Qt::Key_F3, Qt::Key_I, Qt::Key_C})
    QTest::keyClick(window(), key);
  EXPECT_FALSE(control.drive()->driving());
  EXPECT_FALSE(control.command_line()->is_open());
  const QPoint free = on_map(12, 0.5);
  finger_down(free);
  ASSERT_TRUE(QTest::qWaitFor([&] { return map().aims(); }, 10'000));
  EXPECT_TRUE(control.goals_at({12, 0.5}).empty());
  finger_up(free);
  QTest::mouseClick(window(), Qt::RightButton, {}, free);
  settle();
  EXPECT_THAT(sink.lines, IsEmpty());
  control.order("mode r1 explore");
  EXPECT_THAT(sink.lines, IsEmpty()) << "whatever asks for it";
  EXPECT_TRUE(control.outcome().startsWith("Not sent, as this window only shows"));
  control.select("r1", true);
  QTest::mouseClick(window(), Qt::RightButton, {}, free);
  EXPECT_FALSE(control.mark()->active() || control.mark()->ready()) << "nor marks a place";
  QTest::keyClick(window(), Qt::Key_Pause);
  EXPECT_THAT(sink.lines, ElementsAre("STOP"));
}

TEST_F(MapWindow, ItSelectsAndLooksAndSwitchesCameras) {
  QTest::keyClick(window(), Qt::Key_3);
  EXPECT_THAT(control.selection(), ElementsAre("r3"));
  EXPECT_EQ(control.cameras()->sharp().first, "r3");
  QTest::keyClick(window(), Qt::Key_Right);
  EXPECT_EQ(control.cameras()->sharp().first, "r4");
  QTest::keyClick(window(), Qt::Key_V);
  EXPECT_TRUE(control.solid());
  QTest::keyClick(window(), Qt::Key_V);
  settle_layout();
  click(on_map(2, 0));
  EXPECT_THAT(control.selection(), ElementsAre("r1"));
  settle_layout();
  touch(middle("cameraOff_r2_front"));
  EXPECT_THAT(sink.lines, ElementsAre("camera r2 off front"));
  sink.pending[0]({.text = "r2: camera front is off\n"});
  settle();
  EXPECT_EQ(text("outcome"), "✓ r2: camera front is off");
}

TEST_F(MapWindow, TheSilentStationIsSaid) {
  control.show_link(true, 4.0, "");
  settle();
  EXPECT_TRUE(text("silent").contains("SILENT")) << text("silent").toStdString();
  control.show_link(false, 4.0, "it ended");
  settle();
  EXPECT_TRUE(control.ended());
  EXPECT_FALSE(item("startStation")->isVisible());
}

}  // namespace
}  // namespace adit::gui
