// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/mark_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "basestation/model/route.hpp"
#include "tests/gui/fixture.hpp"

namespace adit::gui {
namespace {

MarkScene scene_of(const station::World& world) {
  return {.world = &world, .camera = {.x = 10, .y = 0, .scale = 20, .width = 1000, .height = 600}};
}

const Target* target(const MarkList& marks, const std::string& robot) {
  for (const Target& next : marks.targets)
    if (next.robot == robot) return &next;
  return nullptr;
}

TEST(Camera, ATurnedOneShowsADirectionUpAndZoomsAndPansAsTheFingerDoes) {
  Camera camera{.x = 3, .y = 4, .scale = 20, .width = 800, .height = 400};
  camera.look_along(2.5);
  const Point middle = camera.to_screen(3, 4), ahead = camera.to_screen(3 + std::cos(2.5), 4 + std::sin(2.5));
  EXPECT_NEAR(ahead.x, middle.x, 1e-9);
  EXPECT_NEAR(ahead.y, middle.y - 20, 1e-9);
  const Point there = camera.to_map(130, 70), back = camera.to_screen(there.x, there.y);
  EXPECT_NEAR(back.x, 130, 1e-9);
  EXPECT_NEAR(back.y, 70, 1e-9);
  camera.zoom(1.7, 130, 70);
  EXPECT_NEAR(camera.to_screen(there.x, there.y).x, 130, 1e-9);
  camera.pan(25, -10);
  EXPECT_NEAR(camera.to_screen(there.x, there.y).x, 155, 1e-9);
  EXPECT_NEAR(camera.to_screen(there.x, there.y).y, 60, 1e-9);
  camera.place({8, 9}, 40, 50);
  EXPECT_NEAR(camera.to_screen(8, 9).x, 40, 1e-9);
  EXPECT_NEAR(camera.to_screen(8, 9).y, 50, 1e-9);
  camera.fit({0, 0}, {10, 10}, 0);
  EXPECT_EQ(camera.turn, 0.0) << "all of the map is shown with north up";
}

TEST(Camera, BodiesTurnWithTheMap) {
  station::World world;
  world.robots = {robot("r1", 10, 0)};
  world.robots[0].yaw = 2.5F;
  MarkScene scene = scene_of(world);
  scene.camera.look_along(2.5);
  const MarkList marks = marks_of(scene);
  const Point at = target(marks, "r1")->at;
  const auto wedge =
      std::ranges::find_if(marks.shapes, [](const Shape& shape) { return shape.points.size() == 3; });
  ASSERT_NE(wedge, marks.shapes.end());
  EXPECT_NEAR(wedge->points[0].x, at.x, 1e-6);
  EXPECT_LT(wedge->points[0].y, at.y - 9) << "its heading is up";
}

TEST(Camera, ProjectsThereAndBack) {
  const Camera camera{.x = 10, .y = -3, .scale = 25, .width = 800, .height = 400};
  EXPECT_EQ(camera.to_screen(10, -3), (Point{400, 200}));
  EXPECT_EQ(camera.to_screen(11, -2), (Point{425, 175}));
  const Point back = camera.to_map(123, 45);
  const Point again = camera.to_screen(back.x, back.y);
  EXPECT_NEAR(again.x, 123, 1e-9);
  EXPECT_NEAR(again.y, 45, 1e-9);
}

TEST(Camera, ZoomKeepsThePlaceUnderTheFinger) {
  Camera camera{.x = 3, .y = 4, .scale = 20, .width = 800, .height = 400};
  const Point before = camera.to_map(700, 50);
  camera.zoom(1.7, 700, 50);
  const Point after = camera.to_map(700, 50);
  EXPECT_NEAR(before.x, after.x, 1e-9);
  EXPECT_NEAR(before.y, after.y, 1e-9);
  for (int i = 0; i < 100; ++i) camera.zoom(2.0, 0, 0);
  EXPECT_LE(camera.scale, Camera::kMaxScale);
}

TEST(Marks, RobotsStandAtTheirProjectedPixels) {
  const station::World world = ten_robots();
  const MarkList marks = marks_of(scene_of(world));
  const Target* r1 = target(marks, "r1");
  ASSERT_NE(r1, nullptr);
  EXPECT_NEAR(r1->at.x, 500 + (2 - 10) * 20, 0.01);
  EXPECT_NEAR(r1->at.y, 300, 0.01);
  EXPECT_EQ(marks.robot_at(r1->at.x + 3, r1->at.y - 3), "r1");
  EXPECT_EQ(marks.robot_at(5, 5), "");
}

TEST(Marks, SmallRobotsHaveAtLeastFourteenPixels) {
  station::World world{.robots = {robot("r1", 10, 0)}};
  MarkScene scene = scene_of(world);
  scene.camera.scale = 1;
  double low = 1e9, high = -1e9;
  for (const Shape& shape : marks_of(scene).shapes)
    if (shape.filled)
      for (const Point& point : shape.points) low = std::min(low, point.y), high = std::max(high, point.y);
  EXPECT_GE(high - low, 14.0);
}

TEST(Marks, PlacesThatAreNoPlacesAreLeftOut) {
  for (const float wrong :
       {1e30F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e30F}) {
    station::World world = ten_robots();
    for (station::Robot& robot : world.robots) {
      robot.x = wrong;
      robot.goal = {wrong, 0, 0};
      robot.sigma = wrong;
      for (Area& area : robot.areas) area.corners[0][0] = wrong;
    }
    world.stations[1].place = {{wrong, 0.0F, 0.0F}};
    Trails trails;
    trails.add(world, 1.0);
    MarkScene scene = scene_of(world);
    scene.trails = &trails;
    const MarkList marks = marks_of(scene);
    EXPECT_TRUE(marks.targets.empty());
    for (const Shape& shape : marks.shapes)
      for (const Point& point : shape.points) EXPECT_TRUE(std::isfinite(point.x) && std::isfinite(point.y));
  }
}

TEST(Marks, AnUnsureRobotHasACircleOfTwoSigma) {
  station::World world{.robots = {robot("r1", 10, 0)}};
  world.robots[0].sigma = 1.5;
  bool found = false;
  for (const Shape& shape : marks_of(scene_of(world)).shapes)
    found = found || (shape.points.size() > 20 && std::abs(shape.points[0].x - (500 + 2 * 1.5 * 20)) < 0.01);
  EXPECT_TRUE(found);
}

TEST(Marks, AnActiveGoalIsSolidAndAKeptOneDashed) {
  for (const bool active : {true, false}) {
    station::World world{.robots = {mine(robot("r1", 10, 0))}};
    world.robots[0].goal_state = active ? contract::GoalState::active : contract::GoalState::kept;
    world.robots[0].goal = {12, 2, 0};
    const MarkList marks = marks_of(scene_of(world));
    ASSERT_FALSE(marks.shapes.empty());
    EXPECT_EQ(marks.shapes[0].points[1], (Point{540, 260}));
    EXPECT_EQ(marks.shapes[0].dashed, !active);
  }
}

TEST(Marks, ARouteIsDashedWhereNothingWasSeenYet) {
  station::World world{.robots = {mine(robot("r1", 10, 0))}};
  station::Robot& r1 = world.robots[0];
  r1.goal_state = contract::GoalState::active;
  r1.goal_id = 3;
  r1.goal = {20, 10, 0};
  // It was sent a metre behind the robot.
  r1.route = {.goal_id = 3, .corners = 3, .points = {{9, 0, 0}, {20, 0, 0}, {20, 10, 0}}, .unknown = 0b10};
  const MarkList marks = marks_of(scene_of(world));
  ASSERT_GE(marks.shapes.size(), 2U);
  EXPECT_EQ(marks.shapes[0].points, (std::vector<Point>{{500, 300}, {700, 300}}));
  EXPECT_FALSE(marks.shapes[0].dashed);
  EXPECT_EQ(marks.shapes[1].points, (std::vector<Point>{{700, 300}, {700, 100}}));
  EXPECT_TRUE(marks.shapes[1].dashed);
  r1.goal_id = 4;
  EXPECT_EQ(marks_of(scene_of(world)).shapes[0].points, (std::vector<Point>{{500, 300}, {700, 100}}))
      << "a route to an earlier goal means nothing";
}

TEST(Route, WhatLiesBehindDoesNotCount) {
  station::Robot r1 = robot("r1", 3, 0);
  r1.route = {.corners = 4, .points = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}}, .unknown = 0b10};
  const station::RouteRest rest = station::rest_of_route(r1);
  EXPECT_NEAR(rest.length, 4.0, 1e-6);
  EXPECT_NEAR(rest.unknown_length, 3.0, 1e-6);
  EXPECT_FALSE(rest.complete);
  EXPECT_EQ(station::route_text(r1), "more than 4.0 m, of these 3.0 m not seen yet");
  r1.route.points[1][0] = std::numeric_limits<float>::quiet_NaN();
  (void)station::rest_of_route(r1);
  r1.located = false;
  EXPECT_TRUE(station::rest_of_route(r1).points.empty());
}

TEST(Trails, MoveWithTheRobotWhereItsPlaceIsCorrected) {
  Trails trails;
  station::World world{.robots = {robot("r1", 0, 0)}};
  station::Robot& r1 = world.robots[0];
  r1.age = 0.0;
  r1.vx = 10.0F;
  for (int i = 0; i <= 100; ++i) {  // 100 m along x.
    r1.x = static_cast<float>(i);
    trails.add(world, 0.1 * i);
  }
  r1.x = 101.0F;
  r1.y = 8.0F;
  r1.z = 2.0F;
  r1.map_revision = 1;
  trails.add(world, 10.1);
  const auto& points = trails.of("r1")->points;
  EXPECT_NEAR(points.front().place.y, 0.0, 1e-6);
  EXPECT_NEAR(points[50].place.y, 4.0, 0.1);
  EXPECT_NEAR(points[50].z, 1.0, 0.1);
  EXPECT_NEAR(points[100].place.y, 8.0, 0.1);
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_FALSE(points[i].begins) << i;
}

TEST(Trails, BreakWhereARobotJumpsAndStayBounded) {
  Trails trails;
  station::World world{.robots = {robot("r1", 0, 0)}};
  for (int i = 0; i < 5000; ++i) {
    world.robots[0].x = static_cast<float>(i) * 0.2F;
    trails.add(world, 0.1 * i);
  }
  ASSERT_NE(trails.of("r1"), nullptr);
  EXPECT_LE(trails.of("r1")->points.size(), Trails::kMaxPoints);
  world.robots[0].x = 0;
  trails.add(world, 501);
  EXPECT_TRUE(trails.of("r1")->points.back().begins);
}

TEST(Trails, ARobotThatReportsOnceASecondIsStaleAfterThree) {
  Trails trails;
  station::World world{.robots = {robot("r1", 0, 0)}};
  world.robots[0].age = 0.0;
  for (int i = 0; i < 60; ++i) trails.add(world, i);
  EXPECT_NEAR(trails.stale_after("r1"), 3.0, 0.2);
  EXPECT_EQ(trails.stale_after("unheard"), 1.0);
}

TEST(Spread, PlacesOfSeveralRobotsAreApart) {
  const std::vector<Point> places = spread({1, 2}, 20, 1.5);
  ASSERT_EQ(places.size(), 20U);
  EXPECT_EQ(places[0], (Point{1, 2}));
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GE(std::hypot(places[i].x - places[k].x, places[i].y - places[k].y), 1.5 - 1e-9);
}

TEST(ScaleBar, IsRoundAndFits) {
  EXPECT_DOUBLE_EQ(bar_length(20, 180), 5.0);
  EXPECT_DOUBLE_EQ(bar_length(100, 180), 1.0);
  EXPECT_DOUBLE_EQ(bar_length(1, 180), 100.0);
}

}  // namespace
}  // namespace adit::gui
