// SPDX-License-Identifier: Apache-2.0
// Lidars that are not over the middle of the body, or several: rays begin where each of them is.
#include <gtest/gtest.h>

#include "nav/monitor/obstacle_detector.hpp"
#include "nav/routing/route_planner.hpp"
#include "tests/nav/box_world.hpp"
#include "tests/nav/places.hpp"

namespace adit::nav::test {
namespace {

/// A robot whose lidar is at its front, in a room, before a post.
struct FrontLidar {
  static Platform platform_with(const Eigen::Vector3d& lidar) {
    Platform out = wheeled();
    LidarConfig config;
    config.mounting.x = lidar.x();
    config.mounting.y = lidar.y();
    config.mounting.z = out.lidar_height = lidar.z();
    out.lidars = {config};
    return out;
  }
  Eigen::Vector3d lidar{0.5, 0, 0.5};
  Platform platform{platform_with(lidar)};
  BoxWorld world{{{6, 6.2, -6, 6}, {-6.2, -6, -6, 6}, {-6, 6, 6, 6.2}, {-6, 6, -6.2, -6}}};
  Pose2 pose{};
  std::mt19937 random{5};

  std::vector<Eigen::Vector3f> scan() { return world.scan(pose, lidar, 16, 900, 0.01, random); }
};

TEST(LidarMounting, TheTerrainKeepsWhatIsBelowTheRaysOfALidarAtTheFront) {
  FrontLidar robot;
  robot.world.boxes.push_back({2.4, 2.6, -0.5, 0.5, 0.0, 0.25});
  TerrainMap map(robot.platform);
  double time = 0;
  const auto cells = [&] {
    map.add_scan(robot.scan(), Pose3::level(robot.pose, 0), time += 0.1);
    int count = 0;
    for (const auto& c : places(map))
      count += c.cost >= 1 && std::abs(c.x - 2.5F) < 0.25F && std::abs(c.y) < 0.5F;
    return count;
  };
  for (; robot.pose.x < 1.4; robot.pose.x += 0.05) cells();
  const int before = cells();
  EXPECT_GT(before, 5);
  for (int n = 0; n < 50; ++n) cells();
  EXPECT_GE(cells(), before);
}

TEST(LidarMounting, WhatIsBelowTheRaysOfALidarAtTheFrontIsRemembered) {
  FrontLidar robot;
  robot.world.boxes.push_back({2.4, 2.6, -0.5, 0.5, 0.0, 0.25});
  ObstacleDetector detector(robot.platform, 3.0);
  double time = 0;
  const auto nearest = [&] {
    const auto& seen = detector.look(robot.scan(), Pose3::level(robot.pose, 0), time += 0.1);
    double least = 9;
    for (const auto& place : seen.places)
      if (std::abs(place.y) < 0.5F) least = std::min(least, std::abs(double{place.x} - robot.pose.x));
    return least;
  };
  for (; robot.pose.x < 1.4; robot.pose.x += 0.05) nearest();
  EXPECT_NEAR(nearest(), 1.0, 0.1);
  for (int n = 0; n < 50; ++n) nearest();
  EXPECT_NEAR(nearest(), 1.0, 0.1);
}

TEST(LidarMounting, RoutesFreeOnlyWhatALidarAtTheFrontSaw) {
  FrontLidar robot;
  robot.world.boxes.push_back({1.45, 1.55, 0.55, 0.65, 0.0, 1.2});
  RoutePlanner planner(robot.platform);
  for (int n = 0; n < 50; ++n) planner.add_scan(robot.scan(), Pose3::level(robot.pose, 0), 0.1 * n);
  planner.finish();
  const auto blocked = [&](double x, double y) {
    const GroundCell* cell = planner.map().cell(route_cell(x), route_cell(y), 0);
    return cell && cell->blocked;
  };
  EXPECT_TRUE(blocked(1.46, 0.6));
  // What the post hides from the lidar, and not from the middle of the body.
  const GroundCell* behind = planner.map().cell(route_cell(2.55), route_cell(1.25), 0);
  EXPECT_FALSE(behind && behind->known);
  const GroundCell* beside = planner.map().cell(route_cell(2.55), route_cell(0.95), 0);
  EXPECT_TRUE(beside && beside->known && !beside->blocked);
}

/// Two lidars, and a plate between the first one and what the second one sees.
struct TwoLidars {
  std::vector<Eigen::Vector3f> points{};
  std::vector<ScanPart> parts{{{-0.5, 0, 0.5}, 0}, {{0.5, 0, 0.5}, 0}};
  explicit TwoLidars(bool plate) {
    for (double y = -0.6; plate && y <= 0.6; y += 0.02)
      for (double z = 0; z <= 1; z += 0.2) points.push_back(Eigen::Vector3d(0.45, y, z).cast<float>());
    parts[0].count = points.size();
    for (double y = -1; y <= 1; y += 0.02)
      for (double z = 0; z <= 1; z += 0.2) points.push_back(Eigen::Vector3d(3, y, z).cast<float>());
    parts[1].count = points.size() - parts[0].count;
  }
  ScanPoints scan() const { return {points, parts}; }
};

TEST(LidarMounting, ASecondLidarFreesNothingThatStandsBeforeTheFirst) {
  const Platform platform = FrontLidar::platform_with({-0.5, 0, 0.5});
  const TwoLidars both(true), second(false);
  RoutePlanner planner(platform);
  planner.add_scan(both.scan(), {}, 0.0);
  for (int n = 1; n < 3; ++n) planner.add_scan(both.scan(), {}, 0.1 * n);
  const auto blocked = [&](double x, double y) {
    const GroundCell* cell = planner.map().cell(route_cell(x), route_cell(y), 0);
    return cell && cell->blocked;
  };
  EXPECT_TRUE(blocked(0.45, 0.45));
  for (int n = 3; n < 40; ++n) planner.add_scan(second.scan(), {}, 0.1 * n);
  EXPECT_TRUE(blocked(0.45, 0.45));
  EXPECT_TRUE(blocked(3.05, 0.4)) << "what the second one sees is there, too";
}

TEST(LidarMounting, WhatASecondLidarSeesThroughIsFree) {
  // The first one on the roof sees nothing near the body; the second one below it sees someone who walks on.
  const Eigen::Vector3d roof(0, 0, 2.0), low(0.3, 0, 0.3);
  const Platform platform = FrontLidar::platform_with(roof);
  BoxWorld world{{{6, 6.2, -6, 6}, {-6.2, -6, -6, 6}, {-6, 6, 6, 6.2}, {-6, 6, -6.2, -6}}, 4.0};
  std::mt19937 random(5);
  TerrainMap map(platform);
  const auto look = [&](double time) {
    auto points = world.scan({}, roof, 16, 900, 0.01, random);
    std::vector<ScanPart> parts{{roof, points.size()}};
    const auto more = world.scan({}, low, 16, 900, 0.01, random);
    points.insert(points.end(), more.begin(), more.end());
    parts.push_back({low, more.size()});
    map.add_scan(ScanPoints(points, parts), {}, time);
    int cells = 0;
    for (const auto& c : places(map)) cells += c.cost >= 1 && std::hypot(c.x - 1.5F, c.y) < 0.5F;
    return cells;
  };
  for (int n = 0; n < 5; ++n) EXPECT_EQ(look(0.1 * n), 0);
  world.boxes.push_back({1.4, 1.6, -0.2, 0.2, 0.0, 0.8});
  int there = 0;
  for (int n = 5; n < 10; ++n) there = look(0.1 * n);
  EXPECT_GT(there, 0);
  world.boxes.pop_back();
  for (int n = 10; n < 40; ++n) there = look(0.1 * n);
  EXPECT_EQ(there, 0);
}

TEST(LidarMounting, OnlyTheFirstLidarsRaysAreThoseOfOneViewpoint) {
  const TwoLidars both(true);
  EXPECT_EQ(both.scan().first().size(), both.parts[0].count);
  EXPECT_EQ(both.scan().all().size(), both.points.size());
  std::size_t points = 0;
  both.scan().each_part({9, 9, 9}, [&](auto part, const Eigen::Vector3d& origin) {
    EXPECT_NEAR(std::abs(origin.x()), 0.5, 1e-9);
    points += part.size();
  });
  EXPECT_EQ(points, both.points.size());
  EXPECT_EQ(ScanPoints(both.points).origin({9, 8, 7}), Eigen::Vector3d(9, 8, 7));
}

}  // namespace
}  // namespace adit::nav::test
