// SPDX-License-Identifier: Apache-2.0
// What the map of the routes shows near the robot, where the local map decides.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "nav/local_navigation.hpp"
#include "tests/nav/route_world.hpp"

namespace adit::nav::test {
namespace {

/// A robot that looks: the local map takes each scan, the map of the routes every second one.
struct Looking {
  Platform platform;
  double noise{0.0};
  LocalNavigation local{platform};
  RoutePlanner planner{platform};
  Pose2 pose{};
  double time{100.0};
  Pose3 T_lasting_odom{};  ///< The frame of what lasts, from that of the odometry.
  std::vector<Eigen::Vector3f> peers{};
  std::mt19937 random{7};

  void look(const BoxWorld& world, int scans = 10) {
    for (int n = 0; n < scans; ++n) {
      time += 0.1;
      const auto points = world.scan(pose, platform.lidar_height, 16, 900, noise, random);
      const Pose3 body = Pose3::level(pose, 0), located = T_lasting_odom * body;
      local.add_scan(points, {.stamp_s = time, .body = body, .located = located}, peers);
      if (n % 2 == 1) planner.add_scan(points, located, time, true, local.map().get());
    }
  }
  /// Whether a place of the odometry frame, or one beside it, is blocked; `reach`: m.
  bool blocked(double x, double y, double reach = 0.05) const {
    bool found = false;
    for (const double dx : {-reach, 0.0, reach})
      for (const double dy : {-reach, 0.0, reach}) {
        const Eigen::Vector3d at = T_lasting_odom * Eigen::Vector3d(x + dx, y + dy, 0.0);
        const GroundCell* cell = planner.map().cell(route_cell(at.x()), route_cell(at.y()), at.z());
        found = found || (cell && cell->blocked);
      }
    return found;
  }
};

/// Two walls along x, and two across at `end`, m.
BoxWorld walls_at(double half, double end = 6.0) {
  return {{{-end, end, half, half + 0.3},
           {-end, end, -half - 0.3, -half},
           {end, end + 0.3, -half, half},
           {-end - 0.3, -end, -half, half}}};
}

TEST(RouteScans, WallsNearTheRobotAreObstacles) {
  for (const Platform& platform : {wheeled(), tracked(), legged()})
    for (const double noise : {0.0, 0.02})
      for (const double half : {0.6, 0.8, 1.0, 1.25, 1.5, 2.0}) {
        SCOPED_TRACE(platform.name + ", walls at " + std::to_string(half) + " m, noise " +
                     std::to_string(noise));
        Looking robot{platform, noise};
        robot.pose = {0.037, 0.021, 0};
        robot.look(walls_at(half, 3.5));
        for (double x = -1.0; x < 1.0; x += 0.1)
          for (const int side : {-1, 1})
            EXPECT_TRUE(robot.blocked(x, side * half)) << "x = " << x << ", side " << side;
        EXPECT_FALSE(robot.planner.line({0, 0, 0}, {0, half + 1, 0}).passable);
        EXPECT_FALSE(robot.planner.plan({0, 0, 0}, {0, half + 2.5, 0}).found());
      }
}

TEST(RouteScans, ANarrowCorridorIsPassableAlongAndNeverAcross) {
  for (const Platform& platform : {wheeled(), tracked(), legged()})
    for (const double yaw : {0.0, 0.4}) {
      SCOPED_TRACE(platform.name + ", yaw " + std::to_string(yaw));
      Looking robot{platform, 0.02};
      for (double x = -3.0; x <= 3.0; x += 0.1) {
        robot.pose = {x, 0, yaw};
        robot.look(walls_at(0.6), 2);
      }
      EXPECT_TRUE(robot.planner.line({-4, 0, 0}, {4, 0, 0}).passable);
      for (double x = -4.0; x <= 4.0; x += 0.25)
        for (const int side : {-1, 1})
          EXPECT_FALSE(robot.planner.line({x, 0, 0}, {x, side * 1.5, 0}).passable) << x << ' ' << side;
    }
}

// A pump beside the track of a tracked robot of geb079 was ground, half as high as it.
TEST(RouteScans, AThingBesideTheRobotIsNoGround) {
  for (const double noise : {0.0, 0.02})
    for (const double away : {0.45, 0.7, 1.0}) {
      SCOPED_TRACE("noise " + std::to_string(noise) + ", " + std::to_string(away) + " m beside");
      Looking robot{tracked(), noise};
      const BoxWorld world{{{3.4, 3.9, -away - 0.4, -away, 0, 0.4}, {-6, 12, 3, 3.2}, {-6, 12, -3.2, -3}}};
      for (double x = 0.0; x <= 6.0; x += 0.1) {
        robot.pose = {x, 0, 0};
        robot.look(world, 2);
      }
      for (double x = 3.45; x < 3.9; x += 0.1) EXPECT_TRUE(robot.blocked(x, -away)) << x;
      const int ix = route_cell(3.65), iy = route_cell(-away - 0.05);
      int sheets = 0;
      for (int i = robot.planner.map().first(tile_of(ix), tile_of(iy)); i >= 0;
           i = robot.planner.map().tile(i).next)
        ++sheets;
      EXPECT_EQ(sheets, 1);
    }
}

TEST(RouteScans, WhatStoodNearAndLeftIsFreed) {
  const BoxWorld empty = walls_at(2.0);
  for (const double at : {1.2, 2.0, 3.5}) {
    SCOPED_TRACE(std::to_string(at) + " m ahead");
    BoxWorld crate = empty;
    crate.boxes.push_back({at, at + 0.4, -2.0, 2.0, 0, 1.8});
    Looking robot{wheeled(), 0.02};
    robot.look(crate, 20);
    EXPECT_FALSE(robot.planner.line({0, 0, 0}, {5, 0, 0}).passable);
    robot.look(empty, 40);
    EXPECT_TRUE(robot.planner.line({0, 0, 0}, {5, 0, 0}).passable);
  }
}

// The local map forgets an obstacle that is hidden for some seconds; the map of the routes does not.
TEST(RouteScans, AHiddenWallStays) {
  BoxWorld open = walls_at(4.0);
  open.boxes.push_back({2.0, 2.3, -2.0, 2.0, 0, 1.8});
  BoxWorld hidden = open;
  hidden.boxes.push_back({1.2, 1.4, -2.5, 2.5, 0, 1.8});
  Looking robot{wheeled(), 0.02};
  robot.look(open, 20);
  ASSERT_TRUE(robot.blocked(2.0, 0.5));
  robot.look(hidden, 80);
  EXPECT_TRUE(robot.blocked(2.0, 0.5));
}

// Poses of the own odometry and of what controls the body drift apart.
TEST(RouteScans, NearWallsLieWhereTheOwnOdometrySawThem) {
  Looking robot{wheeled(), 0.02};
  robot.T_lasting_odom = {{12.34, -5.67, 0.8},
                          Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()))};
  robot.look(walls_at(1.0), 20);
  for (double x = -1.0; x < 1.0; x += 0.1)
    for (const int side : {-1, 1}) EXPECT_TRUE(robot.blocked(x, side * 1.0, 0.08)) << x << ' ' << side;
  const auto seen = [&](double x, double y) { return robot.T_lasting_odom * Eigen::Vector3d(x, y, 0); };
  EXPECT_TRUE(robot.planner.line(seen(-3, 0), seen(3, 0)).passable);
  EXPECT_FALSE(robot.planner.line(seen(0, 0), seen(0, 2.5)).passable);
}

// The odometry's height by 1 % of the way.
TEST(RouteScans, AHeightThatDriftsByAMetreMakesNoSecondFloor) {
  for (const Platform& platform : {wheeled(), tracked()}) {
    SCOPED_TRACE(platform.name);
    const BoxWorld hall = walls_at(3.0, 8.0);
    std::array<int, 2> tiles{};
    for (const bool drifts : {false, true}) {
      Looking robot{platform, 0.02};
      double& z = robot.T_lasting_odom.position.z();
      for (int lap = 0; lap < 10; ++lap)
        for (double x = -5.0; x <= 5.0; x += 0.5) {
          robot.pose = {lap % 2 == 0 ? x : -x, 0, lap % 2 == 0 ? 0 : M_PI};
          z += drifts ? 0.005 : 0.0;
          robot.look(hall, 2);
        }
      tiles[drifts] = robot.planner.map().used();
      EXPECT_TRUE(robot.planner.line({-5, 0, z}, {5, 0, z}).passable);
      EXPECT_FALSE(robot.planner.plan({0, 0, z}, {0, 4, z}).found());
    }
    EXPECT_LE(tiles[1], tiles[0] + 3);
  }
}

// Still water shows the walls behind it below the ground. How deep it is, no lidar sees.
TEST(RouteScans, WhatStillWaterMirrorsOpensNoWall) {
  BoxWorld hall = walls_at(3.0, 8.0);
  hall.water = {{1.5, 3.5, -3.0, 0.5}};
  Looking robot{wheeled(), 0.02};
  for (double x = -2.0; x <= 0.5; x += 0.1) {
    robot.pose = {x, -1.0, 0};
    robot.look(hall, 2);
  }
  EXPECT_TRUE(robot.planner.plan({0.5, 1.5, 0}, {6, 1.5, 0}).found());
  EXPECT_FALSE(robot.planner.plan({0.5, -1, 0}, {6, -4, 0}).found());
}

TEST(RouteScans, AGlassPaneBlocksWhereItReturnsRays) {
  BoxWorld hall = walls_at(3.0, 8.0);
  hall.panes = {{2.0, 2.02, -3.0, 1.5}};
  Looking robot{wheeled(), 0.02};
  robot.look(hall, 20);
  EXPECT_TRUE(robot.blocked(2.0, 0.0));
  robot.pose = {1.2, 0, 0};
  robot.look(hall, 20);
  EXPECT_TRUE(robot.blocked(2.0, 0.0));
  EXPECT_FALSE(robot.planner.line({1.2, 0, 0}, {4, 0, 0}).passable);
  const Route round = robot.planner.plan({1.2, 0, 0}, {4, 0, 0});
  EXPECT_TRUE(round.found());
}

TEST(RouteScans, ARobotBesideIsNoObstacle) {
  BoxWorld world = walls_at(3.0);
  world.boxes.push_back({1.5, 2.1, -0.25, 0.25, 0, 0.6});
  Looking robot{wheeled(), 0.02};
  robot.peers = {{2.0f, 0.1f, 0.39f}};  // It claims a place 0.22 m beside its true one.
  robot.look(world, 20);
  EXPECT_FALSE(robot.blocked(1.5, 0.0));
  EXPECT_TRUE(robot.blocked(1.5, 3.0));
}

}  // namespace
}  // namespace adit::nav::test
