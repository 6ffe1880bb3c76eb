// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "nav/local_map/local_map_builder.hpp"
#include "tests/nav/box_world.hpp"
#include "tests/nav/height_world.hpp"

namespace adit::nav::test {
namespace {

/// A robot that drives and looks, and the maps that it makes.
struct Driven {
  Platform platform{wheeled()};
  TerrainMap terrain{platform};
  LocalMapBuilder builder{};
  Pose2 pose{};
  double time{100.0}, drift{0.0};
  std::mt19937 random{7};
  LocalMapOthers others{};
  std::shared_ptr<const LocalMap> map{};

  template <class Points>
  void take(const Points& points, const Pose3& body) {
    time += 0.1;
    Pose3 seen = body;
    seen.position.z() += drift;
    terrain.add_scan(points, seen, time);
    map = builder.make(terrain, {.stamp_s = time, .body = seen, .located = seen}, others);
  }
  void look(const BoxWorld& world, int scans = 1) {
    for (int n = 0; n < scans; ++n)
      take(world.scan(pose, platform.lidar_height, 16, 900, 0.01, random), Pose3::level(pose, 0));
  }
  void look(const HeightWorld& world) {
    const Pose3 body = Pose3::level(pose, world.ground(pose.x, pose.y));
    take(world.scan(platform, body, 16, 450, 0.01, random), body);
  }
};

/// Each cell has the class and the cost of the layers at its place.
void expect_consistent(const Driven& robot) {
  const GroundGrid& ground = robot.terrain.ground();
  const auto classes = robot.builder.ground_classes();
  ASSERT_EQ(classes.size(), ground.cells());
  int other = 0;
  robot.map->visit(5.0f, [&](int ix, int iy, const LocalCell& cell) {
    const float x = LocalMap::centre(ix), y = LocalMap::centre(iy);
    const bool stands = cell.kind == CellClass::obstacle || cell.kind == CellClass::mover;
    if (ground.inside(x, y) && !stands) other += cell.kind != classes[ground.window(x, y)];
    EXPECT_TRUE(cell.impassable() || !(stands || cell.kind == CellClass::drop));
    EXPECT_FALSE(cell.impassable() && cell.kind == CellClass::ground);
  });
  EXPECT_EQ(other, 0);
  for (const ObstacleCells::Entry& entry : robot.terrain.obstacles().entries()) {
    if (!entry.again) continue;
    const CellClass kind = robot.map->find(entry.x(), entry.y())->kind;
    EXPECT_TRUE(kind == CellClass::obstacle || kind == CellClass::mover || kind == CellClass::drop);
  }
  std::set<std::pair<float, float>> drops;
  for (const LocalPlace& place : robot.map->places()) {
    if (place.kind == CellClass::drop && place.cost >= 1) {
      EXPECT_TRUE(drops.insert({place.x, place.y}).second) << "listed twice: " << place.x << " " << place.y;
    }
    const LocalCell* cell = robot.map->find(place.x, place.y);
    ASSERT_NE(cell, nullptr);
    EXPECT_GE(int{cell->cost}, static_cast<int>(place.cost * 254.0f)) << place.x << " " << place.y;
    EXPECT_TRUE(place.cost < 1 || cell->impassable()) << place.x << " " << place.y;
  }
}

BoxWorld room() {
  BoxWorld world;
  world.boxes = {{2.0, 2.2, -3, 1}, {-4, 6, 1.2, 1.4}, {-4, 6, -2.4, -2.2}, {0.9, 1.2, -1.4, -1.1, 0, 0.4}};
  return world;
}

TEST(LocalMap, HoldsTheClassesOfTheTerrain) {
  Driven robot;
  const BoxWorld world = room();
  for (int n = 0; n < 12; ++n) {
    robot.look(world);
    robot.pose = {0.07 * n, 0.02 * n, 0.05 * n};
    expect_consistent(robot);
  }
  EXPECT_TRUE(robot.map->find(2.0f, 0.5f)->impassable());
  EXPECT_FALSE(robot.map->find(1.2f, 0.5f)->impassable());
}

TEST(LocalMap, HoldsDropsStepsAndSlopes) {
  const HeightWorld world{[](double x, double y) {
    if (x > 2.5 && y > 0.5) return HeightWorld::kBottomless;
    if (y < -1.0) return 0.5 * (-1.0 - y);
    return x < -1.5 ? 0.12 : 0.0;
  }};
  Driven robot;
  std::array<int, kCellClasses> counts{};
  for (int n = 0; n < 25; ++n) {
    robot.pose.x = 0.05 * n;
    robot.look(world);
    expect_consistent(robot);
  }
  robot.map->visit(4.0f,
                   [&](int, int, const LocalCell& cell) { ++counts[static_cast<std::size_t>(cell.kind)]; });
  for (const CellClass kind : {CellClass::ground, CellClass::drop, CellClass::slope, CellClass::step})
    EXPECT_GT(counts[static_cast<std::size_t>(kind)], 20) << static_cast<int>(kind);
}

TEST(LocalMap, AnObstacleHasItsExactPlaceAndHeight) {
  Driven robot;
  robot.look(room(), 5);
  int seen = 0;
  robot.map->visit(4.0f, [&](int ix, int iy, const LocalCell& cell) {
    const float x = LocalMap::centre(ix), y = LocalMap::centre(iy);
    if (cell.kind != CellClass::obstacle || x < 1.8f || x > 2.2f || y < -0.8f || y > 0.8f) return;
    ++seen;
    EXPECT_NEAR(x + cell.aside_x * LocalCell::kAsideUnit, 2.0f, 0.03f);
    EXPECT_GT(cell.high, 0.2f);
  });
  EXPECT_GT(seen, 20);
}

TEST(LocalMap, HeightsAreThoseOfTheOdometry) {
  Driven robot;
  const BoxWorld world = room();
  for (int n = 0; n < 40; ++n) {
    robot.drift = 0.01 * n;  // Of the odometry's height.
    robot.pose.x = 0.02 * n;
    robot.look(world);
  }
  int measured = 0;
  double sum = 0.0;
  robot.map->visit(2.0f, [&](int, int, const LocalCell& cell) {
    if (cell.kind != CellClass::ground || !cell.fresh) return;
    ++measured;
    sum += double{cell.low};
  });
  ASSERT_GT(measured, 100);
  EXPECT_NEAR(sum / measured, robot.drift, 0.03);
}

TEST(LocalMap, HeightsAreThoseOfATiltedOdometry) {
  Driven robot;
  BoxWorld world;
  world.boxes = {{8.0, 8.2, -9, 9}};
  double sum = 0.0, registered = 0.0;
  int measured = 0;
  for (int n = 0; n < 30; ++n) {
    robot.pose.x = 0.02 * n;
    const double tilt = n < 10 ? 0.0 : 0.02;  // Of the attitude that the odometry gives, nose down.
    Pose3 body = Pose3::level(robot.pose, 0);
    body.orientation = body.orientation * Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY());
    robot.take(world.scan(robot.pose, robot.platform.lidar_height, 16, 900, 0.01, robot.random), body);
    if (n < 10 || n >= 14) continue;
    registered = std::max(registered, double{robot.terrain.tilt_error().x()});
    robot.map->visit(3.0f, [&](int ix, int, const LocalCell& cell) {
      const double ahead = double{LocalMap::centre(ix)} - robot.pose.x;
      if (cell.kind != CellClass::ground || !cell.fresh || ahead < 1.8) return;
      ++measured;
      sum += double{cell.low} + std::tan(tilt) * ahead;
    });
  }
  ASSERT_GT(registered, 0.01) << "the terrain map stays level";
  ASSERT_GT(measured, 100);
  EXPECT_NEAR(sum / measured, 0.0, 0.015);
}

TEST(LocalMap, WhatMovesAndWhereRobotsStandIsMarkedAndStays) {
  Driven robot;
  const Eigen::Vector2f moving(2.0f, 0.5f);
  const Eigen::Vector3f peer(1.05f, -1.25f, 0.4f);
  robot.others = {{&moving, 1}, {&peer, 1}};
  robot.look(room(), 5);
  EXPECT_TRUE(std::ranges::any_of(robot.map->places(),
                                  [](const LocalPlace& place) { return place.kind == CellClass::mover; }));
  int movers = 0, peers = 0, blocked = 0;
  robot.map->visit(4.0f, [&](int ix, int iy, const LocalCell& cell) {
    const Eigen::Vector2f at(LocalMap::centre(ix), LocalMap::centre(iy));
    movers += cell.kind == CellClass::mover;
    EXPECT_TRUE(cell.kind != CellClass::mover || (at - moving).norm() < 0.36f);
    peers += cell.peer;
    blocked += cell.peer && cell.impassable();
    EXPECT_EQ(cell.peer, (at - peer.head<2>()).norm() <= 0.7f) << "0.4 m, and 0.3 m of errors";
  });
  EXPECT_GT(movers, 5);
  EXPECT_GT(peers, 150);
  EXPECT_GT(blocked, 3) << "what is seen there stays";
  expect_consistent(robot);
}

TEST(LocalMap, BadPlacesOfOthersAreLeftOut) {
  Driven robot;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::array peers{Eigen::Vector3f(nan, 0, 1), Eigen::Vector3f(1e30f, 0, 1),
                         Eigen::Vector3f(0, 0, 1e30f), Eigen::Vector3f(3, 0, -1)};
  const std::array moving{Eigen::Vector2f(nan, nan), Eigen::Vector2f(-1e30f, 1e30f)};
  robot.others = {moving, peers};
  robot.look(room(), 2);
  int marked = 0;
  robot.map->visit(6.0f, [&](int, int, const LocalCell& cell) { marked += cell.peer; });
  EXPECT_LT(marked, 6700) << "a disc of 2.3 m at most";
}

TEST(LocalMap, KnownStairsHaveNoCostOfTheirDrops) {
  // A flight down, as a robot that climbs sees it from above.
  const HeightWorld world{
      [](double x, double) { return x < 1.5 ? 0.0 : -0.17 * std::floor((x - 1.5) / 0.3 + 1); }};
  for (const bool known : {false, true}) {
    Driven robot;
    robot.platform = legged();
    robot.terrain = TerrainMap(robot.platform);
    for (int n = 0; n < 12; ++n) {
      robot.pose.x = 0.05 * n;
      if (known) {
        const Staircase stairs{.foot = {1.5 + 12 * 0.3, 0, -12 * 0.17},
                               .heading = M_PI,
                               .rise = 0.17,
                               .run = 0.3,
                               .width = 6.0,
                               .steps = 12};
        robot.terrain.set_stairs(std::span(&stairs, 1));
      }
      robot.look(world);
      expect_consistent(robot);
      int alone = 0;
      robot.map->visit(4.0f, [&](int ix, int iy, const LocalCell& cell) {
        const float x = LocalMap::centre(ix), y = LocalMap::centre(iy);
        alone += cell.cost > 100 && std::ranges::none_of(robot.map->places(), [&](const LocalPlace& place) {
                   return std::abs(place.x - x) < 0.16f && std::abs(place.y - y) < 0.16f;
                 });
      });
      EXPECT_EQ(alone, 0) << known;
    }
  }
}

TEST(LocalMap, ABodyFarFromEverythingHasNoCells) {
  Driven robot;
  for (const double x : {1e9, -3e38, std::numeric_limits<double>::quiet_NaN()}) {
    Pose3 body;
    body.position.x() = x;
    const auto map = LocalMapBuilder().make(TerrainMap(robot.platform), {.body = body, .located = body});
    EXPECT_EQ(map->find(static_cast<float>(x), 0), nullptr);
    EXPECT_EQ(map->find(0, 0), nullptr);
  }
  EXPECT_EQ(LocalMap().find(6e7f, 0), nullptr);
}

TEST(LocalMap, AMapThatIsInUseNeverChanges) {
  Driven robot;
  robot.look(room(), 3);
  const std::shared_ptr<const LocalMap> held = robot.map;
  const std::size_t places = held->places().size();
  const LocalCell before = *held->find(2.0f, 0.5f);
  BoxWorld empty;
  for (int n = 0; n < 60; ++n) {
    robot.pose.x -= 0.1;
    robot.look(empty);
  }
  EXPECT_EQ(held->places().size(), places);
  EXPECT_EQ(held->find(2.0f, 0.5f)->kind, before.kind);
  EXPECT_EQ(held->find(2.0f, 0.5f)->low, before.low);
  EXPECT_FALSE(robot.map->find(2.0f, 0.5f) && robot.map->find(2.0f, 0.5f)->impassable());
}

TEST(LocalMap, OutsideThereIsNothing) {
  Driven robot;
  robot.pose = {-31.3, 17.2, 1.0};
  robot.look(BoxWorld{});
  EXPECT_NE(robot.map->find(-31.3f - 6.3f, 17.2f), nullptr);
  EXPECT_NE(robot.map->find(-31.3f, 17.2f + 6.3f), nullptr);
  EXPECT_EQ(robot.map->find(-31.3f - 6.5f, 17.2f), nullptr);
  EXPECT_EQ(robot.map->find(-31.3f, 17.2f + 6.5f), nullptr);
  EXPECT_EQ(robot.map->find(0, 0), nullptr);
  EXPECT_EQ(LocalMap().find(0, 0), nullptr);
}

TEST(LocalMap, AFlyingRobotHasWhatIsAtTheHeightOfItsBody) {
  const Platform platform = aerial();
  AirMap air(platform);
  LocalMapBuilder builder;
  BoxWorld world;
  world.boxes = {{2.0, 2.2, -1, 1}, {-2.2, -2.0, -1, 1, 0, 0.2}};
  std::mt19937 random(3);
  Pose3 body = Pose3::level({}, 1.2);
  for (int n = 0; n < 3; ++n) {
    auto points = world.scan({}, 1.2 + platform.lidar_height, 16, 900, 0.01, random);
    for (auto& point : points) point.z() -= 1.2f;
    air.add_scan(points, body, 0.1 * n);
  }
  const auto map = builder.make(air, {.stamp_s = 0.2, .body = body, .located = body});
  ASSERT_EQ(map->places().size(), air.cells().size());
  ASSERT_FALSE(air.cells().empty());
  for (const LocalPlace& place : map->places()) {
    EXPECT_GT(place.x, 1.8f) << "the low box is below";
    EXPECT_TRUE(map->find(place.x, place.y)->impassable());
  }
}

}  // namespace
}  // namespace adit::nav::test
