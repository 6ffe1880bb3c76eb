// SPDX-License-Identifier: Apache-2.0
// What lies on the map beside robots: findings, floors, convoys, the signal.
#include "basestation/gui/scene/map_view_3d.hpp"
#include "tests/gui/floor_fixture.hpp"
#include "tests/gui/tabs_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class LayersTest : public TabsTest {
 protected:
  const Target* star(const MarkList& marks, std::uint32_t number) {
    for (const Target& target : marks.targets)
      if (target.finding == number) return &target;
    return nullptr;
  }
  static int difference(QRgb a, QRgb b) {
    return std::abs(qRed(a) - qRed(b)) + std::abs(qGreen(a) - qGreen(b)) + std::abs(qBlue(a) - qBlue(b));
  }
  MapView3D& solid() { return *static_cast<MapView3D*>(item("solid")); }
};

TEST_F(LayersTest, FindingsAreOnTheMapWithoutTheTabBeingOpen) {
  station::FoundReport found = some_findings();
  found.findings[0].position = {18, 7.5, 0.2};
  answer(answer_of(found), "findings");
  ASSERT_NE(star(map().marks(), 2), nullptr);
  EXPECT_EQ(star(map().marks(), 3), nullptr) << "rejected";
  EXPECT_EQ(sink.queries.size(), 1U);
  const Point at = map().camera().to_screen(3, 1);
  ASSERT_NE(star(map().marks(), 1), nullptr);
  EXPECT_EQ(star(map().marks(), 1)->at, at);
  const QImage picture = window()->grabWindow();
  EXPECT_LT(difference(picture.pixel(on_map(3, 1)), Theme::instance().of(Token::ok).rgb()), 20)
      << "filled, as it is confirmed";
  this->picture("finding_stars");
  Theme::instance().set_light(true);
  this->picture("finding_stars_light");
}

TEST_F(LayersTest, AFindingThatIsWithdrawnLosesItsStarInBothMapsAndIsGreyInItsTab) {
  station::FoundReport found = some_findings();
  answer(answer_of(found), "findings");
  EXPECT_EQ(text("count_findings"), "1");
  found.findings[0].withdrawn = true;
  station::World world = ten_robots();
  world.findings = {.listed = 3, .changes = 7};
  show(world);
  answer(answer_of(found), "findings");
  EXPECT_EQ(star(map().marks(), 2), nullptr);
  ASSERT_NE(star(map().marks(), 1), nullptr);
  EXPECT_EQ(text("count_findings"), "");
  show(world);
  QTest::qWait(500);
  EXPECT_EQ(std::ranges::count(sink.queries, "findings"), 2) << "nothing changed since";
  open("findings");
  answer(answer_of(found), "findings");
  picture("finding_withdrawn");
  control.tabs()->close();
  control.set_solid(true);
  ASSERT_TRUE(QTest::qWaitFor([&] { return solid().voxels().paintings() > 0; }));
  EXPECT_EQ(star(solid().marks(), 2), nullptr);
  EXPECT_NE(star(solid().marks(), 1), nullptr);
}

TEST_F(LayersTest, FindingsThatNeverStopChangingAreStillAskedFor) {
  answer(answer_of(some_findings()), "findings");
  station::World world = ten_robots();
  EXPECT_TRUE(QTest::qWaitFor(
      [&] {
        ++world.findings.changes;
        show(world);
        return std::ranges::count(sink.queries, "findings") > 1;
      },
      5000));
}

TEST_F(LayersTest, StairsAreRibbonsOnceTheStationListedThem) {
  answer(answer_of(findings_with_stairs()), "findings");
  EXPECT_NE(star(map().marks(), 5), nullptr) << "a star until then";
  answer(answer_of(some_stairs()), "stairs");
  EXPECT_EQ(text("count_stairs"), "2") << "the rejected one does not count";
  ASSERT_NE(star(map().marks(), 4), nullptr);
  EXPECT_EQ(star(map().marks(), 6), nullptr) << "a part of 4";
  EXPECT_EQ(star(map().marks(), 7), nullptr) << "rejected";
  EXPECT_NE(star(map().marks(), 8), nullptr) << "it could not be read";
  picture("stairs_on_map");
  const Point at = star(map().marks(), 4)->at;
  touch(map().mapToScene({at.x, at.y}).toPoint());
  ASSERT_EQ(control.tabs()->open(), "stairs");
  EXPECT_EQ(control.tabs()->picked(), 4U);
  EXPECT_THAT(control.selection(), IsEmpty());
  settle_layout();
  picture("stairs");
  touch(middle("staircase_5"));
  EXPECT_EQ(control.tabs()->picked(), 5U);
  const QPoint shown = on_map(9.5, 8 - 2.5 * 0.28);
  EXPECT_NEAR(shown.x(), map().mapToScene({map().width() / 2, 0}).x(), 3.0);
  EXPECT_NEAR(shown.y(), (item("panel")->mapToScene({0, 0}).y() + map().mapToScene({0, 0}).y()) / 2, 3.0);
  EXPECT_EQ(text("unreadable"), "1 staircase could not be read");
  picture("stairs_picked");
  open("log");
  QTest::keyClick(window(), Qt::Key_V);
  ASSERT_TRUE(QTest::qWaitFor([&] { return solid().voxels().paintings() > 0; }));
  EXPECT_NE(star(solid().marks(), 5), nullptr);
  picture("stairs_solid");
}

TEST_F(LayersTest, ARobotThatMayClimbIsSentOverTheStaircaseThatIsPicked) {
  answer(answer_of(findings_with_stairs()), "findings");
  answer(answer_of(some_stairs()), "stairs");
  open("stairs");
  settle_layout();
  EXPECT_EQ(text("stairsOffer"), "Tap a staircase to send a robot over it.");
  touch(middle("goUp"));
  touch(middle("staircase_4"));
  EXPECT_EQ(text("stairsOffer"), "Select one robot to send it over staircase 4.");
  control.select("r2", false);
  EXPECT_EQ(text("stairsOffer"), "r2 climbs steps of 0.15 m at most");
  touch(middle("goUp"));
  EXPECT_TRUE(sink.lines.empty());
  control.select("r1", false);
  settle_layout();
  EXPECT_EQ(text("stairsOffer"), "r1 over staircase 4");
  picture("stairs_offer");
  touch(middle("goDown"));
  ASSERT_EQ(sink.lines.size(), 1U);
  EXPECT_EQ(sink.lines[0], "stairs go r1 4 down");
}

TEST_F(LayersTest, StairsAreAskedForAgainWhenFindingsChangeWhileTheyAreAskedFor) {
  answer(answer_of(findings_with_stairs()), "findings");
  control.add_command({.id = 1, .ended = true, .line = "finding 4 reject", .mine = true});
  answer(answer_of(findings_with_stairs()), "findings");
  EXPECT_EQ(std::ranges::count(sink.queries, "stairs"), 1) << "a question is under way";
  answer(answer_of(some_stairs()), "stairs");
  EXPECT_EQ(std::ranges::count(sink.queries, "stairs"), 2);
}

TEST_F(LayersTest, ATapOnAStarOpensTheTabAtThatFinding) {
  answer(answer_of(some_findings()), "findings");
  touch(on_map(3, 1));
  ASSERT_EQ(control.tabs()->open(), "findings");
  EXPECT_EQ(control.tabs()->picked(), 1U);
  EXPECT_EQ(item("findings")->property("currentIndex").toInt(), 1);
  EXPECT_THAT(control.selection(), IsEmpty());
  EXPECT_THAT(sink.lines, IsEmpty());
}

TEST_F(LayersTest, ATapOnARowShowsThePlaceAboveThePanel) {
  open("findings");
  answer(answer_of(some_findings()), "findings");
  settle_layout();
  touch(middle("finding_2"));
  const QPoint at = on_map(12, 4);
  const double panel = item("panel")->mapToScene({0, 0}).y(), top = map().mapToScene({0, 0}).y();
  EXPECT_NEAR(at.y(), (panel + top) / 2, 3.0) << "the middle of what the panel leaves of the map";
  EXPECT_NEAR(at.x(), map().mapToScene({map().width() / 2, 0}).x(), 3.0);
  picture("finding_picked");
}

TEST_F(LayersTest, StarsAreInThreeDimensionsToo) {
  answer(answer_of(some_findings()), "findings");
  QTest::keyClick(window(), Qt::Key_V);
  ASSERT_TRUE(QTest::qWaitFor([&] { return solid().voxels().paintings() > 0; }));
  ASSERT_NE(star(solid().marks(), 1), nullptr);
  const Point at = star(solid().marks(), 1)->at;
  touch(solid().mapToScene({at.x, at.y}).toPoint());
  ASSERT_EQ(control.tabs()->picked(), 1U);
  settle_layout();
  answer(answer_of(some_findings()), "findings");
  touch(middle("finding_2"));
  EXPECT_NEAR(solid().camera().project({12, 4, 0.2})->at.x, solid().width() / 2, 5.0);
  EXPECT_LT(solid().camera().project({12, 4, 0.2})->at.y, solid().height() / 2);
}

class FloorsTest : public LayersTest {
 protected:
  FloorsTest() {
    show(robots_on_two_floors());
    control.show_map(std::make_shared<station::TileMap>(two_floors()));
    show(robots_on_two_floors());
    drawn();
  }
  /// Waits until the map's pictures are of the floor.
  void drawn() {
    settle();
    EXPECT_TRUE(QTest::qWaitFor([&] { return !map().tiles().pending(); }));
    settle();
  }
};

TEST_F(FloorsTest, TheShownFloorFollowsTheSelection) {
  EXPECT_EQ(text("floorToggle"), "floor 0, auto");
  const QPoint hall = on_map(20.4, -6.6), corridor = on_map(-4.4, 0.4);
  QImage picture = window()->grabWindow();
  const QRgb ground = picture.pixel(corridor), ghost = picture.pixel(hall);
  // The reach of the lost robot lies over both.
  EXPECT_LT(difference(ground, Theme::instance().palette().floor), 40);
  EXPECT_NE(ghost, ground);
  EXPECT_NE(ghost, picture.pixel(on_map(-4.4, -6.6))) << "where nothing is on any floor";
  control.select("r4", false);
  drawn();
  EXPECT_EQ(text("floorToggle"), "floor -1, auto");
  picture = window()->grabWindow();
  EXPECT_EQ(picture.pixel(hall), ground);
  EXPECT_EQ(picture.pixel(corridor), ghost);
  this->picture("floors");
  Theme::instance().set_light(true);
  this->picture("floors_light");
}

TEST_F(FloorsTest, KeysAndFingersChooseAFloor) {
  QTest::keyClick(window(), Qt::Key_PageDown);
  EXPECT_EQ(text("floorToggle"), "floor -1");
  QTest::keyClick(window(), Qt::Key_PageDown);
  EXPECT_EQ(text("floorToggle"), "floor -1") << "it is the lowest";
  settle_layout();
  touch(middle("floorUp"));
  EXPECT_EQ(text("floorToggle"), "floor 0");
  touch(middle("floorToggle"));
  EXPECT_EQ(text("floorToggle"), "floor 0, auto");
  touch(middle("floorToggle"));
  EXPECT_EQ(text("floorToggle"), "all floors");
  EXPECT_THAT(sink.lines, IsEmpty());
}

TEST_F(FloorsTest, InThreeDimensionsAllFloorsAreShownUntilOneIsChosen) {
  QTest::keyClick(window(), Qt::Key_V);
  ASSERT_TRUE(QTest::qWaitFor([&] { return solid().voxels().paintings() > 0; }));
  settle_layout();
  EXPECT_EQ(text("floorToggle"), "all floors");
  EXPECT_LT(solid().slice().low, -100.0);
  picture("solid_floors");
  control.select("r4", false);
  touch(middle("floorToggle"));
  EXPECT_EQ(text("floorToggle"), "floor -1, auto");
  EXPECT_NEAR(solid().slice().low, -4.3, 0.2);
  EXPECT_NEAR(solid().slice().high, -1.8, 0.2);
  for (const Point3& corner : solid().shown_corners()) EXPECT_LT(corner.z, -1.0) << "of the other floor";
  picture("solid_floor");
  touch(middle("floorUp"));
  EXPECT_EQ(text("floorToggle"), "floor 0");
  EXPECT_NEAR(solid().slice().low, -0.3, 0.2);
  touch(middle("floorToggle"));
  touch(middle("floorToggle"));
  EXPECT_EQ(text("floorToggle"), "all floors");
  EXPECT_LT(solid().slice().low, -100.0);
  EXPECT_THAT(sink.lines, IsEmpty());
}

TEST_F(FloorsTest, AGoalIsOnTheFloorThatIsShown) {
  control.select("r4", false);
  drawn();
  QTest::mouseClick(window(), Qt::RightButton, {}, on_map(20, -7));
  settle();
  ASSERT_EQ(sink.lines.size(), 1U);
  EXPECT_TRUE(sink.lines[0].starts_with("goto r4 ")) << sink.lines[0];
  EXPECT_TRUE(sink.lines[0].ends_with(" -4.00")) << sink.lines[0];
}

TEST_F(FloorsTest, AFindingOfAnotherFloorIsShownWithItsFloor) {
  station::FoundReport found = some_findings();
  found.findings[0].position[2] = -3.9;
  open("findings");
  answer(answer_of(found), "findings");
  settle_layout();
  touch(middle("finding_2"));
  EXPECT_EQ(text("floorToggle"), "floor -1");
}

TEST_F(LayersTest, WithOneFloorEverythingIsShownAndAGoalHasNoHeight) {
  QQuickItem* toggle = item("floorToggle");
  EXPECT_FALSE(toggle->isVisible());
  QTest::keyClick(window(), Qt::Key_PageDown);
  EXPECT_FALSE(toggle->isVisible());
  control.select("r1", false);
  QTest::mouseClick(window(), Qt::RightButton, {}, on_map(12, 0));
  settle();
  ASSERT_EQ(sink.lines.size(), 1U);
  EXPECT_EQ(QString::fromStdString(sink.lines[0]).split(' ').size(), 4) << sink.lines[0];
}

TEST_F(LayersTest, AConvoyHasALineThroughItsRobots) {
  station::World world = ten_robots();
  for (const std::size_t i : {0U, 1U, 8U}) world.robots[i].convoy = {"r9", "r1", "r2"};
  show(world);
  settle();
  const auto has_label = [](const MarkList& marks) {
    return std::ranges::any_of(marks.labels, [](const MapLabel& label) { return label.text == "1/3"; });
  };
  EXPECT_TRUE(has_label(map().marks()));
  picture("convoy");
  control.set_solid(true);
  ASSERT_TRUE(QTest::qWaitFor([&] { return solid().voxels().paintings() > 0; }));
  EXPECT_TRUE(has_label(solid().marks()));
  const auto goals = std::ranges::count_if(
      solid().marks().labels, [](const MapLabel& label) { return label.on_fill && label.text == "1"; });
  EXPECT_EQ(goals, 2) << "on the robot and on its goal";
  picture("convoy_solid");
}

TEST_F(LayersTest, TheSignalIsDrawnWhereRobotsWereHeardWhileTheLayerIsOn) {
  EXPECT_EQ(std::ranges::count(sink.queries, "net"), 0);
  settle_layout();
  touch(middle("receptionToggle"));
  EXPECT_EQ(std::ranges::count(sink.queries, "net"), 1) << "no tab is open";
  EXPECT_EQ(text("receptionLegend"), "reception: no link report yet");
  station::NetworkReport report = network_of_ten();
  for (int i = 0; i < 9; ++i) report.links[static_cast<std::size_t>(i)].signal = -70.0 - 3.0 * i;
  answer(answer_of(report), "net");
  EXPECT_EQ(map().grid().cells().size(), 8U) << "r5 is lost";
  EXPECT_TRUE(text("receptionLegend").startsWith("worst signal"));
  station::World world = ten_robots();
  for (station::Robot& robot : world.robots) robot.x += 1.0F;
  show(world);
  answer(answer_of(report), "net");
  EXPECT_EQ(map().grid().cells().size(), 16U) << "more where they are now";
  for (int i = 0; i < 10; ++i) {
    for (station::Robot& robot : world.robots) robot.x += 0.7F, robot.y += i % 2 == 0 ? 1.0F : -1.0F;
    for (station::LinkReport& link : report.links) *link.signal -= 1.5;
    show(world);
    answer(answer_of(report), "net");
  }
  picture("signal");
  touch(middle("receptionToggle"));
  QTest::qWait(1200);
  const auto asked = std::ranges::count(sink.queries, "net");
  QTest::qWait(1200);
  EXPECT_EQ(std::ranges::count(sink.queries, "net"), asked) << "the layer is off";
}

TEST_F(LayersTest, TheNetworkTabShowsWhoHearsWhom) {
  open("network");
  answer(answer_of(network_of_ten()));
  settle_layout();
  picture("network_bars");
  touch(middle("hearingToggle"));
  EXPECT_TRUE(item("hearing")->isVisible());
  EXPECT_FALSE(item("network")->isVisible());
  EXPECT_EQ(control.tabs()->speaker_count(), 11) << "this station, nine robots and op2";
  picture("hearing");
  Theme::instance().set_light(true);
  picture("hearing_light");
}

TEST_F(LayersTest, TheRightButtonAndShiftMoveTheMapInThreeDimensions) {
  control.select("r1", false);
  control.set_solid(true);
  ASSERT_TRUE(QTest::qWaitFor([&] { return solid().voxels().paintings() > 0; }));
  const auto drag = [&](Qt::MouseButton button, Qt::KeyboardModifiers modifiers) {
    const OrbitCamera before = solid().camera();
    const QPoint at = solid().mapToScene({300, 150}).toPoint();
    QTest::mousePress(window(), button, modifiers, at);
    for (int i = 1; i <= 5; ++i) QTest::mouseMove(window(), at + QPoint(15 * i, 5 * i));
    QTest::mouseRelease(window(), button, modifiers, at + QPoint(75, 25));
    settle();
    const OrbitCamera& after = solid().camera();
    return std::pair(after.yaw != before.yaw, after.target != before.target);
  };
  EXPECT_EQ(drag(Qt::LeftButton, {}), std::pair(true, false));
  EXPECT_EQ(drag(Qt::RightButton, {}), std::pair(false, true));
  EXPECT_EQ(drag(Qt::LeftButton, Qt::ShiftModifier), std::pair(false, true));
  EXPECT_EQ(drag(Qt::LeftButton, {}), std::pair(true, false));
  EXPECT_THAT(sink.lines, IsEmpty());
  EXPECT_THAT(control.selection(), ElementsAre("r1"));
}

}  // namespace
}  // namespace adit::gui
