// SPDX-License-Identifier: Apache-2.0
// The global planner over scans, and the robot that follows it.
#include <gtest/gtest.h>

#include "tests/nav/height_world.hpp"
#include "tests/nav/route_drive.hpp"
#include "tests/nav/route_world.hpp"

namespace adit::nav::test {
namespace {

TEST(RouteScans, SeesWallsAndGround) {
  BoxWorld world{
      {{-5, 10, 3, 3.2}, {-5, 10, -3.2, -3}, {10, 10.2, -3, 3}, {-5.2, -5, -3, 3}, {4, 5, -1, 1, 0, 0.4}}};
  std::mt19937 random(1);
  for (const int rings : {1, 16}) {
    RoutePlanner planner(wheeled());
    if (rings == 1) world.boxes.back().z1 = 2.5;
    for (int i = 0; i < 6; ++i)
      planner.add_scan(world.scan({0, 0, 0}, 0.5, rings, 360, 0.01, random), Pose3::level({0, 0, 0}, 0),
                       0.1 * i);
    planner.finish();
    EXPECT_FALSE(planner.line({0, 0, 0}, {5.7, 0, 0}).passable) << rings;
    EXPECT_FALSE(planner.line({0, 0, 0}, {0, 5, 0}).passable) << rings;
    const LineCost free = planner.line({0, 2, 0}, {5.5, 2, 0});
    EXPECT_TRUE(free.passable) << rings;
    EXPECT_LT(free.unknown, 1.0) << rings;
  }
}

// Ground that rises above the lidar, and behind it a return just above the lidar: no ray passes from the
// lidar through the ground's height between them. The edge of a drop once lay 1 km away there, and the map
// with it.
TEST(RouteScans, ADropBehindGroundAboveTheLidarEndsWhereItWasSeen) {
  RoutePlanner planner(wheeled());
  std::vector<Eigen::Vector3f> points;
  for (const auto& [x, z] :
       {std::pair{1.5f, 0.05f}, std::pair{2.3f, 0.3f}, std::pair{3.1f, 0.55f}, std::pair{3.9f, 0.8f},
        std::pair{4.7f, 1.05f}, std::pair{5.5f, 1.2f}, std::pair{7.0f, 0.501f}})
    points.emplace_back(x, 0.01f, z);
  for (int i = 0; i < 3; ++i) planner.add_scan(points, Pose3::level({0, 0, 0}, 0), 0.1 * i);
  EXPECT_LT(planner.map().extent().x1, 10);
}

TEST(RouteScans, ObstacleThatWentAwayIsFreed) {
  BoxWorld empty{{{-5, 10, 1, 1.2}, {-5, 10, -1.2, -1}, {10, 10.2, -1, 1}, {-5.2, -5, -1, 1}}};
  BoxWorld person = empty;
  person.boxes.push_back({3, 3.4, -1, 1, 0, 1.8});
  std::mt19937 random(1);
  RoutePlanner planner(wheeled());
  const auto look = [&](const BoxWorld& world, int times) {
    for (int i = 0; i < times; ++i)
      planner.add_scan(world.scan({0, 0, 0}, 0.5, 16, 360, 0.01, random), Pose3::level({0, 0, 0}, 0), 0.0);
  };
  look(empty, 5);
  EXPECT_TRUE(planner.plan({0, 0, 0}, {8, 0, 0}).found());
  look(person, 5);
  EXPECT_FALSE(planner.plan({0, 0, 0}, {8, 0, 0}).found());
  look(empty, 15);
  EXPECT_TRUE(planner.plan({0, 0, 0}, {8, 0, 0}).found());
}

TEST(RouteScans, AnAttitudeThatWandersMakesNoSteps) {
  const HeightWorld plain{[](double, double) { return 0.0; }};
  std::mt19937 random(1);
  RoutePlanner planner(wheeled());
  const auto reported = [](double x, double degrees) {
    return Pose3{{x, 0, 0},
                 Eigen::Quaterniond(Eigen::AngleAxisd(degrees * M_PI / 180, Eigen::Vector3d::UnitY()))};
  };
  for (int i = 0; i < 40; ++i) {
    const double x = 0.05 * i;
    const auto points = plain.scan(wheeled(), Pose3::level({x, 0, 0}, 0), 16, 180, 0.01, random);
    planner.add_scan(points, reported(x, std::sin(0.4 * i)), 0.1 * i);
  }
  planner.finish();
  for (const double y : {-3.0, 0.0, 3.0})
    EXPECT_TRUE(planner.line({2.5, y, 0}, {8.5, y, 0}).passable) << "y = " << y;
}

TEST(RouteScans, OutOfADeadEnd) {
  RouteDrive drive(wheeled(),
                   {{{4, 4.3, -3, 3},
                     {-3, 4.3, 3, 3.3},
                     {-3, 4.3, -3.3, -3},
                     {-8, 12, 8, 8.2},
                     {-8, 12, -8.2, -8},
                     {12, 12.2, -8, 8},
                     {-8.2, -8, -8, 8}}},
                   {0, 0, 0});
  EXPECT_TRUE(drive.to(8, 0, 60));
  EXPECT_GT(drive.loop.least_clearance, 0.0);
}

TEST(RouteScans, ClosedRoomIsUnreachable) {
  RouteDrive drive(wheeled(),
                   {{{4, 4.3, -3, 3}, {-3, 4.3, 3, 3.3}, {-3, 4.3, -3.3, -3}, {-3.3, -3, -3.3, 3.3}}},
                   {0, 0, 0});
  EXPECT_FALSE(drive.to(8, 0, 60));
  EXPECT_EQ(drive.step.state, RouteStep::State::unreachable);
  EXPECT_LT(drive.loop.time, 10.0);
}

// FAR planner drives 60 m in this world.
TEST(RouteScans, CornerToCornerOfAnUnknownCity) {
  RouteDrive drive(wheeled(), city(3, 8, 3.2), {1.6, 1.6, 0});
  EXPECT_TRUE(drive.to(35.2, 35.2, 60));
  RecordProperty("seconds", std::to_string(drive.loop.time));
  EXPECT_LT(drive.loop.driven, 66.0);
  EXPECT_GT(drive.loop.least_clearance, 0.0);
}

}  // namespace
}  // namespace adit::nav::test
