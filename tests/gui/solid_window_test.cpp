// SPDX-License-Identifier: Apache-2.0
// The map in three dimensions, in the whole window.
#include <cstdio>

#include "basestation/gui/scene/map_view_3d.hpp"
#include "basestation/gui/scene/orbit_fit.hpp"
#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

class SolidWindow : public Window {
 protected:
  SolidWindow() {
    QTest::keyClick(window(), Qt::Key_V);
    EXPECT_TRUE(painted());
    settle();
  }
  MapView3D& solid() { return *static_cast<MapView3D*>(item("solid")); }
  /// Whether the voxels have been painted, and nothing waits to be painted.
  bool painted() {
    return QTest::qWaitFor([&] { return solid().voxels().paintings() > 0; }) && (QTest::qWait(200), true);
  }
  QPoint on_solid(double x, double y, double z) {
    const auto seen = solid().camera().project({x, y, z});
    EXPECT_TRUE(seen);
    return seen ? solid().mapToScene({seen->at.x, seen->at.y}).toPoint() : QPoint();
  }
};

TEST_F(SolidWindow, VoxelsArePaintedWhereTheyProject) {
  const VoxelPainter& painter = solid().voxels().painter();
  EXPECT_GT(painter.drawn(), 5000U);
  const auto at = [&](double x, double y, double z) {
    const auto seen = solid().camera().project({x, y, z});
    const auto place = painter.pick(seen->at.x, seen->at.y);
    return place ? std::hypot(place->x - x, place->y - y, place->z - z) : 1e9;
  };
  EXPECT_LT(at(12.0, 4.0, -0.1), 0.5) << "the floor of the room, seen below the cut ceiling";
  EXPECT_FALSE(painter.pick(3, 3)) << "nothing in the corner";
  const QImage picture = window()->grabWindow();
  const QRgb floor = picture.pixel(on_solid(12.0, 4.0, 0.0));
  EXPECT_NE(floor, Theme::instance().ground().rgb());
  this->picture("solid");
  Theme::instance().set_light(true);
  this->picture("solid_light");
  window()->resize(1920, 1080);
  QTest::qWait(200);
  this->picture("solid_light_1080");
  Theme::instance().set_light(false);
  this->picture("solid_1080");
}

TEST_F(SolidWindow, TheKeyFollowsTheSelectedRobot) {
  control.select("r1", false);
  QTest::keyClick(window(), Qt::Key_F);
  EXPECT_EQ(solid().followed(), "r1");
  solid().zoomBy(4.0);
  QTest::qWait(300);
  this->picture("solid_follow");
  EXPECT_EQ(solid().followed(), "r1") << "closer";
  QTest::keyClick(window(), Qt::Key_F);
  EXPECT_EQ(solid().followed(), "");
}

TEST_F(SolidWindow, TheFirstCutHidesTheCeilingAndTheKeysMoveIt) {
  EXPECT_TRUE(solid().cutting());
  EXPECT_NEAR(solid().cut(), MapView3D::kHeadroom, 0.01);
  QTest::keyClick(window(), Qt::Key_PageUp);
  EXPECT_NEAR(solid().cut(), MapView3D::kHeadroom + MapView3D::kCutStep, 0.01);
  QTest::keyClick(window(), Qt::Key_PageDown);
  QTest::keyClick(window(), Qt::Key_PageDown);
  EXPECT_NEAR(solid().cut(), MapView3D::kHeadroom - MapView3D::kCutStep, 0.01);
  const std::size_t cut = solid().voxels().painter().drawn();
  settle_layout();
  touch(middle("cutToggle"));
  EXPECT_FALSE(solid().cutting());
  EXPECT_TRUE(QTest::qWaitFor([&] { return solid().voxels().painter().drawn() > cut; }));
}

TEST_F(SolidWindow, ATapSelectsARobotAndALongPressSendsItToThePlaceOnTheFloor) {
  touch(on_solid(2, 0, 0));
  ASSERT_THAT(control.selection(), ElementsAre("r1"));
  const QPoint at = on_solid(11.0, 5.0, 0.0);  // No wall hides it.
  finger_down(at);
  ASSERT_TRUE(QTest::qWaitFor([&] { return solid().aims(); }));
  finger_up(at);
  ASSERT_THAT(sink.lines, SizeIs(1));
  double x = 0, y = 0, z = 0;
  ASSERT_EQ(std::sscanf(sink.lines[0].c_str(), "goto r1 %lf %lf %lf", &x, &y, &z), 3) << sink.lines[0];
  EXPECT_NEAR(x, 11.0, 0.4);
  EXPECT_NEAR(y, 5.0, 0.4);
  EXPECT_NEAR(z, 0.0, 0.3);
}

TEST_F(SolidWindow, APressWhereNoMapIsSendsNothing) {
  control.select("r1", false);
  const QPoint at = solid().mapToScene({4, solid().height() - 4}).toPoint();
  finger_down(at);
  ASSERT_TRUE(QTest::qWaitFor([&] { return solid().aims(); }));
  finger_up(at);
  EXPECT_TRUE(sink.lines.empty());
  EXPECT_EQ(control.outcome_kind(), "refused");
}

TEST_F(SolidWindow, RobotsMoveWithoutPaintingTheVoxelsAgain) {
  const int before = solid().voxels().paintings();
  station::World world = ten_robots();
  const Point was = solid().marks().targets.at(0).at;
  world.robots[0].x += 3;
  show(world);
  settle();
  EXPECT_NE(solid().marks().targets.at(0).at, was);
  EXPECT_EQ(solid().voxels().paintings(), before);
}

TEST_F(SolidWindow, OneFingerTurnsTheMapAndTwoMoveIt) {
  const OrbitCamera before = solid().camera();
  const QPoint at = solid().mapToScene({300, 200}).toPoint();
  drag(at, at + QPoint(100, 0));
  EXPECT_NE(solid().camera().yaw, before.yaw);
  EXPECT_EQ(solid().camera().target, before.target);
  const OrbitCamera turned = solid().camera();
  QTest::touchEvent(window(), finger).press(0, at, window()).press(1, at + QPoint(80, 0), window());
  for (int i = 1; i <= 5; ++i)
    QTest::touchEvent(window(), finger)
        .move(0, at + QPoint(0, 15 * i), window())
        .move(1, at + QPoint(80, 15 * i), window());
  QTest::touchEvent(window(), finger)
      .release(0, at + QPoint(0, 75), window())
      .release(1, at + QPoint(80, 75), window());
  settle();
  EXPECT_EQ(solid().camera().yaw, turned.yaw);
  EXPECT_NE(solid().camera().target, turned.target);
  EXPECT_TRUE(sink.lines.empty());
}

TEST_F(SolidWindow, TheMiddleButtonAndShiftMoveTheMapAndSendNothing) {
  control.select("r1", false);
  const QPoint at = solid().mapToScene({300, 200}).toPoint();
  for (const auto& [button, key] :
       {std::pair{Qt::MiddleButton, Qt::NoModifier}, {Qt::LeftButton, Qt::ShiftModifier}}) {
    const OrbitCamera before = solid().camera();
    QTest::mousePress(window(), button, key, at);
    for (int i = 1; i <= 5; ++i) QTest::mouseMove(window(), at + QPoint(0, 15 * i));
    QTest::mouseRelease(window(), button, key, at + QPoint(0, 75));
    settle();
    EXPECT_EQ(solid().camera().yaw, before.yaw);
    EXPECT_EQ(solid().camera().pitch, before.pitch);
    EXPECT_NE(solid().camera().target, before.target);
  }
  QTest::mouseClick(window(), Qt::MiddleButton, {}, at);
  settle();
  EXPECT_TRUE(sink.lines.empty());
  EXPECT_THAT(control.selection(), ElementsAre("r1"));
}

TEST_F(SolidWindow, AllThatIsShownFillsTheViewAndStaysInIt) {
  for (const QSize size : {QSize(1280, 720), QSize(1920, 1080)}) {
    window()->resize(size);
    QTest::qWait(100);
    solid().fitAll();
    settle();
    const auto box = box_of(solid().camera(), solid().shown_corners());
    ASSERT_TRUE(box);
    EXPECT_GE(box->low.x, 0);
    EXPECT_GE(box->low.y, 0);
    EXPECT_LE(box->high.x, solid().width());
    EXPECT_LE(box->high.y, solid().height());
    EXPECT_GE(
        std::max((box->high.x - box->low.x) / solid().width(), (box->high.y - box->low.y) / solid().height()),
        0.8);
  }
  EXPECT_TRUE(solid().fitting());
  station::TileMap more = corridors();
  auto tile = std::make_shared<station::MapTile>(*more.tiles.at({0, 0}));
  tile->x = 3;
  more.tiles[{3, 0}] = tile;
  control.show_map(std::make_shared<station::TileMap>(more));
  settle();
  const auto box = box_of(solid().camera(), solid().shown_corners());
  ASSERT_TRUE(box);
  EXPECT_LE(box->high.x, solid().width()) << "the map grew";
  touch(on_solid(12, 4, 0));
  const OrbitCamera before = solid().camera();
  solid().zoomBy(2.0);
  EXPECT_FALSE(solid().fitting());
  EXPECT_NE(solid().camera(), before);
}

TEST_F(SolidWindow, AFollowedRobotStaysInTheMiddleUntilTheMapIsMoved) {
  control.follow()->toggle();
  EXPECT_EQ(control.outcome_kind(), "refused") << "none is selected";
  control.select("r1", false);
  control.follow()->toggle();
  EXPECT_EQ(solid().followed(), "r1");
  station::World world = ten_robots();
  for (int i = 0; i < 3; ++i) {
    world.robots[0].x += 2;
    world.robots[0].z += 0.5F;
    show(world);
    settle();
    const auto seen = solid().camera().project({world.robots[0].x, world.robots[0].y, world.robots[0].z});
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->at.x, solid().width() / 2, 1.0);
    EXPECT_NEAR(seen->at.y, solid().height() / 2, 1.0);
  }
  QTest::qWait(300);
  const int paintings = solid().voxels().paintings();
  show(world);
  QTest::qWait(300);
  EXPECT_EQ(solid().voxels().paintings(), paintings) << "it stands";
  const QPoint at = solid().mapToScene({300, 200}).toPoint();
  QTest::mousePress(window(), Qt::LeftButton, {}, at);
  for (int i = 1; i <= 5; ++i) QTest::mouseMove(window(), at + QPoint(15 * i, 0));
  QTest::mouseRelease(window(), Qt::LeftButton, {}, at + QPoint(75, 0));
  EXPECT_EQ(solid().followed(), "r1") << "turned";
  QTest::mousePress(window(), Qt::MiddleButton, {}, at);
  QTest::mouseMove(window(), at + QPoint(40, 0));
  QTest::mouseRelease(window(), Qt::MiddleButton, {}, at + QPoint(40, 0));
  EXPECT_EQ(solid().followed(), "");
}

TEST_F(SolidWindow, GoesBackToTheViewFromAboveAndTakesAnEmptyMap) {
  settle_layout();
  touch(middle("solidToggle"));
  EXPECT_FALSE(control.solid());
  EXPECT_TRUE(map().isVisible());
  EXPECT_FALSE(solid().isVisible());
  control.set_solid(true);
  control.show_map(std::make_shared<station::TileMap>());
  settle();
  EXPECT_TRUE(solid().empty());
  control.show_map(std::make_shared<station::TileMap>(corridors()));
  settle();
  EXPECT_FALSE(solid().empty());
}

}  // namespace
}  // namespace adit::gui
