// SPDX-License-Identifier: Apache-2.0
// The planner of what cannot turn on the spot, by its parts.
#include <gtest/gtest.h>

#include <random>

#include "nav/passages/widest_strip.hpp"
#include "nav/planners/hybrid_astar/hybrid_astar_planner.hpp"
#include "nav/planners/hybrid_astar/hybrid_astar_search.hpp"
#include "nav/terrain/air_map.hpp"
#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

TEST(DistanceField, DistancesAreExact) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-4.5f, 4.5f);
  std::vector<ObstaclePoint> points;
  for (int i = 0; i < 40; ++i) points.push_back({place(random), place(random), 1.0f});
  points.push_back({0.2f, 0.2f, 0.6f});
  DistanceField field;
  field.fill(points);
  for (int n = 0; n < 500; ++n) {
    const float x = place(random), y = place(random);
    float nearest = DistanceField::kFar;
    for (const ObstaclePoint& o : points)
      if (o.cost >= 1.0f) nearest = std::min(nearest, std::hypot(o.x - x, o.y - y));
    EXPECT_NEAR(field.clearance(x, y), nearest, 0.075f) << x << " " << y;
  }
  EXPECT_NEAR(field.cost(0.2f, 0.2f), 0.6f, 1e-6f);
  EXPECT_EQ(field.clearance(50, 0), DistanceField::kFar);
}

TEST(CostToGo, LeadsRoundAWallAndNotOutOfADeadEnd) {
  std::vector<ObstaclePoint> wall;
  for (float y = -2; y < 1; y += 0.05f) wall.push_back({1.0f, y, 1.0f});
  DistanceField field;
  CostToGo cost_to_go;
  field.fill(wall);
  cost_to_go.fill(field, {3, -1}, 0.3f);
  EXPECT_GT(cost_to_go.at(0, -1), 4.0f) << "round its end, not through";
  EXPECT_LT(cost_to_go.at(3, 0), 1.6f);
  for (float x = -4.75f; x < 1; x += 0.05f) {  // sides that reach back beyond what is seen
    wall.push_back({x, -2, 1.0f});
    wall.push_back({x, 1, 1.0f});
  }
  field.fill(wall);
  cost_to_go.fill(field, {9, -1}, 0.3f);
  EXPECT_EQ(cost_to_go.at(0, 0), CostToGo::kUnreachable);
}

TEST(MotionPrimitives, MotionsBendNoMoreThanTheCarCan) {
  const MotionPrimitives set(car());
  for (const int direction : {1, -1})
    for (int from = 0; from < MotionPrimitives::kLevels; ++from)
      for (int to = 0; to < MotionPrimitives::kLevels; ++to) {
        Pose2 before{};
        for (const Pose2& pose : set.motion(from, to, direction).poses) {
          const Pose2 moved = before.inverse() * pose;
          EXPECT_GT(direction * moved.x, 0);
          EXPECT_LE(std::fabs(moved.yaw), std::hypot(moved.x, moved.y) / car().least_radius());
          before = pose;
        }
      }
  EXPECT_EQ(set.level(0.0), MotionPrimitives::kLevels / 2);
  EXPECT_EQ(set.level(99.0), MotionPrimitives::kLevels - 1);
}

TEST(HybridAStarSearch, PathsAreContinuousAndKeepClear) {
  std::vector<ObstaclePoint> crate;
  for (float x = 2.6f; x < 2.9f; x += 0.05f)
    for (float y = -0.3f; y < 0.2f; y += 0.05f) crate.push_back({x, y, 1.0f});
  DistanceField field;
  CostToGo cost_to_go;
  field.fill(crate);
  cost_to_go.fill(field, {3.9, 0}, 0.36f);
  HybridAStarSearch search(car());
  HybridAStarPath path;
  HybridAStarTask task{};
  task.level = MotionPrimitives::kLevels / 2;
  task.direction = 1;
  task.target = {3.9, 0};
  ASSERT_TRUE(search.find(field, cost_to_go, task, path));
  EXPECT_TRUE(path.complete);
  double bend_before = 0;
  for (std::size_t i = 1; i < path.count; ++i) {
    const Pose2 moved = path.spots[i - 1].pose.inverse() * path.spots[i].pose;
    EXPECT_NEAR(std::hypot(moved.x, moved.y), MotionPrimitives::kSpacing, 1e-3);
    EXPECT_GE(path.spots[i].cost, path.spots[i - 1].cost);
    EXPECT_TRUE(search.free(field, path.spots[i].pose, false, 0.06f)) << i;
    const double bend = moved.yaw / MotionPrimitives::kSpacing;
    if (path.spots[i].direction == path.spots[i - 1].direction) {
      EXPECT_LT(std::fabs(bend - bend_before), 0.35) << "steering takes its way";
    }
    bend_before = bend;
  }
  task.only = -1;
  task.target = {-2, 0};
  cost_to_go.fill(field, task.target, 0.36f);
  ASSERT_TRUE(search.find(field, cost_to_go, task, path));
  for (std::size_t i = 0; i < path.count; ++i) EXPECT_EQ(path.spots[i].direction, -1) << i;
}

/// A wall along y, 0.2 m thick, with a gap around y = 0.
std::vector<ObstaclePoint> wall_with_gap(float x, float gap, float turned = 0) {
  std::vector<ObstaclePoint> wall;
  const float c = std::cos(turned), s = std::sin(turned);
  for (float along = 0; along <= 0.2f; along += 0.05f)
    for (float aside = 0; aside < 2; aside += 0.05f)
      for (const float side : {-1.0f, 1.0f}) {
        const float y = side * (gap / 2 + aside);
        wall.push_back({x + c * along - s * y, s * along + c * y, 1.0f});
      }
  return wall;
}

TEST(SolidPoints, DepthIsThatOfTheDeepestPoint) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-3, 3);
  std::vector<ObstaclePoint> points;
  for (int i = 0; i < 300; ++i) points.push_back({place(random), place(random), i % 3 == 0 ? 0.5f : 1.0f});
  SolidPoints solid;
  solid.fill(points, 0.3f);
  const Footprint body(0.5, 0.3);
  for (int n = 0; n < 200; ++n) {
    const Pose2 pose{place(random), place(random), place(random)};
    float deepest = -0.2f;
    for (const ObstaclePoint& o : points) {
      const Eigen::Vector2d p = pose.inverse() * Eigen::Vector2d(o.x + 0.3f, o.y);
      if (o.cost >= 1)
        deepest = std::max(deepest, body.depth(static_cast<float>(p.x()), static_cast<float>(p.y())));
    }
    EXPECT_NEAR(solid.depth(body, pose), deepest, 1e-4f);
  }
}

TEST(WidestStrip, FindsTheMiddleAndTheWayThrough) {
  for (const float turned : {-0.2f, 0.0f, 0.2f}) {
    const auto wall = wall_with_gap(2.0f, 0.7f, turned);
    const auto strip = fit_widest_strip({2.1, 0.08, 0.05}, wall);
    ASSERT_TRUE(strip);
    EXPECT_NEAR(strip->room, 0.7, 0.01);
    EXPECT_NEAR(strip->line.yaw, turned, 0.03);
    const Eigen::Vector2d middle = strip->line.inverse() * Eigen::Vector2d(2.0, 0.0);
    EXPECT_NEAR(middle.y(), 0.0, 0.01);
  }
  std::vector<ObstaclePoint> one_side = wall_with_gap(2.0f, 0.7f);
  std::erase_if(one_side, [](const ObstaclePoint& o) { return o.y > 0; });
  EXPECT_FALSE(fit_widest_strip({2.1, 0, 0}, one_side));
}

std::vector<ObstaclePoint> seen_from(const Pose2& place, std::vector<ObstaclePoint> points) {
  const Pose2 back = place.inverse();
  for (ObstaclePoint& o : points) {
    const Eigen::Vector2d p = back * Eigen::Vector2d(o.x, o.y);
    o = {static_cast<float>(p.x()), static_cast<float>(p.y()), 1.0f};
  }
  return points;
}

TEST(HybridAStarSearch, PassesAGapTenCentimetresWiderFromEveryStart) {
  const Platform platform = car();
  const auto wall = wall_with_gap(2.5f, static_cast<float>(platform.width) + 0.1f);
  const Footprint body(platform);
  HybridAStarSearch search(platform);
  DistanceField field;
  CostToGo cost_to_go;
  HybridAStarPath path;
  int found = 0;
  for (const double y : {-1.0, -0.3, 0.0, 0.6})
    for (const double yaw : {-0.6, 0.0, 0.8}) {
      const Pose2 rear = Pose2{0, y, yaw} * Pose2{-platform.rear_axle(), 0, 0};
      field.fill(seen_from(rear, wall));
      HybridAStarTask task{};
      task.passage = rear.inverse() * Pose2{2.6, 0, 0};
      cost_to_go.fill(field, (*task.passage * Pose2{-1.7, 0, 0}).position(), 0.36f);
      if (!search.find(field, cost_to_go, task, path)) continue;
      ++found;
      EXPECT_TRUE(path.through);
      const Pose2 end = rear * path.spots[path.count - 1].pose * Pose2{platform.rear_axle(), 0, 0};
      EXPECT_NEAR(end.x, 3.5, 0.06) << "behind the gap";
      EXPECT_NEAR(end.y, 0.0, 0.01);
      for (std::size_t i = 0; i < path.count; ++i)
        EXPECT_LT(field.points().depth(body, path.spots[i].pose * Pose2{platform.rear_axle(), 0, 0}), 0)
            << y << " " << yaw << " " << i;
    }
  EXPECT_EQ(found, 12);
}

TEST(HybridAStarSearch, BacksUpWhereABendWouldEndInTheJamb) {
  const Platform platform = car();
  const auto wall = wall_with_gap(0.8f, static_cast<float>(platform.width) + 0.1f);
  HybridAStarSearch search(platform);
  DistanceField field;
  CostToGo cost_to_go;
  for (const auto& [aside, back] : {std::pair{-0.1, true}, std::pair{0.0, false}}) {
    const Pose2 rear = Pose2{0, aside, 0.05} * Pose2{-platform.rear_axle(), 0, 0};
    field.fill(seen_from(rear, wall));
    HybridAStarTask task{};
    task.passage = rear.inverse() * Pose2{0.9, 0, 0};
    cost_to_go.fill(field, (*task.passage * Pose2{-1.7, 0, 0}).position(), 0.36f);
    HybridAStarPath path;
    ASSERT_TRUE(search.find(field, cost_to_go, task, path)) << aside;
    EXPECT_TRUE(path.through);
    EXPECT_EQ(path.straight_on(), !back) << aside;
  }
}

/// A car 3 m before a gap 10 cm wider than itself that was seen `aside` of its first place from the second
/// look on.
Plan plan_twice(HybridAStarPlanner& planner, float aside) {
  const Platform platform = car();
  auto wall = wall_with_gap(3.0f, static_cast<float>(platform.width) + 0.1f);
  Target target = Target::to({4.0, 0.0});
  target.passage = Pose2{3.0, 0, 0};
  planner.plan(target, {}, wall, 0.0);
  for (ObstaclePoint& o : wall) o.y += aside;
  return planner.plan(target, {}, wall, 0.1);
}

TEST(HybridAStarPlanner, AimsAnewAtTheMiddleOfAGapThatItSeesBetterFromNearer) {
  for (const float aside : {-0.03f, 0.03f}) {
    HybridAStarPlanner planner(car());
    const Plan plan = plan_twice(planner, aside);
    ASSERT_GT(plan.pose_count, 2u);
    EXPECT_NEAR(plan.path().back().y, aside, 0.01);
  }
  HybridAStarPlanner planner(car());
  EXPECT_NEAR(plan_twice(planner, 0.008f).path().back().y, 0.0, 0.004) << "not for a little";
}

TEST(HybridAStarPlanner, KeepsToItsWayWhenAGapIsOnlyMeasuredAtAnotherAngle) {
  const Platform platform = car();
  HybridAStarPlanner planner(platform);
  const auto gap = static_cast<float>(platform.width) + 0.1f;
  Target target = Target::to({4.0, 0.0});
  target.passage = Pose2{3.0, 0, 0};
  const Pose2 end = planner.plan(target, {}, wall_with_gap(3.0f, gap), 0.0).path().back();
  auto turned = wall_with_gap(0.0f, gap, 0.0175f);  // by a degree about its middle
  for (ObstaclePoint& o : turned) o.x += 3.0f;
  const Pose2 again = planner.plan(target, {}, turned, 0.1).path().back();
  EXPECT_EQ(end.y, again.y);
  EXPECT_EQ(end.yaw, again.yaw);
}

TEST(HybridAStarPlanner, BacksOutOfASmallRoomThroughADoorThatIsWideEnough) {
  const Platform platform = car();
  HybridAStarPlanner planner(platform);
  std::vector<ObstaclePoint> room;  // 1.5 x 1 m, its door behind the car, 30 cm wider than it
  for (float x = -1.0f; x <= 0.8f; x += 0.03f) {
    room.push_back({x, -0.5f, 1.0f});
    room.push_back({x, 0.5f, 1.0f});
  }
  for (float y = -0.5f; y <= 0.5f; y += 0.03f) {
    room.push_back({0.8f, y, 1.0f});
    if (std::fabs(y) > 0.45f) room.push_back({-1.0f, y, 1.0f});
  }
  Target target = Target::to({-2.0, 0.0});
  target.passage = Pose2{-1.0, 0, M_PI};
  const Plan plan = planner.plan(target, {}, room, 0.0);
  ASSERT_FALSE(plan.blocked);
  EXPECT_TRUE(plan.reverse);
}

/// The corner of two corridors 1.5 m wide, in which the robot heads for the wall.
std::vector<ObstaclePoint> corner() {
  std::vector<ObstaclePoint> walls;
  for (float way = -0.75f; way <= 4.0f; way += 0.03f) {
    walls.push_back({0.75f, way, 1.0f});
    walls.push_back({-way, -0.75f, 1.0f});
    if (way < 0.75f) continue;
    walls.push_back({-0.75f, way, 1.0f});
    walls.push_back({-way, 0.75f, 1.0f});
  }
  return walls;
}

TEST(HybridAStarSearch, TurnsOnTheSpotWhereThatIsFree) {
  for (const Platform& platform : {wheeled(), tracked(), car()}) {
    DistanceField field;
    CostToGo cost_to_go;
    field.fill(corner());
    HybridAStarSearch search(platform);
    HybridAStarTask task{};
    task.target = {0, 3.0};
    task.turns = true;
    cost_to_go.fill(field, task.target, static_cast<float>(platform.width / 2 + 0.06));
    HybridAStarPath path;
    ASSERT_TRUE(search.find(field, cost_to_go, task, path));
    std::size_t turned = 0;
    for (std::size_t i = 1; i < path.count; ++i) {
      const Pose2 moved = path.spots[i - 1].pose.inverse() * path.spots[i].pose;
      if (path.spots[i].direction != 0) continue;
      ++turned;
      EXPECT_NEAR(std::hypot(moved.x, moved.y), 0, 1e-9);
      EXPECT_NEAR(std::fabs(moved.yaw), MotionPrimitives::kTurn / MotionPrimitives::kPoses, 1e-6);
      EXPECT_TRUE(search.free(field, path.spots[i].pose, false, 0.01f)) << i;
    }
    EXPECT_EQ(turned > 0, platform.turns_on_spot());
    if (turned > 0) {
      EXPECT_LT(path.cost(), 6.0) << "a quarter of a turn costs 0.6 m, the way 3 m";
    }
  }
}

TEST(HybridAStarSearch, NoPathIsATurnAlone) {
  DistanceField field;
  CostToGo cost_to_go;
  field.fill(corner());
  HybridAStarSearch search(wheeled());
  for (const Eigen::Vector2d& target : {Eigen::Vector2d(0.05, 0.0), Eigen::Vector2d(0.0, 0.3)}) {
    HybridAStarTask task{};
    task.target = target;
    task.turns = true;
    cost_to_go.fill(field, task.target, 0.31f);
    HybridAStarPath path;
    if (search.find(field, cost_to_go, task, path)) {
      EXPECT_NE(path.spots[path.count - 1].direction, 0);
    }
  }
}

TEST(HybridAStarPlanner, FollowsATurnOnTheSpotToItsEndAndDrivesOn) {
  HybridAStarPlanner planner(wheeled());
  const auto walls = corner();
  Target target = Target::to({0.0, 3.0});
  target.passage = Pose2{0.0, 2.0, M_PI / 2};
  int cycle = 0;
  for (double turned = 0; turned < 1.4; turned += 0.1) {
    const Pose2 at{0, 0, turned};
    const Plan plan = planner.plan(target, at, seen_from(at, walls), 0.1 * cycle++);
    ASSERT_TRUE(plan.turn_first) << turned;
    EXPECT_EQ(plan.turn, 1);
    EXPECT_FALSE(plan.reverse);
    EXPECT_GT(plan.path().back().y, 1.0);
    EXPECT_NEAR(plan.path().front().yaw, M_PI / 2, 0.05);
  }
  const Pose2 at{0, 0, 1.45};
  const Plan plan = planner.plan(target, at, seen_from(at, walls), 0.1 * cycle);
  EXPECT_FALSE(plan.turn_first || plan.blocked);
}

TEST(HybridAStarPlanner, BrakesInTimeForATightPlace) {
  const Platform platform = car();
  const auto gap = static_cast<float>(platform.width) + 0.1f;
  const auto fastest = [&](double speed) {
    HybridAStarPlanner planner(platform);
    Plan plan;
    for (int i = 0; i < 3; ++i) {
      const Pose2 at{0.1 * speed * i, 0, 0};
      auto wall = wall_with_gap(static_cast<float>(3.1 - at.x), gap);
      Target target = Target::to({4.0, 0.0});
      target.passage = Pose2{3.1, 0, 0};
      plan = planner.plan(target, at, wall, 0.1 * i);
    }
    return plan.max_speed;
  };
  EXPECT_GT(fastest(0.4), 0.6);
  EXPECT_LE(fastest(2.0), 0.3);
}

TEST(HybridAStarPlanner, CreepsOnlyWhereItIsTight) {
  const Platform platform = car();
  HybridAStarPlanner planner(platform);
  EXPECT_GT(plan_twice(planner, 0.0f).max_speed, 0.6);
  const auto near = wall_with_gap(1.0f, static_cast<float>(platform.width) + 0.1f);
  Target target = Target::to({2.0, 0.0});
  target.passage = Pose2{1.0, 0, 0};
  HybridAStarPlanner close(platform);
  const Plan plan = close.plan(target, {}, near, 0.0);
  ASSERT_GT(plan.pose_count, 2u);
  EXPECT_LE(plan.max_speed, 0.3);
}

TEST(AirMap, MapsObstaclesAtItsHeightAndForgetsThoseThatLeft) {
  const Platform p = aerial();
  AirMap map(p);
  // A flat floor a metre below, a table beneath, a wall ahead, a lamp above.
  const BoxWorld world{{{3, 3.2, -1, 1}, {1, 1.5, -0.5, 0.5, 0.0, 0.7}, {-2, -1.8, -1, 1, 1.7, 2.5}}};
  BoxWorld gone = world;
  gone.boxes.erase(gone.boxes.begin());
  std::mt19937 random(1);
  const auto look = [&](const BoxWorld& seen, double time) {
    auto points = seen.scan({}, 1.0 + p.lidar_height, 16, 360, 0.01, random);
    for (auto& point : points) point.z() -= 1.0f;  // base_link is a metre up
    map.add_scan(points, Pose3::level({}, 1.0), time);
  };
  look(world, 0.0);
  look(world, 0.1);
  ASSERT_FALSE(map.cells().empty());
  for (const Eigen::Vector2f& cell : map.cells()) EXPECT_NEAR(cell.x(), 3.0f, 0.15f) << cell.transpose();
  for (int i = 2; i < 12; ++i) look(gone, 0.1 * i);
  EXPECT_TRUE(map.cells().empty());
}

}  // namespace
}  // namespace adit::nav::test
