// The planner of what cannot turn on the spot, by its parts.
#include <gtest/gtest.h>

#include <random>

#include "nav/air_map.hpp"
#include "nav/lattice/lattice_search.hpp"
#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

TEST(ClearField, DistancesAreExact) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-4.5f, 4.5f);
  std::vector<ObstaclePoint> points;
  for (int i = 0; i < 40; ++i) points.push_back({place(random), place(random), 1.0f});
  points.push_back({0.2f, 0.2f, 0.6f});
  ClearField field;
  field.fill(points);
  for (int n = 0; n < 500; ++n) {
    const float x = place(random), y = place(random);
    float nearest = ClearField::kFar;
    for (const ObstaclePoint& o : points)
      if (o.cost >= 1.0f) nearest = std::min(nearest, std::hypot(o.x - x, o.y - y));
    EXPECT_NEAR(field.clearance(x, y), nearest, 0.075f) << x << " " << y;
  }
  EXPECT_NEAR(field.cost(0.2f, 0.2f), 0.6f, 1e-6f);
  EXPECT_EQ(field.clearance(50, 0), ClearField::kFar);
}

TEST(WayField, LeadsRoundAWallAndNotOutOfADeadEnd) {
  std::vector<ObstaclePoint> wall;
  for (float y = -2; y < 1; y += 0.05f) wall.push_back({1.0f, y, 1.0f});
  ClearField clear;
  WayField way;
  clear.fill(wall);
  way.fill(clear, {3, -1}, 0.3f);
  EXPECT_GT(way.at(0, -1), 4.0f) << "round its end, not through";
  EXPECT_LT(way.at(3, 0), 1.6f);
  for (float x = -4.75f; x < 1; x += 0.05f) {  // sides that reach back beyond what is seen
    wall.push_back({x, -2, 1.0f});
    wall.push_back({x, 1, 1.0f});
  }
  clear.fill(wall);
  way.fill(clear, {9, -1}, 0.3f);
  EXPECT_EQ(way.at(0, 0), WayField::kNoWay);
}

TEST(MotionSet, MotionsBendNoMoreThanTheCarCan) {
  const MotionSet set(car());
  for (const int direction : {1, -1})
    for (int from = 0; from < MotionSet::kLevels; ++from)
      for (int to = 0; to < MotionSet::kLevels; ++to) {
        Pose2 before{};
        for (const Pose2& pose : set.motion(from, to, direction).poses) {
          const Pose2 moved = before.inverse() * pose;
          EXPECT_GT(direction * moved.x, 0);
          EXPECT_LE(std::fabs(moved.yaw), std::hypot(moved.x, moved.y) / car().least_radius());
          before = pose;
        }
      }
  EXPECT_EQ(set.level(0.0), MotionSet::kLevels / 2);
  EXPECT_EQ(set.level(99.0), MotionSet::kLevels - 1);
}

TEST(LatticeSearch, PathsAreContinuousAndKeepClear) {
  std::vector<ObstaclePoint> crate;
  for (float x = 2.6f; x < 2.9f; x += 0.05f)
    for (float y = -0.3f; y < 0.2f; y += 0.05f) crate.push_back({x, y, 1.0f});
  ClearField clear;
  WayField way;
  clear.fill(crate);
  way.fill(clear, {3.9, 0}, 0.36f);
  LatticeSearch search(car());
  LatticePath path;
  LatticeTask task{};
  task.level = MotionSet::kLevels / 2;
  task.direction = 1;
  task.target = {3.9, 0};
  ASSERT_TRUE(search.find(clear, way, task, path));
  EXPECT_TRUE(path.complete);
  double bend_before = 0;
  for (std::size_t i = 1; i < path.count; ++i) {
    const Pose2 moved = path.spots[i - 1].pose.inverse() * path.spots[i].pose;
    EXPECT_NEAR(std::hypot(moved.x, moved.y), search.motions().spacing(), 1e-3);
    EXPECT_GE(path.spots[i].cost, path.spots[i - 1].cost);
    EXPECT_TRUE(search.free(clear, path.spots[i].pose, false, 0.06f)) << i;
    const double bend = moved.yaw / search.motions().spacing();
    if (path.spots[i].direction == path.spots[i - 1].direction) {
      EXPECT_LT(std::fabs(bend - bend_before), 0.35) << "steering takes its way";
    }
    bend_before = bend;
  }
  task.only = -1;
  task.target = {-2, 0};
  way.fill(clear, task.target, 0.36f);
  ASSERT_TRUE(search.find(clear, way, task, path));
  for (std::size_t i = 0; i < path.count; ++i) EXPECT_EQ(path.spots[i].direction, -1) << i;
}

TEST(AirMap, KnowsWhatIsAtItsHeightAndForgetsWhatLeft) {
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
