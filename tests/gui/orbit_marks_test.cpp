// SPDX-License-Identifier: Apache-2.0
// The marks of the view from the side, and the camera that shows all of it.
#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>

#include "basestation/gui/scene/orbit_body.hpp"
#include "basestation/gui/scene/orbit_fit.hpp"
#include "basestation/gui/scene/orbit_marks.hpp"
#include "tests/gui/fixture.hpp"

namespace adit::gui {
namespace {

OrbitCamera camera_over(const Point3& target) {
  return {.target = target, .yaw = 0.5, .pitch = 0.7, .distance = 6.0, .width = 800, .height = 600};
}

/// The box on the screen around the marks of a body.
ScreenBox around(const MarkList& marks) {
  ScreenBox box{{1e9, 1e9}, {-1e9, -1e9}};
  for (const Shape& shape : marks.shapes)
    for (const Point& point : shape.points) {
      box.low = {std::min(box.low.x, point.x), std::min(box.low.y, point.y)};
      box.high = {std::max(box.high.x, point.x), std::max(box.high.y, point.y)};
    }
  return box;
}

std::vector<Point3> corners_of(const station::Robot& robot) {
  std::vector<Point3> out;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {0.0, 1.0}) {
        const double ahead = x * robot.size.length, left = y * robot.size.width;
        out.push_back({robot.x + std::cos(robot.yaw) * ahead - std::sin(robot.yaw) * left,
                       robot.y + std::sin(robot.yaw) * ahead + std::cos(robot.yaw) * left,
                       robot.z + z * robot.size.height});
      }
  return out;
}

TEST(OrbitBody, IsABoxOfTheRobotsSizeAndHeading) {
  station::Robot robot = gui::robot("r1", 3, -2);
  robot.platform = "tracked";
  robot.size = {.length = 1.6F, .width = 0.7F, .height = 0.9F};
  for (const float yaw : {0.0F, 1.1F, -2.5F}) {
    robot.yaw = yaw;
    const OrbitCamera camera = camera_over({3, -2, 0});
    MarkList marks;
    add_body(marks, camera, robot, {3, -2, 0}, {.fill = Token::mine});
    const auto box = box_of(camera, corners_of(robot));
    ASSERT_TRUE(box);
    // The wedge ahead is 0.4 lengths long, at most.
    const ScreenBox drawn = around(marks);
    EXPECT_NEAR(drawn.low.y, box->low.y, 60);
    EXPECT_LE(drawn.low.x, box->low.x + 1e-3);
    EXPECT_GE(drawn.high.x, box->high.x - 1e-3);
    EXPECT_LE(drawn.low.y, box->low.y + 1e-3);
    EXPECT_GE(drawn.high.y, box->high.y - 1e-3);
    const auto sides = std::ranges::count_if(marks.shapes, [](const Shape& shape) {
      return shape.points.size() == 4 && shape.filled && shape.fill == Token::mine;
    });
    EXPECT_EQ(sides, 3) << "two sides and the top";
    const auto wedge =
        std::ranges::find_if(marks.shapes, [](const Shape& s) { return s.points.size() == 3; });
    ASSERT_NE(wedge, marks.shapes.end());
    const auto tip = camera.project(Point3{3 + 1.44 * std::cos(yaw), -2 + 1.44 * std::sin(yaw), 0.54});
    EXPECT_NEAR(wedge->points[0].x, tip->at.x, 1e-3);
    EXPECT_NEAR(wedge->points[0].y, tip->at.y, 1e-3);
  }
}

TEST(OrbitBody, SidesOfABodyDifferInBrightnessAndATiltedOneIsTilted) {
  station::Robot robot = gui::robot("r1", 0, 0);
  const OrbitCamera camera = camera_over({0, 0, 0});
  MarkList level, tilted;
  add_body(level, camera, robot, {0, 0, 0}, {.fill = Token::mine});
  std::vector<double> shades;
  for (const Shape& shape : level.shapes)
    if (shape.points.size() == 4) shades.push_back(shape.shade);
  std::ranges::sort(shades);
  EXPECT_EQ(std::ranges::adjacent_find(shades), shades.end());
  robot.pitch = -0.4;  // Nose up.
  add_body(tilted, camera, robot, {0, 0, 0}, {.fill = Token::mine});
  const auto tip = [](const MarkList& marks) {
    return std::ranges::find_if(marks.shapes, [](const Shape& s) { return s.points.size() == 3; })->points[0];
  };
  EXPECT_LT(tip(tilted).y, tip(level).y - 5);
}

TEST(OrbitBody, EveryPlatformLooksDifferent) {
  std::vector<MarkList> all;
  for (const char* platform : {"wheeled", "tracked", "legged", "aerial", ""}) {
    station::Robot robot = gui::robot("r1", 0, 0);
    robot.platform = platform;
    MarkList marks;
    add_body(marks, camera_over({0, 0, 0}), robot, {0, 0, 0}, {.fill = Token::mine});
    EXPECT_EQ(std::ranges::count(all, marks), 0) << platform;
    all.push_back(marks);
  }
}

TEST(OrbitMarks, ATrailIsAtTheHeightWhereTheRobotWas) {
  station::World world{.station = "op1"};
  world.robots = {mine(gui::robot("r1", 0, 0))};
  Trails trails;
  for (int i = 0; i < 10; ++i) {
    world.robots[0].x = static_cast<float>(i);
    world.robots[0].z = 0.3F * static_cast<float>(i);
    trails.add(world, i);
  }
  const OrbitCamera camera = camera_over({5, 0, 1});
  const MarkList marks = orbit_marks({.world = &world, .trails = &trails, .camera = camera});
  const auto line =
      std::ranges::find_if(marks.shapes, [](const Shape& s) { return !s.closed && s.points.size() > 5; });
  ASSERT_NE(line, marks.shapes.end());
  const auto end = camera.project({9, 0, 2.7});
  EXPECT_NEAR(line->points.back().x, end->at.x, 1e-3);
  EXPECT_NEAR(line->points.back().y, end->at.y, 1e-3);
}

TEST(OrbitMarks, ARobotOutsideOfTheSliceIsPale) {
  station::World world{.station = "op1"};
  world.robots = {mine(gui::robot("r1", 0, 0))};
  world.robots[0].z = -4.0F;
  const auto opacity = [&](const Slice& slice) {
    return orbit_marks({.world = &world, .camera = camera_over({0, 0, -4}), .slice = slice})
        .labels.front()
        .opacity;
  };
  EXPECT_EQ(opacity({}), 1.0);
  EXPECT_EQ(opacity({.low = -4.0, .high = -1.8}), 1.0);
  EXPECT_LT(opacity({.low = -0.3, .high = 2.2}), 0.5);
}

TEST(OrbitMarks, AxesPointAsTheMapLies) {
  MarkList marks;
  OrbitCamera camera = camera_over({0, 0, 0});
  camera.yaw = std::numbers::pi / 2;
  add_axes(marks, camera, {100, 100}, 4.0);
  ASSERT_EQ(marks.labels.size(), 3U);
  const auto label = [&](const char* name) {
    return std::ranges::find_if(marks.labels, [&](const MapLabel& one) { return one.text == name; })->at;
  };
  EXPECT_GT(label("x").x, 120) << "east is to the right";
  EXPECT_LT(label("y").y, 100) << "north is away";
  EXPECT_LT(label("z").y, 100);
  EXPECT_NEAR(label("z").x, 100, 1e-6);
}

TEST(OrbitFit, FillsTheViewWithinItsMarginsFromEverySide) {
  std::vector<Point3> points;
  for (const double x : {-7.0, 30.0})
    for (const double y : {-5.0, 9.0})
      for (const double z : {-0.2, 3.0}) points.push_back({x, y, z});
  for (const auto& [width, height] : {std::pair{1000.0, 400.0}, {400.0, 1000.0}, {990.0, 475.0}})
    for (const double yaw : {0.0, 0.8, 1.57, -2.0})
      for (const double pitch : {0.1, 0.9, 1.57}) {
        OrbitCamera camera{.yaw = yaw, .pitch = pitch, .width = width, .height = height};
        const Margins margins{.left = 40, .top = 10, .right = 60, .bottom = 20};
        camera = fitted(camera, points, margins);
        const auto box = box_of(camera, points);
        ASSERT_TRUE(box);
        const double widest = (box->high.x - box->low.x) / width,
                     tallest = (box->high.y - box->low.y) / height;
        EXPECT_GE(std::max(widest, tallest), 0.8);
        EXPECT_GE(box->low.x, 0.7 * 40);  // Margins that are too large for a narrow view are made smaller.
        EXPECT_LE(box->high.x, width - 0.7 * 60);
        EXPECT_GE(box->low.y, 9.9);
        EXPECT_LE(box->high.y, height - 19.9);
        EXPECT_EQ(camera.yaw, yaw);
        EXPECT_EQ(camera.pitch, pitch);
      }
}

TEST(OrbitFit, OnePointOrNoneIsNoReasonToGoTooNear) {
  const OrbitCamera camera{.width = 800, .height = 600};
  EXPECT_EQ(fitted(camera, {}, {}), camera);
  const OrbitCamera near = fitted(camera, {{3, 4, 5}}, {});
  EXPECT_GE(near.distance, 1.0);
  EXPECT_NEAR(near.project({3, 4, 5})->at.x, 400, 1e-6);
}

}  // namespace
}  // namespace adit::gui
