// SPDX-License-Identifier: Apache-2.0
// The terrain map's layers, over ground that is not flat.
#include <gtest/gtest.h>

#include "tests/nav/box_world.hpp"
#include "tests/nav/height_world.hpp"
#include "tests/nav/places.hpp"

namespace adit::nav::test {
namespace {

/// A robot that is put somewhere on the ground, and looks. Its odometry knows no height, unless `spatial`.
struct Climber {
  HeightWorld world;
  Platform platform;
  TerrainMap map;
  Pose2 pose{};
  double time{0}, noise{0.01};
  bool spatial{false};
  int rings{16};
  std::mt19937 random{5};

  Climber(const Platform& p, std::function<double(double, double)> ground)
      : world{std::move(ground)}, platform(p), map(p) {}

  void look(int scans = 1) {
    for (int i = 0; i < scans; ++i, time += 0.1) {
      const Pose3 body = Pose3::level(pose, world.ground(pose.x, pose.y));
      map.add_scan(world.scan(platform, body, rings, 450, noise, random),
                   spatial ? body : Pose3::level(pose, 0), time);
    }
  }
  void drive_to(double x) {
    for (; pose.x < x; pose.x += 0.1) look();
  }
  std::vector<LocalPlace> within(double x0, double x1, double y0, double y1) const {
    std::vector<LocalPlace> found;
    for (const LocalPlace& c : places(map))
      if (c.x >= x0 && c.x <= x1 && c.y >= y0 && c.y <= y1) found.push_back(c);
    return found;
  }
  int blocked(double x0, double x1, double y0, double y1) const {
    int n = 0;
    for (const LocalPlace& c : within(x0, x1, y0, y1)) n += c.cost >= 1;
    return n;
  }
  /// The highest cost.
  double worst(double x0, double x1, double y0, double y1) const {
    double cost = 0;
    for (const LocalPlace& c : within(x0, x1, y0, y1)) cost = std::max<double>(cost, c.cost);
    return cost;
  }
  bool has(CellClass kind) const {
    return std::ranges::any_of(places(map), [&](const LocalPlace& place) { return place.kind == kind; });
  }
};

std::function<double(double, double)> ramp(double slope, double from = 1.5) {
  return [=](double x, double) { return slope * std::max(0.0, x - from); };
}

TEST(TerrainLayers, ARampCostsByItsShareOfWhatThePlatformCan) {
  for (const auto& [slope, wheels, tracks] : {std::tuple{0.12, 0, 0}, {0.26, 1, 0}, {0.45, 2, 1}}) {
    const auto verdict = [](double cost) { return cost >= 1 ? 2 : cost > 0 ? 1 : 0; };
    Climber on_wheels(wheeled(), ramp(slope)), on_tracks(tracked(), ramp(slope));
    on_wheels.drive_to(0.4);
    on_tracks.drive_to(0.4);
    EXPECT_EQ(verdict(on_wheels.worst(2.0, 2.8, -0.5, 0.5)), wheels) << slope;
    EXPECT_EQ(verdict(on_tracks.worst(2.0, 2.8, -0.5, 0.5)), tracks) << slope;
  }
}

TEST(TerrainLayers, AStepStopsWheelsAndNotLegs) {
  for (const auto& [platform, height] : {std::pair{wheeled(), 0.14},
                                         {tracked(), 0.14},
                                         {legged(), 0.14},
                                         {tracked(), 0.24},
                                         {legged(), 0.34}}) {
    Climber robot(platform, [h = height](double x, double) { return x > 1.5 ? h : 0.0; });
    robot.pose.x = -2;
    robot.drive_to(0.5);
    EXPECT_EQ(robot.blocked(1.3, 1.8, -1, 1) > 10, platform.step < height) << platform.name << height;
    EXPECT_GT(robot.worst(1.3, 1.8, -1, 1), 0) << platform.name << height;
  }
}

double stairs(double x, double) { return x > 1.5 ? std::min(6.0, std::ceil((x - 1.5) / 0.3)) * 0.17 : 0.0; }

TEST(TerrainLayers, StairsAreForLegs) {
  Climber on_wheels(wheeled(), stairs), on_legs(legged(), stairs);
  on_wheels.pose.x = on_legs.pose.x = -1.5;
  on_wheels.drive_to(0.3);
  EXPECT_GT(on_wheels.blocked(1.4, 2.0, -1, 1), 10);
  while (on_legs.pose.x < 3.8) {  // all the way up, by an odometry that knows no height
    on_legs.look();
    const double x = on_legs.pose.x;
    ASSERT_EQ(on_legs.blocked(x - 0.5, x + 1.0, -0.6, 0.6), 0) << x;
    on_legs.pose.x += 0.05;
  }
}

TEST(TerrainLayers, GravelIsRoughForSmallWheelsOnly) {
  // Stones of 7 cm, 15 cm wide and as far apart.
  const auto gravel = [](double x, double y) {
    const bool odd = (static_cast<int>(std::floor(x / 0.15)) + static_cast<int>(std::floor(y / 0.15))) & 1;
    return x > 1 && odd ? 0.07 : 0.0;
  };
  Climber on_wheels(wheeled(), gravel), on_legs(legged(), gravel);
  on_wheels.drive_to(1.0);
  on_legs.drive_to(1.0);
  EXPECT_GT(on_wheels.worst(1.5, 3, -1, 1), 0);
  EXPECT_TRUE(on_wheels.has(CellClass::step));
  EXPECT_EQ(on_wheels.blocked(1.5, 3, -1, 1), 0);
  EXPECT_EQ(on_legs.worst(1.5, 3, -1, 1), 0);
}

TEST(TerrainLayers, TheEdgeOfADropIsWhereTheGroundEnds) {
  for (const double depth : {0.4, 1.0, 3.0}) {
    Climber robot(wheeled(), [=](double x, double) { return x > 2 ? -depth : 0.0; });
    robot.pose.x = -2;
    robot.drive_to(0);
    // A floor out of the lidar's reach is silence, which only slows from more than 2 m away.
    EXPECT_GT(robot.worst(1.8, 2.4, -0.5, 0.5), 0.5) << depth << ": seen from afar";
    EXPECT_EQ(robot.blocked(1.8, 2.4, -0.5, 0.5) > 0, depth < 2) << depth << ": seen from afar";
    robot.drive_to(1.3);
    EXPECT_GT(robot.blocked(1.8, 2.2, -0.5, 0.5), 5) << depth;
    EXPECT_GT(robot.blocked(1.9, 2.0, -0.5, 0.5), 5) << depth << ": the last cell of the ground";
    EXPECT_EQ(robot.blocked(0.5, 1.8, -0.5, 0.5), 0) << depth;
    robot.look(30);  // now in the blind spot
    EXPECT_GT(robot.blocked(1.8, 2.2, -0.5, 0.5), 5) << depth;
    EXPECT_TRUE(robot.has(CellClass::drop));
  }
}

// The floor behind it is as high as where the robot came from.
TEST(TerrainLayers, TheEdgeAtTheTopOfARampIsADrop) {
  Climber robot(wheeled(), [](double x, double) { return x > 4 ? 0.0 : 0.15 * std::max(0.0, x); });
  robot.spatial = true;
  robot.pose.x = -1;
  robot.drive_to(3.0);
  EXPECT_GT(robot.blocked(3.7, 4.3, -0.5, 0.5), 5);
  EXPECT_EQ(robot.blocked(1.0, 3.7, -0.5, 0.5), 0);
}

TEST(TerrainLayers, AHoleIsADropWithOrWithoutABottom) {
  for (const double bottom : {-0.7, HeightWorld::kBottomless}) {
    const auto hole = [=](double x, double y) {
      return x > 2 && x < 2.9 && std::fabs(y) < 0.6 ? bottom : 0.0;
    };
    Climber robot(wheeled(), hole);
    robot.pose.x = -2.0;
    robot.drive_to(1.2);
    EXPECT_GT(robot.blocked(1.9, 2.4, -0.4, 0.4), 5) << bottom;
    EXPECT_EQ(robot.blocked(0.5, 1.8, -2, 2), 0) << bottom;
    EXPECT_EQ(robot.blocked(1.0, 3.5, 0.9, 2), 0) << bottom << ": beside it";
  }
}

// With dense rings the ring behind one that ends at an edge may be taken for it.
TEST(TerrainLayers, AnAbyssIsADropToLidarsOfAnyDensity) {
  for (const int rings : {16, 32, 64}) {
    Platform platform = wheeled();
    platform.lidar_rings = rings;
    Climber robot(platform, [](double x, double) { return x > 2 ? HeightWorld::kBottomless : 0.0; });
    robot.rings = rings;
    robot.pose.x = -2;
    robot.drive_to(1.3);
    EXPECT_GT(robot.blocked(1.8, 2.2, -0.5, 0.5), 5) << rings;
    EXPECT_EQ(robot.blocked(0.5, 1.8, -0.5, 0.5), 0) << rings;
  }
}

TEST(TerrainLayers, ARampDownIsNoDrop) {
  Climber robot(wheeled(), [](double x, double) { return -0.12 * std::clamp(x - 1.5, 0.0, 4.0); });
  robot.pose.x = -1.5;
  while (robot.pose.x < 5.5) {
    robot.look();
    ASSERT_EQ(robot.blocked(robot.pose.x - 1, robot.pose.x + 1.2, -0.8, 0.8), 0) << robot.pose.x;
    robot.pose.x += 0.05;
  }
}

TEST(TerrainLayers, ADropThatWasFilledIsGroundAgain) {
  Climber robot(wheeled(), [](double x, double) { return x > 2 ? -1.0 : 0.0; });
  robot.drive_to(0.5);
  ASSERT_GT(robot.blocked(1.8, 2.3, -0.5, 0.5), 0);
  robot.world.ground = [](double, double) { return 0.0; };
  robot.pose.x = -0.5;
  robot.drive_to(0.8);
  EXPECT_EQ(robot.blocked(1, 3, -0.5, 0.5), 0);
}

TEST(TerrainLayers, ABodyThatLeansSeesItsRampAsGround) {
  TerrainMap map(wheeled());
  Climber robot(wheeled(), ramp(0.25, -50));
  const Pose3 body{{0, 0, 12.5},
                   Eigen::Quaterniond(Eigen::AngleAxisd(-std::atan(0.25), Eigen::Vector3d::UnitY()))};
  std::mt19937 random(3);
  for (int i = 0; i < 5; ++i)
    map.add_scan(robot.world.scan(wheeled(), body, 16, 450, 0.01, random), body, 0.1 * i);
  for (const LocalPlace& c : places(map)) ASSERT_LT(c.cost, 1) << c.x << ' ' << c.y;
}

TEST(TerrainLayers, AnOdometryThatDriftsUpwardsLeavesTheTerrainAsItIs) {
  Climber robot(wheeled(),
                [](double x, double y) { return std::fabs(y) > 1.5 ? 0.6 : 0.01 * std::sin(3 * x); });
  double drift = 0;
  for (int i = 0; i < 60; ++i, drift += 0.02, robot.pose.x += 0.05) {  // 0.4 m for each metre
    const Pose3 body = Pose3::level(robot.pose, 0);
    const auto scan = robot.world.scan(robot.platform, body, 16, 450, 0.01, robot.random);
    robot.map.add_scan(scan, Pose3::level(robot.pose, drift), 0.1 * i);
    ASSERT_EQ(robot.blocked(robot.pose.x - 3, robot.pose.x + 3, -1.3, 1.3), 0) << robot.pose.x;
  }
  EXPECT_NEAR(robot.map.height_correction(), -drift, 0.1);
}

}  // namespace
}  // namespace adit::nav::test
