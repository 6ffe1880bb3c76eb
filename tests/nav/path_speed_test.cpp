// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/path_speed.hpp"

#include <gtest/gtest.h>

#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

/// 3 m straight on, or round a corner to the left.
Plan path(bool corner) {
  Plan plan{};
  plan.pose_count = 61;
  plan.length = 3.0;
  Pose2 at{};
  for (std::uint32_t i = 0; i < plan.pose_count; ++i) {
    plan.poses[i] = at;
    at = at * Pose2{0.05, 0, corner && i > 8 && i < 40 ? 0.05 : 0.0};
  }
  return plan;
}

double speed(const Plan& plan, const std::vector<ObstaclePoint>& obstacles) {
  return path_speed(plan, {}, Footprint(wheeled()), wheeled(), obstacles, {});
}

std::vector<ObstaclePoint> wall(float x0, float x1, float y) {
  std::vector<ObstaclePoint> cells;
  for (float x = x0; x < x1; x += 0.05f) cells.push_back({x, y, 1.0f});
  return cells;
}

TEST(PathSpeed, IsFullWithoutNearObstacles) {
  EXPECT_NEAR(speed(path(false), {}), wheeled().max_speed, 1e-4);
  EXPECT_NEAR(speed(path(false), wall(-1, 4, 2.5f)), wheeled().max_speed, 1e-4);
}

TEST(PathSpeed, TheNearerTheSlower) {
  double before = 0;
  for (const float y : {0.30f, 0.45f, 0.6f, 0.8f}) {
    const double now = speed(path(false), wall(-1, 4, y));
    EXPECT_GT(now, before);
    before = now;
  }
  EXPECT_LT(speed(path(false), wall(-1, 4, 0.30f)), 0.5);
}

TEST(PathSpeed, LaterObstaclesCountByTheRemainingBrakingDistance) {
  const double soon = speed(path(false), wall(0.6f, 1.0f, 0.3f)),
               later = speed(path(false), wall(2, 2.4f, 0.3f));
  EXPECT_GT(later, soon + 0.3);
  EXPECT_LT(later, wheeled().max_speed);
}

TEST(PathSpeed, SlowsWhereThePathEntersHiddenSpace) {
  Platform sluggish = wheeled();
  sluggish.max_acceleration = 0.6;  // it needs 4.8 m from full speed
  PathSpeedParams heedless{};
  heedless.blind = 10;
  const Footprint body(sluggish);
  const auto inner = wall(0.2f, 0.78f, 0.9f), outer = wall(0.2f, 0.78f, -0.9f);
  const double free = path_speed(path(true), {}, body, sluggish, inner, heedless);
  EXPECT_LT(path_speed(path(true), {}, body, sluggish, inner, {}), free - 0.1) << "the corner hides the way";
  EXPECT_EQ(path_speed(path(true), {}, body, sluggish, outer, {}),
            path_speed(path(true), {}, body, sluggish, outer, heedless))
      << "the same wall on the outer side hides nothing of it";
}

TEST(PathSpeed, PassableGroundIsNoObstacle) {
  auto cells = wall(-1, 4, 0.3f);
  for (auto& c : cells) c.cost = 0.9f;
  EXPECT_NEAR(speed(path(false), cells), wheeled().max_speed, 1e-4);
}

}  // namespace
}  // namespace adit::nav::test
