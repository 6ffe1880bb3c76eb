// SPDX-License-Identifier: Apache-2.0
// What is a step to the global planner, and what is a ramp, stairs or a wall's foot: from near, from afar,
// leaning.
#include <gtest/gtest.h>

#include <functional>

#include "nav/routing/route_planner.hpp"
#include "tests/nav/box_world.hpp"
#include "tests/nav/route_world.hpp"

namespace adit::nav::test {
namespace {

TEST(RouteSteps, AStepThatWasOnlySeenFromAfarProvesNothing) {
  // Rings far apart on ground that rises 0.3 m in 2 m look like a step; from near it is a ramp.
  for (const double robot : {0.0, 5.0}) {
    RoutePlanner planner(wheeled());
    std::vector<Eigen::Vector3f> points;
    for (float y = -1.6f; y < 1.6f; y += 0.02f) {
      const auto place = [&](double x, double z) {
        points.emplace_back(static_cast<float>(x - robot), y, static_cast<float>(z));
      };
      for (double x = robot + 0.7; x < 8; x += 0.05) place(x, 0);
      for (double x = 8.2; x < 12; x += 0.05) place(x, 0.35);
      for (double z = 0; z < 1.5; z += 0.1) place(12, z);
    }
    for (float x = -1; x < 12 - static_cast<float>(robot); x += 0.02f)
      for (float z = 0; z < 1.5f; z += 0.1f) {
        points.emplace_back(x, 1.6f, z);
        points.emplace_back(x, -1.6f, z);
      }
    for (float y = -1.6f; y < 1.6f; y += 0.02f)
      for (float z = 0; z < 1.5f; z += 0.1f) points.emplace_back(-1.0f, y, z);
    for (int scan = 0; scan < 5; ++scan) planner.add_scan(points, Pose3::level({robot, 0, 0}, 0), 0.1 * scan);
    EXPECT_EQ(planner.plan({robot, 0, 0}, {10, 0, 0.35}).found(), robot == 0.0);
    const std::vector<Eigen::Vector3d> goals{{robot + 1, 0, 0}, {10, 0, 0.35}};
    const std::vector<float> costs = planner.costs({robot, 0, 0}, goals);
    EXPECT_TRUE(std::isfinite(costs[0]));
    EXPECT_EQ(std::isfinite(costs[1]), robot == 0.0);
  }
}

// A riser that is seen over a corner passes for an obstacle on the ground before it.
TEST(RouteSteps, TheGroundBelowAnObstacleThatWasSeenOnceIsAGuess) {
  Platform legged = wheeled();
  legged.step = 0.22;
  legged.stairs = true;
  const RouteParams params;
  SurfaceMap map(params, ScanProfile::most_wrong(legged));
  TileBuilder builder(legged, params);
  map.begin_scan(0, 0);
  for (int iy = -6; iy < 6; ++iy)
    map.see_obstacle(1.45f, (static_cast<float>(iy) + 0.5f) * 0.1f, 0.0f, 0.75f);
  map.begin_scan(0.2, 0);
  for (int ix = 0; ix < 30; ++ix)
    for (int iy = -6; iy < 6; ++iy)
      map.see_free(ix, iy, static_cast<float>(0.16 * std::clamp(ix / 3, 0, 8)), 0.0f,
                   SurfaceMap::Seen::measured);
  EXPECT_TRUE(RouteLine(map, builder).line({0.2, 0, 0}, {2.8, 0, 1.28}).passable);
}

/// A line of 2 m over an edge that was seen from afar.
LineCost over_edge(double height, SurfaceMap::Seen seen) {
  const RouteParams params;
  SurfaceMap map(params, ScanProfile::most_wrong(wheeled()));
  TileBuilder builder(wheeled(), params);
  map.begin_scan(0, 0);
  for (int ix = 80; ix < 120; ++ix)
    for (int iy = -20; iy < 20; ++iy)
      map.see_free(ix, iy, ix < 100 ? 0.0f : static_cast<float>(height), 0.0f, seen);
  return RouteLine(map, builder).line({9, 0, 0}, {11, 0, height});
}

TEST(RouteSteps, AHighEdgeIsOneAlsoFromAfar) {
  using Seen = SurfaceMap::Seen;
  EXPECT_LT(over_edge(0.02, Seen::measured).cost, 2.2);
  const LineCost doubtful = over_edge(0.30, Seen::measured);
  EXPECT_TRUE(doubtful.passable);
  EXPECT_GT(doubtful.cost, 2.3) << "a way that is certain is worth more";
  EXPECT_FALSE(over_edge(0.45, Seen::measured).passable);
  EXPECT_TRUE(over_edge(0.45, Seen::between).passable) << "an interpolated height proves nothing";
}

// A ring of two ways: straight on over an edge that only one scan showed, from afar, or a long way round. A
// robot that took the edge for a wall turned back in the middle of a corridor.
TEST(RouteSteps, ALongWayRoundIsNoAnswerToADoubt) {
  RoutePlanner planner(wheeled());
  SurfaceMap& map = planner.map();
  map.begin_scan(0, 0);
  const auto floor = [&](int x0, int x1, int y0, int y1) {
    for (int ix = x0; ix < x1; ++ix)
      for (int iy = y0; iy < y1; ++iy) {
        const bool wall = ix == x0 || ix + 1 == x1 || iy == y0 || iy + 1 == y1;
        const bool inside = ix > x0 + 15 && ix < x1 - 15 && iy > y0 + 15 && iy < y1 - 15;
        if (inside) continue;
        const bool edge = ix >= 100 && iy < 16;
        map.see_free(ix, iy, edge ? 0.25f : 0.0f, 0.0f, SurfaceMap::Seen::measured);
        if (wall) map.see_obstacle((ix + 0.5f) * kRouteCellF, (iy + 0.5f) * kRouteCellF, 0, 1, true);
      }
  };
  floor(60, 260, 0, 200);
  const Route route = planner.plan({8, 0.8, 0}, {12, 0.8, 0.25});
  ASSERT_TRUE(route.found());
  EXPECT_LT(route.length, 5.0);
}

// The ground of a level floor rose with each metre by the error that the attitude had when the map began.
TEST(RouteSteps, AWrongAttitudeDoesNotRaiseTheMap) {
  RoutePlanner planner(wheeled());
  BoxWorld corridor{
      .boxes = {{-2, 62, 1.3, 1.5}, {-2, 62, -1.5, -1.3}, {-2.2, -2, -1.5, 1.5}, {62, 62.2, -1.5, 1.5}}};
  std::mt19937 random(3);
  double highest = 0;
  for (int i = 0; i < 150; ++i) {
    const Pose2 at{0.4 * i, 0, 0};
    const auto scan = corridor.scan(at, 0.5, 16, 360, 0.01, random);
    // The filter settles within the first seconds.
    const double pitch = 0.015 * std::exp(-i / 40.0);
    Pose3 body = Pose3::level(at, 0);
    body.orientation = body.orientation * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY());
    planner.add_scan(scan, body, 0.2 * i);
    if (const auto ground = i < 100 ? std::nullopt : planner.ground(at.x + 3, 0, 0))
      highest = std::max(highest, std::abs(*ground));
  }
  EXPECT_LT(highest, 0.045);
}

/// Two lines over ground that rises `rise` every `run` cells, by 1.2 m: up it, and along its upper end. Every
/// third cell was measured, from afar, and what is between was drawn.
struct Rise {
  bool up, above;
};
Rise passes_rise(const Platform& platform, double rise, int run) {
  const RouteParams params;
  SurfaceMap map(params, ScanProfile::most_wrong(platform));
  TileBuilder builder(platform, params);
  map.begin_scan(0, 0);
  double highest = 0;
  for (int ix = 80; ix < 140; ++ix) {
    const double z = std::min(1.2, ix < 100 ? 0.0 : rise * (1 + (ix - 100) / run));
    const auto seen = ix % 3 == 0 ? SurfaceMap::Seen::measured : SurfaceMap::Seen::between;
    for (int iy = -20; iy < 20; ++iy) map.see_free(ix, iy, static_cast<float>(z), 0.0f, seen);
    highest = z;
  }
  const double end = 10.5 + 0.1 * run * 1.2 / rise;
  return {RouteLine(map, builder).line({9, 0, 0}, {13.8, 0, highest}).passable,
          RouteLine(map, builder).line({end, -1, highest}, {end, 1, highest}).passable};
}

TEST(RouteSteps, StairsAreTooSteepForARampAlsoFromAfar) {
  Platform tracked = wheeled();
  tracked.step = 0.15;
  const Rise stairs = passes_rise(tracked, 0.2, 3);
  EXPECT_FALSE(stairs.up);
  EXPECT_TRUE(stairs.above);
  EXPECT_TRUE(passes_rise(tracked, 0.03, 1).up) << "a ramp";
  EXPECT_TRUE(passes_rise(legged(), 0.2, 3).up);
  EXPECT_TRUE(passes_rise(tracked, 0.045, 1).up) << "hardly too steep is not proven from afar";
}

TEST(RouteSteps, AStepThatIsSmearedOverCellsIsOne) {
  struct Ground {
    double rise, height;  // per cell, and in all, m
    bool passable;
  };
  for (const Ground& ground :
       {Ground{0.02, 0.4, true}, Ground{0.07, 0.2, false}, Ground{0.045, 0.18, false}}) {
    RoutePlanner planner(wheeled());
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 100; ++x) {
        const Eigen::Vector3d place = middle(x, y, std::clamp(ground.rise * (x - 50), 0.0, ground.height));
        planner.set_ground(place);
        if (y % 39 == 0 || x % 99 == 0) planner.set_obstacle(place, 1);
      }
    planner.finish();
    EXPECT_EQ(planner.plan({1, 2, 0}, {9, 2, kNan}).found(), ground.passable) << ground.rise;
  }
}

/// Ground that goes from one side of a walled place to the other; whether a robot gets over it.
bool passes(const Platform& platform, double noise, const std::function<double(double)>& height) {
  RoutePlanner planner(platform);
  std::mt19937 random(1);
  std::normal_distribution<double> off(0.0, noise);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 100; ++x) {
      const Eigen::Vector3d place = middle(x, y, height((x + 0.5) * 0.1) + (noise > 0 ? off(random) : 0.0));
      planner.set_ground(place);
      if (y % 31 == 0 || x % 99 == 0) planner.set_obstacle(place, 1);
    }
  planner.finish();
  return planner.plan({1, 1.6, height(1)}, {9, 1.6, kNan}).found();
}

TEST(RouteSteps, PassesSlopesAndStepsUpToTheLimits) {
  Platform tracked = wheeled();
  tracked.step = 0.15;
  tracked.max_slope = 0.5;
  const auto ramp = [](double slope, double kerb = 0) {
    return [=](double x) { return x < 4 ? 0.0 : kerb + slope * std::min(x - 4, 2.0); };
  };
  EXPECT_TRUE(passes(wheeled(), 0.005, ramp(0.95 * 0.35)));
  EXPECT_TRUE(passes(tracked, 0.005, ramp(0.95 * 0.5)));
  EXPECT_TRUE(passes(wheeled(), 0.0, ramp(0.15, 0.08))) << "a ramp behind a kerb";
  EXPECT_TRUE(passes(wheeled(), 0.0, [](double x) {
    return x < 4 ? 0.0 : x < 4.3 ? 0.08 : 0.16;
  })) << "two kerbs";
  EXPECT_FALSE(passes(wheeled(), 0.005, ramp(0.6)));
  EXPECT_FALSE(passes(wheeled(), 0.0, [](double x) { return x < 4 ? 0.0 : 0.12; }));
}

TEST(RouteSteps, TheFootOfAJambIsNoStepThatClosesItsGap) {
  // 0.7 m between the jambs; one's foot, seen at a slant, passed for ground that is higher.
  RoutePlanner planner(wheeled());
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 100; ++x) {
      const bool jamb = x == 50 && (y < 13 || y > 19), foot = x == 50 && y == 19;
      planner.set_ground(middle(x, y, foot ? 0.23 : 0.0));
      if (jamb || y % 31 == 0 || x % 99 == 0) planner.set_obstacle(middle(x, y), 1);
    }
  planner.finish();
  EXPECT_TRUE(planner.plan({1, 1.6, 0}, {9, 1.6, 0}).found());
}

TEST(RouteSteps, TiltedRobotSeesTheWallBehindACrest) {
  // Up a ramp of 0.3 whose crest is 0.3 m ahead; a wall stands 3 m away, on what is level.
  RoutePlanner planner(wheeled());
  Pose3 body;
  body.orientation = Eigen::AngleAxisd(-std::atan(0.3), Eigen::Vector3d::UnitY());
  const Eigen::Matrix3d to_body = body.orientation.toRotationMatrix().transpose();
  std::vector<Eigen::Vector3f> points;
  for (double y = -1.5; y < 1.5; y += 0.02)
    for (const double z : {0.57, 0.8, 1.0})
      points.push_back((to_body * Eigen::Vector3d(3, y, z)).cast<float>());
  for (int scan = 0; scan < 5; ++scan) planner.add_scan(points, body, 0.1 * scan);
  EXPECT_FALSE(planner.line({0, 0, 0}, {3.5, 0, 0.09}).passable);
  EXPECT_TRUE(planner.line({0, 0, 0}, {2.2, 0, 0.09}).passable);
}

TEST(RouteSteps, RobotOnARampSeesNoWallUpOrDownIt) {
  for (const double slope : {-0.3, 0.3}) {
    RoutePlanner planner(wheeled());
    Pose3 body;
    body.orientation = Eigen::AngleAxisd(-std::atan(slope), Eigen::Vector3d::UnitY());
    std::vector<Eigen::Vector3f> points;
    for (const float range : {1.87f, 2.2f, 2.6f, 3.1f, 3.9f, 5.0f, 7.0f})
      for (float turn = 0; turn < 6.28f; turn += 0.005f)
        points.emplace_back(range * std::cos(turn), range * std::sin(turn), 0.0f);
    for (int scan = 0; scan < 5; ++scan) planner.add_scan(points, body, 0.1 * scan);
    const LineCost line = planner.line({0, 0, 0}, {4, 0, 4 * slope});
    EXPECT_TRUE(line.passable) << slope;
    EXPECT_LT(line.unknown, 0.1) << slope;
  }
}

TEST(RouteSteps, ObstacleOnAnotherFloorBlocksThisFloorToo) {
  const RouteParams params;
  for (const bool wall : {false, true}) {
    SurfaceMap map(params, ScanProfile::most_wrong(wheeled()));
    TileBuilder builder(wheeled(), params);
    for (int scan = 0; scan < 8; ++scan) {  // from afar, a wall at the foot of what is higher
      map.begin_scan(20, 0);
      for (int ix = 0; ix < 16; ++ix) {
        map.see_free(ix, 0, 0.9f, 0.0f);
        if (wall) map.see_obstacle((static_cast<float>(ix) + 0.5f) * 0.1f, 0.85f, 0.55f, 1.0f);
      }
    }
    for (int ix = 0; ix < 16; ++ix) map.see_free(ix, 0, 0.3f, 0.0f);
    ASSERT_EQ(map.size(), 2);
    EXPECT_EQ(RouteLine(map, builder).line({0.8, 0.3, 0.3}, {0.8, 1.5, 0.3}).passable, !wall);
  }
}

TEST(RouteSteps, FarReturnsDoNotChangeCellsSeenFromNear) {
  SurfaceMap map(RouteParams{}, 0.5f);
  const auto look = [&](double from, float z) {
    for (int scan = 0; scan < 10; ++scan) {
      map.begin_scan(from, 0);
      map.see_free(10, 0, z, 0.0f);
    }
    return map.tile(map.at_cell(10, 0, 0)).cells[static_cast<std::size_t>(cell_in_tile(10, 0))].z;
  };
  EXPECT_NEAR(look(12, 0.05f), 0.05, 0.01);
  EXPECT_NEAR(look(3, 0.2f), 0.2, 0.01);
  EXPECT_NEAR(look(12, 0.05f), 0.2, 0.02);
  EXPECT_NEAR(look(3, 0.1f), 0.1, 0.01);
  map.begin_scan(3, 0);
  map.see_free(11, 0, 0.0f, 0.0f, SurfaceMap::Seen::between);
  map.begin_scan(13, 0);
  map.see_free(11, 0, 0.3f, 0.0f);
  EXPECT_EQ(map.tile(map.at_cell(11, 0, 0)).cells[static_cast<std::size_t>(cell_in_tile(11, 0))].z, 0.0f);
}

TEST(RouteSteps, AWallFarAwayIsNoGroundThatRises) {
  // Its lowest return is a foot up, the next one too far above that to be in the way of a robot.
  for (const float noise : {0.0f, 0.02f}) {
    RoutePlanner planner(wheeled());
    std::mt19937 random(1);
    std::normal_distribution<float> off(0.0f, 1.0f);
    for (int scan = 0; scan < 5; ++scan) {
      std::vector<Eigen::Vector3f> points;
      for (float y = -1; y < 1; y += 0.02f) {
        for (float x = 0.7f; x < 16.5f; x += 0.2f) points.emplace_back(x + noise * off(random), y, 0.0f);
        for (const float z : {0.3f, 1.15f, 2.0f}) points.emplace_back(17.2f + noise * off(random), y, z);
      }
      planner.add_scan(points, Pose3::level({0, 0, 0}, 0), 0.1 * scan);
    }
    EXPECT_TRUE(planner.line({5, 0, 0}, {15.5, 0, 0}).passable) << noise;
    EXPECT_FALSE(planner.line({5, 0, 0}, {18.5, 0, 0}).passable) << noise;
  }
}

}  // namespace
}  // namespace adit::nav::test
