// SPDX-License-Identifier: Apache-2.0
// What a robot has seen of the space around it.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "nav/explore/explorer.hpp"
#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

constexpr double kEye = 0.75;  // Height of the lidar, m.

/// A robot among boxes, and a coverage map that takes every scan of its lidar.
struct Watcher {
  BoxWorld world{};
  Pose2 pose{};
  double noise{0.02};
  CoverageMap map{};
  std::mt19937 random{1};

  void look(int scans) {
    for (int n = 0; n < scans; ++n)
      map.add_scan(world.scan(pose, kEye, 16, 900, noise, random), {0, 0, kEye}, Pose3::level(pose, 0));
  }
};

/// A closed room of 6 x 6 m; in its wall at x = 6 is a door of 1.2 m to a hall. The door is the last box.
BoxWorld room_with_a_door() {
  BoxWorld world;
  world.ceiling = 3.0;
  world.boxes = {{-0.3, 0, 0, 6, 0, 3},   {0, 6, -0.3, 0, 0, 3},      {0, 6, 6, 6.3, 0, 3},
                 {6, 6.2, 0, 2.4, 0, 3},  {6, 6.2, 3.6, 6, 0, 3},     {20, 20.3, -9, 15, 0, 3},
                 {6, 20, -9.3, -9, 0, 3}, {6, 20, 15, 15.3, 0, 3},    {6, 6.2, -9, 0, 0, 3},
                 {6, 6.2, 6, 15, 0, 3},   {6.1, 6.15, 2.4, 3.6, 0, 3}};
  return world;
}

// A robot that was driven by hand for 20 m, and stood for a while, begins to explore.
TEST(CoverageMap, AnExplorationKnowsWhatTheDriveBeforeItHasShown) {
  Watcher robot{room_with_a_door(), {1.6, 3.1, 0}};
  robot.world.boxes.pop_back();
  Platform platform = wheeled();
  platform.lidar_height = kEye;
  RoutePlanner planner(platform);
  Explorer explorer(platform);
  RouteGround ground(planner, platform);
  double stamp = 0;
  const auto look = [&] {
    const auto points = robot.world.scan(robot.pose, kEye, 16, 450, robot.noise, robot.random);
    const Pose3 body = Pose3::level(robot.pose, 0);
    planner.add_scan(points, body, stamp += 0.2);
    explorer.add_scan(points, body);
    robot.map.add_scan(points, {0, 0, kEye}, body);
  };
  for (int n = 0; n < 60; ++n) look();
  for (; robot.pose.x < 13; robot.pose.x += 0.2) look();
  for (; robot.pose.y < 9; robot.pose.y += 0.2) look();
  for (int n = 0; n < 60; ++n) look();
  EXPECT_GT(explorer.coverage().seen_volume(), 0.97 * robot.map.seen_volume());
  explorer.begin();
  const ExploreStep step = explorer.step(ground, {robot.pose.x, robot.pose.y, 0}, stamp, false);
  ASSERT_TRUE(step.goal);
  EXPECT_LT(step.goal->y(), 0) << "the other end of the hall, not what the drive has shown";
}

TEST(CoverageMap, ADoorThatOpensIsNoHitAnyMore) {
  Watcher robot{room_with_a_door(), {3.0, 3.1, 0}};
  const Eigen::Vector3d eye(3.0, 3.1, 1.25), behind(9.0, 3.1, 1.25);
  robot.look(50);
  EXPECT_FALSE(robot.map.visible(eye, behind));
  robot.world.boxes.pop_back();
  robot.look(6);
  EXPECT_FALSE(robot.map.visible(eye, behind)) << "what was hit stays for some scans";
  robot.look(4);
  EXPECT_TRUE(robot.map.visible(eye, behind));
}

TEST(CoverageMap, APersonInADoorwayIsForgotten) {
  Watcher robot{room_with_a_door(), {3.0, 3.1, 0}};
  robot.world.boxes.back() = {5.9, 6.3, 2.8, 3.3, 0, 1.8};
  const Eigen::Vector3d eye(3.0, 3.1, 0.75), behind(9.0, 3.1, 0.75);
  robot.look(50);
  EXPECT_FALSE(robot.map.visible(eye, behind));
  robot.world.boxes.pop_back();
  robot.look(20);
  EXPECT_TRUE(robot.map.visible(eye, behind));
}

// Of the bars of a grating each scan meets other ones. Floor and ceiling lie on the border of two voxels, of
// which one is enough.
TEST(CoverageMap, WallsAndAGratingStayHit) {
  Watcher robot{room_with_a_door(), {3.0, 3.1, 0}};
  robot.world.boxes.pop_back();
  for (double y = 2.4; y < 3.6; y += 0.15) robot.world.boxes.push_back({6.1, 6.12, y, y + 0.02, 0, 3});
  robot.look(20);
  const CoverageMap before = robot.map;
  for (int n = 0; n < 100; ++n) {
    robot.pose = {3.0 + 1.5 * std::sin(0.1 * n), 3.1 + 2.0 * std::cos(0.07 * n), 0.05 * n};
    robot.look(1);
  }
  constexpr unsigned kBetween = 0b11110;  // Voxels from 0.5 to 2.5 m.
  int lost = 0;
  for (const CoverageMap::Tile& tile : before.tiles())
    for (int c = 0; c < CoverageMap::kSide * CoverageMap::kSide; ++c) {
      const int x = tile.tx * CoverageMap::kSide + c % CoverageMap::kSide,
                y = tile.ty * CoverageMap::kSide + c / CoverageMap::kSide;
      if (tile.band != 0) continue;
      const CoverageMap::Column after = robot.map.column(x, y, 0);
      lost += std::popcount(kBetween & tile.columns[c].hit & ~static_cast<unsigned>(after.hit));
    }
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace adit::nav::test
