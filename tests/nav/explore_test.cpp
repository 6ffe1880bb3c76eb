// SPDX-License-Identifier: Apache-2.0
// Exploration of worlds of boxes by a robot that drives along its routes without inertia.
#include <gtest/gtest.h>

#include "nav/explore/explorer.hpp"
#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

Platform explorer_platform() {
  Platform p;
  p.name = "wheeled";
  p.drive = Drive::differential;
  p.length = 0.7;
  p.width = 0.5;
  p.height = 0.6;
  p.step = 0.08;
  p.lidar_height = 0.75;
  return p;
}

/// A square of `n` blocks on each side: 8 m wide, between streets of 3.2 m, closed all around.
BoxWorld blocks(int n) {
  BoxWorld world;
  world.ceiling = 3.0;
  const double side = 3.2 + n * 11.2;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      world.boxes.push_back({3.2 + 11.2 * x, 11.2 + 11.2 * x, 3.2 + 11.2 * y, 11.2 + 11.2 * y, 0, 3});
  world.boxes.push_back({-0.3, 0, 0, side, 0, 3});
  world.boxes.push_back({side, side + 0.3, 0, side, 0, 3});
  world.boxes.push_back({0, side, -0.3, 0, 0, 3});
  world.boxes.push_back({0, side, side, side + 0.3, 0, 3});
  return world;
}

/// Drives where the explorer says at `speed`, with a scan and a step every 0.2 s.
struct ExploreRun {
  BoxWorld world;
  Platform platform{explorer_platform()};
  RoutePlanner planner{platform};
  Explorer explorer{platform};
  RouteGround ground{planner, platform};
  Pose2 pose{};
  double speed{2.0}, stamp{0}, metres{0};
  ExploreStep last{};
  int steps{0}, braking{0};  ///< Those with a goal; of these, so near to it that a robot would brake.
  std::mt19937 random{1};

  ExploreRun(BoxWorld w, const Pose2& start) : world(std::move(w)), pose(start) {}

  void look() {
    const auto points = world.scan(pose, platform.lidar_height, 16, 450, 0.0, random);
    planner.add_scan(points, Pose3::level(pose, 0), stamp);
    explorer.add_scan(points, Pose3::level(pose, 0));
  }
  void drive(double metres_left) {
    if (!last.goal) return;
    const Route route = planner.plan({pose.x, pose.y, 0}, *last.goal);
    for (std::size_t i = 1; i < route.points.size() && metres_left > 0; ++i) {
      const Eigen::Vector2d way = route.points[i].head<2>() - Eigen::Vector2d(pose.x, pose.y);
      const double length = way.norm(), part = std::min(length, metres_left);
      if (length > 0) {
        pose = {pose.x + way.x() * part / length, pose.y + way.y() * part / length,
                std::atan2(way.y(), way.x())};
      }
      metres += part;
      metres_left -= part;
    }
  }
  /// Whether it ends in `done` within so many seconds.
  bool run(double most) {
    for (int tick = 0; stamp < most; ++tick, stamp = 0.2 * tick) {
      look();
      last = explorer.step(ground, {pose.x, pose.y, 0}, stamp, false);
      if (last.state == ExploreState::done) return true;
      if (last.goal) {
        ++steps;
        braking += (last.goal->head<2>() - Eigen::Vector2d(pose.x, pose.y)).norm() < 2.0;
      }
      drive(speed * 0.2);
    }
    return false;
  }
};

/// Share of the voxels between floor and ceiling in the streets, a voxel away from the walls, that were seen.
double share_of_streets(const CoverageMap& map, int n) {
  int all = 0, seen = 0;
  const int side = static_cast<int>((3.2 + 11.2 * n) / CoverageMap::kVoxel);
  for (int y = 1; y + 1 < side; ++y)
    for (int x = 1; x + 1 < side; ++x) {
      const Eigen::Vector3d at = CoverageMap::centre({x, y, 0});
      const auto in_block = [](double v) {
        const double in = std::fmod(v, 11.2);
        return in > 2.7 && in < 11.2 + 0.5;
      };
      if (in_block(at.x()) && in_block(at.y())) continue;
      for (int z = 0; z < 6; ++z) {
        ++all;
        seen += map.seen({x, y, z});
      }
    }
  return static_cast<double>(seen) / all;
}

TEST(Explorer, SeesTheBlocksAndSaysDone) {
  ExploreRun run(blocks(3), {1.6, 1.6, 0});
  EXPECT_TRUE(run.run(120));
  EXPECT_GT(share_of_streets(run.explorer.coverage(), 3), 0.97);
  EXPECT_LT(run.metres, 190);
  EXPECT_EQ(run.last.frontiers, 0u);
  EXPECT_LT(run.explorer.coverage().memory(), 1'000'000u);
  run.explorer.begin();
  run.stamp += 1;
  EXPECT_FALSE(run.explorer.step(run.ground, {run.pose.x, run.pose.y, 0}, run.stamp, false).goal)
      << "what was seen stays seen";
}

TEST(Explorer, HandsOverTheNextGoalBeforeTheRobotBrakes) {
  ExploreRun run(blocks(2), {1.6, 1.6, 0});
  EXPECT_TRUE(run.run(120));
  EXPECT_GT(share_of_streets(run.explorer.coverage(), 2), 0.97);
  EXPECT_LT(run.braking, run.steps / 4);
}

/// A corridor of 20 x 3.2 m with a bay of 2 x 4 m, and beside the end of the bay a pocket of 2.3 x 1.2 m that
/// the corridor hardly shows.
BoxWorld corridor_with_pocket() {
  BoxWorld world;
  world.ceiling = 3.0;
  world.boxes = {{-0.3, 0, 0, 3.2, 0, 3},    {20, 20.3, 0, 3.2, 0, 3},   {0, 20, -0.3, 0, 0, 3},
                 {0, 10, 3.2, 3.5, 0, 3},    {12, 20, 3.2, 3.5, 0, 3},   {9.7, 10, 3.5, 7.2, 0, 3},
                 {12, 12.3, 3.5, 6, 0, 3},   {12.3, 14.3, 5.7, 6, 0, 3}, {14.3, 14.6, 5.7, 7.5, 0, 3},
                 {9.7, 14.3, 7.2, 7.5, 0, 3}};
  return world;
}

TEST(Explorer, LooksIntoAPocketThatIsSmallerThanARoom) {
  ExploreRun run(corridor_with_pocket(), {1.6, 1.6, 0});
  EXPECT_TRUE(run.run(120));
  int all = 0, seen = 0;
  for (double x = 13.25; x < 14.2; x += CoverageMap::kVoxel)
    for (double y = 6.25; y < 7; y += CoverageMap::kVoxel)
      for (double z = 0.25; z < 1.5; z += CoverageMap::kVoxel) {
        ++all;
        seen += run.explorer.coverage().seen(CoverageMap::voxel_at({x, y, z}));
      }
  EXPECT_GT(seen, 0.9 * all) << all;
}

// A closed room of 3 x 3 m, which one scan shows.
TEST(Explorer, WithoutAnythingToSeeItIsNeverDone) {
  BoxWorld room;
  room.ceiling = 3.0;
  room.boxes = {{-1.8, -1.5, -1.5, 1.5, 0, 3},
                {1.5, 1.8, -1.5, 1.5, 0, 3},
                {-1.5, 1.5, -1.8, -1.5, 0, 3},
                {-1.5, 1.5, 1.5, 1.8, 0, 3}};
  ExploreRun run(std::move(room), {});
  EXPECT_FALSE(run.run(10));
  EXPECT_EQ(run.last.state, ExploreState::no_viewpoint);
}

}  // namespace
}  // namespace adit::nav::test
