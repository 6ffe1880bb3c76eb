// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <limits>

#include "tests/nav/box_world.hpp"
#include "tests/nav/places.hpp"

namespace adit::nav::test {
namespace {

/// A robot that stands or is put somewhere, and looks.
struct Looker {
  BoxWorld world{};
  Platform platform{wheeled()};
  TerrainMap map{platform};
  Pose2 pose{};
  double time{0};
  int rings{16};
  double noise{0.01};
  std::mt19937 random{11};

  void look(int scans = 1) {
    for (int i = 0; i < scans; ++i, time += 0.1)
      map.add_scan(world.scan(pose, platform.lidar_height, rings, 900, noise, random), Pose3::level(pose, 0),
                   time);
  }
  /// Cells within a box of the odometry frame.
  int count(double x0, double x1, double y0, double y1) const {
    int n = 0;
    for (const auto& c : places(map)) n += c.cost >= 1 && c.x >= x0 && c.x <= x1 && c.y >= y0 && c.y <= y1;
    return n;
  }
};

TEST(TerrainMap, AFloorIsFree) {
  Looker robot;
  robot.world.boxes = {{20, 20.2, -20, 20}};
  robot.look(5);
  EXPECT_EQ(places(robot.map).size(), 0u);
}

TEST(TerrainMap, WallIsAtItsTruePosition) {
  Looker robot;
  robot.world.boxes = {{2.0, 2.2, -1, 1}};
  robot.look(5);
  EXPECT_GT(robot.count(1.9, 2.1, -1.1, 1.1), 35);
  EXPECT_EQ(robot.count(-5, 1.9, -5, 5), 0);
}

TEST(TerrainMap, OnlyObstaclesHigherThanTheStepCount) {
  for (const double height : {0.05, 0.30}) {
    Looker robot;
    robot.world.boxes = {{1.9, 2.6, -0.5, 0.5, 0.0, height}};
    robot.look(3);
    EXPECT_EQ(robot.count(1.5, 3, -1, 1) > 0, height > robot.platform.step) << height;
  }
}

TEST(TerrainMap, AKerbAsHighAsTheStepIsFreeHoweverNoisy) {
  // As in an OctoMap of 8 cm cells: a single one of its points taken for an obstacle would be remembered in
  // the blind spot and stop the robot before nothing.
  Looker robot;
  robot.noise = 0.02;
  robot.world.boxes = {{1.2, 8.0, -3, 3, 0.0, 0.08}, {9, 9.2, -5, 5}};
  for (int i = 0; i < 20; ++i, robot.pose.x += 0.02) {
    robot.look(3);
    ASSERT_EQ(robot.count(-5, 5, -5, 5), 0) << robot.pose.x;
  }
}

TEST(TerrainMap, StairsSeenFromAboveAreFreeHoweverNoisy) {
  Looker robot;
  robot.platform = legged();
  robot.map = TerrainMap(robot.platform);
  robot.noise = 0.02;
  robot.rings = 32;
  robot.world.lowest = -45;
  for (int n = 0; n < 3; ++n) robot.world.boxes.push_back({1.0 + 0.3 * n, 6, -3, 3, 0, 0.2 * (n + 1)});
  robot.world.boxes.push_back({-3, -2.8, -3, 3, 0, 0.4});
  for (int i = 0; i < 10; ++i, robot.pose.x += 0.03) {
    robot.look(3);
    ASSERT_LE(robot.count(0.8, 2.0, -1, 1), 2) << robot.pose.x;
  }
  EXPECT_GT(robot.count(-3.1, -2.7, -1, 1), 10) << "what is too high for its legs stands in the way";
}

TEST(TerrainMap, StepSlightlyTooHighForLegsIsAnObstacle) {
  for (const double height : {0.30, 0.35, 0.4})
    for (const double deep : {0.03, 2.0}) {
      Looker robot;
      robot.platform = legged();
      robot.map = TerrainMap(robot.platform);
      robot.noise = 0.02;
      robot.rings = 32;
      robot.world.lowest = -45;
      robot.world.boxes = {{1.5, 1.5 + deep, -1, 1, 0, height}};
      robot.look(6);
      EXPECT_GT(robot.count(1.4, 1.7, -1, 1), 10) << height << " " << deep;
    }
}

TEST(TerrainMap, HighOverhangIsNoObstacle) {
  for (const double low : {0.4, 0.9}) {
    Looker robot;
    robot.world.boxes = {{1.5, 1.7, -1, 1, low, 1.4}};
    robot.look(3);
    EXPECT_EQ(robot.count(1, 2, -1, 1) > 0, low < 0.6) << low;
  }
}

TEST(TerrainMap, ACeilingIsNoObstacle) {
  Looker robot;
  robot.world.ceiling = 0.9;
  robot.world.boxes = {{6, 6.2, -5, 5}};
  robot.look(5);
  EXPECT_EQ(places(robot.map).size(), 0u);
}

TEST(TerrainMap, ARampIsGroundAndAWallOnItIsNot) {
  // The world is level; the robot's own height and the points are what a ramp would give.
  TerrainMap map(wheeled());
  std::vector<Eigen::Vector3f> points;
  for (float x = 0.1f; x < 4; x += 0.1f)
    for (float y = -2; y < 2; y += 0.1f) points.emplace_back(x, y, 0.2f * std::max(0.0f, x - 0.5f));
  for (float y = -1; y < 1; y += 0.02f) points.emplace_back(3.0f, y, 0.2f * 2.5f + 0.3f);
  map.add_scan(points, Pose3{}, 0.0);
  ASSERT_GT(places(map).size(), 20u);
  for (const auto& c : places(map))
    ASSERT_TRUE(c.cost < 1 || std::fabs(c.x - 3.0f) < 0.06f) << c.x << ' ' << c.y;
}

TEST(TerrainMap, AHoleIsAnObstacle) {
  TerrainMap map(wheeled());
  std::vector<Eigen::Vector3f> points;
  for (float x = 0.4f; x < 4; x += 0.05f)
    for (float y = -1; y < 1; y += 0.05f) points.emplace_back(x, y, (x > 2 && x < 3 ? -0.6f : 0.0f));
  map.add_scan(points, Pose3{}, 0.0);
  EXPECT_GT(places(map).size(), 100u);
  for (const auto& c : places(map)) EXPECT_GT(c.x, 1.9f);
}

TEST(TerrainMap, PersonWhoLeftLeavesNoObstacle) {
  Looker robot;
  robot.world.boxes = {{6, 6.2, -5, 5}, {2.0, 2.6, -0.3, 0.3, 0.0, 0.5}};
  robot.look(5);
  ASSERT_GT(robot.count(1.9, 2.7, -0.4, 0.4), 5);
  robot.world.boxes.pop_back();
  robot.look(2);
  EXPECT_GT(robot.count(1.9, 2.7, -0.4, 0.4), 0);  // two scans could be bad luck
  robot.look(8);
  EXPECT_EQ(robot.count(1.9, 2.7, -0.4, 0.4), 0);
}

TEST(TerrainMap, MeasuresTheAgeOfAnObstacle) {
  Looker robot;
  robot.world.boxes = {{2.0, 2.2, -0.3, 0.3}, {6, 6.2, -5, 5}};
  robot.look(20);
  robot.world.boxes.push_back({1.5, 1.7, 0.6, 1.0});  // a team mate comes
  robot.look(3);
  float oldest = 0, youngest = 1e9f;
  for (const auto& c : places(robot.map)) {
    oldest = std::max(oldest, c.age);
    youngest = std::min(youngest, c.age);
  }
  EXPECT_NEAR(oldest, 2.2f, 0.15f);
  EXPECT_LT(youngest, 0.25f);
}

TEST(TerrainMap, RemembersObstaclesInTheBlindSpot) {
  Looker robot;
  robot.world.boxes = {{10, 10.2, -5, 5}, {2.0, 2.2, -0.3, 0.3, 0.0, 0.15}};
  robot.look(3);
  ASSERT_GT(robot.count(1.9, 2.3, -0.4, 0.4), 3);
  robot.pose.x = 1.3;  // 0.7 m before it the lowest ray is 0.31 m above the floor
  robot.look(100);
  EXPECT_GT(robot.count(1.9, 2.3, -0.4, 0.4), 3);
}

TEST(TerrainMap, ForgetsHiddenObstaclesAfterTheirLifetime) {
  Looker robot;
  robot.world.boxes = {{3.0, 3.2, -0.2, 0.2}};
  robot.look(3);
  ASSERT_GT(robot.count(2.9, 3.2, -0.3, 0.3), 3);
  robot.world.boxes = {{1.0, 1.2, -1.5, 1.5}};  // a screen before it
  robot.look(20);
  EXPECT_GT(robot.count(2.9, 3.2, -0.3, 0.3), 3);
  robot.look(30);
  EXPECT_EQ(robot.count(2.9, 3.2, -0.3, 0.3), 0);
}

TEST(TerrainMap, TheOwnBodyIsNotAnObstacle) {
  TerrainMap map(wheeled());
  const std::vector<Eigen::Vector3f> mast{{0.1f, 0.1f, 0.4f}, {-0.28f, 0.2f, 0.3f}, {0.29f, -0.24f, 0.2f}};
  map.add_scan(mast, Pose3{}, 0.0);
  EXPECT_EQ(places(map).size(), 0u);
}

TEST(TerrainMap, SurvivesBadPoints) {
  TerrainMap map(wheeled());
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::vector<Eigen::Vector3f> bad{{nan, 0, 0},  {0, nan, nan}, {inf, 0, 0}, {0, 0, -inf},
                                         {0, 0, 0.5f}, {1e30f, 0, 0}, {0, 0, 0},   {1e-3f, 0, 9}};
  map.add_scan(bad, Pose3{}, 0.0);
  map.add_scan(PointCloud{}, Pose3{}, 0.1);
  EXPECT_EQ(places(map).size(), 0u);
}

TEST(TerrainMap, TakesScansLargerThanAnyLidars) {
  TerrainMap map(wheeled());
  std::mt19937 random(2);
  std::uniform_real_distribution<float> at(-6, 6), z(-2, 2);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 500'000; ++i) points.emplace_back(at(random), at(random), z(random));
  for (int i = 0; i < 3; ++i) map.add_scan(points, Pose3{}, 0.1 * i);
  EXPECT_GT(places(map).size(), 10'000u);
  EXPECT_LE(places(map).size(), map.max_places());
}

TEST(TerrainMap, ForgetsPlacesBeyondItsRange) {
  Looker robot;
  robot.world.boxes = {{-30, 30, 2, 2.2}, {-30, 30, -2.2, -2}};
  for (; robot.pose.x < 15; robot.pose.x += 0.25) {
    robot.look();
    for (const auto& c : places(robot.map))
      ASSERT_LT(std::hypot(c.x - robot.pose.x, c.y - robot.pose.y), 5.1);
  }
  EXPECT_GT(places(robot.map).size(), 200u);
  robot.map.clear();
  EXPECT_EQ(places(robot.map).size(), 0u);
  robot.look(2);
  EXPECT_GT(places(robot.map).size(), 200u);
}

TEST(TerrainMap, OneLevelRingIsEnoughForAWall) {
  Looker robot;
  robot.rings = 1;
  robot.world.boxes = {{2.0, 2.2, -1, 1}};
  robot.look(5);
  EXPECT_GT(robot.count(1.9, 2.1, -1.1, 1.1), 35);
}

}  // namespace
}  // namespace adit::nav::test
