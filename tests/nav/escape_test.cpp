// SPDX-License-Identifier: Apache-2.0
// Out of places where the robot stands closer to obstacles than any planner accepts.
#include "nav/recovery/escape.hpp"

#include <gtest/gtest.h>

#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

using Points = std::vector<Eigen::Vector2d>;

void add_wall(Points& points, Eigen::Vector2d from, Eigen::Vector2d to) {
  const int count = static_cast<int>((to - from).norm() / 0.02);
  for (int i = 0; i <= count; ++i) points.push_back(from + (to - from) * i / count);
}

double deepest(const Platform& platform, const Points& points, const Pose2& pose) {
  const Footprint body(platform);
  double most = -1;
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2f p = (pose.inverse() * point).cast<float>();
    most = std::max(most, static_cast<double>(body.depth(p.x(), p.y())));
  }
  return most;
}

/// Drives each plan to its end. Whether the robot gets to where 10 cm are free, and how much closer than at
/// the start, or than 2 cm, it came to anything.
struct Way {
  bool out{false};
  double closer{0};
  Side side{Side::none};
};
Way drive(const Platform& platform, const Points& points, Pose2 pose) {
  Escape escape(platform);
  Way way;
  const double allowed = std::max(deepest(platform, points, pose), -0.02);
  for (int i = 0; i < 20; ++i) {
    std::vector<ObstaclePoint> seen;
    for (const Eigen::Vector2d& point : points) {
      const Eigen::Vector2f p = (pose.inverse() * point).cast<float>();
      seen.push_back({p.x(), p.y(), 1.0f});
    }
    const auto plan = escape.plan(pose, seen);
    way.side = escape.side_of(seen);
    way.out = way.side == Side::none;
    if (!plan) return way;
    EXPECT_LE(plan->max_speed, 0.1);
    for (const Pose2& at : plan->path())
      way.closer = std::max(way.closer, deepest(platform, points, at) - allowed);
    pose = plan->path().back();
  }
  return way;
}

TEST(Escape, LeavesANicheWithTwoToNineCentimetresOnEachSide) {
  for (const Platform& platform : {wheeled(), tracked(), legged(), car()})
    for (const double room : {0.02, 0.04, 0.06, 0.09}) {
      const double side = platform.width / 2 + room, end = platform.length / 2 + room;
      Points niche;
      add_wall(niche, {-end, -side}, {-end, side});
      for (const double y : {-side, side}) add_wall(niche, {-end, y}, {end - 0.2, y});
      const Way way = drive(platform, niche, {});
      EXPECT_TRUE(way.out) << platform.name << " " << room;
      EXPECT_LT(way.closer, 0.005) << platform.name << " " << room;
    }
}

TEST(Escape, LeavesAWallThatItTouches) {
  for (const Platform& platform : {wheeled(), tracked(), legged(), car()})
    for (const double inside : {0.0, 0.02}) {
      Points wall;
      add_wall(wall, {-2, platform.width / 2 - inside}, {2, platform.width / 2 - inside});
      const Way way = drive(platform, wall, {0, 0, 0.1});
      EXPECT_TRUE(way.out) << platform.name << " " << inside;
    }
}

TEST(Escape, NamesTheBlockedSideWhenNoPathLeadsOut) {
  const Platform platform = tracked();
  Points cell;
  const double side = platform.width / 2 + 0.05, end = platform.length / 2 + 0.04;
  for (const double x : {-end, end}) add_wall(cell, {x, -side}, {x, side});
  add_wall(cell, {-end, -side}, {end, -side});
  add_wall(cell, {-end, side - 0.03}, {end, side - 0.03});
  const Way way = drive(platform, cell, {});
  EXPECT_FALSE(way.out);
  EXPECT_EQ(way.side, Side::left);
}

TEST(Escape, HasNothingToLeaveWithTenCentimetresOfClearance) {
  Points wall;
  add_wall(wall, {-2, 0.36}, {2, 0.36});
  EXPECT_TRUE(drive(wheeled(), wall, {}).out);
}

}  // namespace
}  // namespace adit::nav::test
