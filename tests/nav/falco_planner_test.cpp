// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/falco/falco_planner.hpp"

#include <gtest/gtest.h>

#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

/// Obstacles in the odometry frame.
using Cells = std::vector<Eigen::Vector2f>;

/// The same as the planner sees them at `pose`.
std::vector<ObstaclePoint> seen_from(const Pose2& pose, const Cells& cells) {
  std::vector<ObstaclePoint> points;
  for (const auto& c : cells) {
    const Eigen::Vector2f p = (pose.inverse() * c.cast<double>()).cast<float>();
    points.push_back({p.x(), p.y(), 1.0f});
  }
  return points;
}

/// The outline of a box as 5 cm cells.
void add_box(Cells& cells, float x0, float x1, float y0, float y1) {
  for (float x = x0; x <= x1; x += 0.05f)
    for (float y = y0; y <= y1; y += 0.05f) cells.emplace_back(x, y);
}

/// How deep the footprint gets into any cell along a plan's path, m; negative when it stays clear.
double deepest(const Plan& plan, const Platform& platform, const Cells& cells) {
  double most = -10;
  for (const Pose2& pose : plan.path())
    for (const auto& c : cells) {
      const Eigen::Vector2d p = pose.inverse() * c.cast<double>();
      most = std::max(
          most, std::min(platform.length / 2 - std::fabs(p.x()), platform.width / 2 - std::fabs(p.y())));
    }
  return most;
}

/// One library for all cases: building it is what takes time.
class Planner : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { library_ = PlannerLibrary::build(wheeled()); }
  static void TearDownTestSuite() { library_.reset(); }
  FalcoPlanner planner_{wheeled(), library_};

 private:
  static inline std::shared_ptr<const PlannerLibrary> library_;
};

TEST_F(Planner, GoesStraightToAGoalInTheOpen) {
  const Plan plan = planner_.plan(Target::to({2, 1}), {}, {}, 0);
  ASSERT_FALSE(plan.blocked);
  EXPECT_TRUE(plan.ends_at_goal);
  EXPECT_LT((plan.path().back().position() - Eigen::Vector2d(2, 1)).norm(), 0.3);
}

TEST_F(Planner, WorksInTheOdometryFrame) {
  const Pose2 pose{10, -4, 2.0};
  const Eigen::Vector2d goal = pose * Eigen::Vector2d(2.5, 0.0);
  const Plan plan = planner_.plan(Target::to(goal), pose, {}, 0);
  EXPECT_LT((plan.path().front().position() - pose.position()).norm(), 1e-9);
  EXPECT_LT((plan.path().back().position() - goal).norm(), 0.1);
}

TEST_F(Planner, PathsKeepClearOfObstaclesInManyWorlds) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> along(-3.5f, 3.5f);
  std::uniform_real_distribution<double> yaw(-3.1, 3.1);
  int found = 0;
  for (int world = 0; world < 300; ++world) {
    Cells cells;
    for (int i = 0; i < 9; ++i) {
      const float x = along(random), y = along(random);
      if (std::hypot(x, y) > 0.75f) add_box(cells, x, x + 0.2f, y, y + 0.2f);
    }
    planner_.plan(Target{}, {}, {}, 0);
    const Pose2 pose{0, 0, yaw(random)};
    const Plan plan =
        planner_.plan(Target::to({along(random), along(random)}), pose, seen_from(pose, cells), 0);
    if (plan.path().empty()) continue;
    ++found;
    // The body turns to the path's first direction on the spot; from there on it keeps clear.
    ASSERT_LT(deepest(plan, wheeled(), cells), 0.005) << world;
  }
  EXPECT_GT(found, 200);
}

TEST_F(Planner, GoesRoundABox) {
  Cells cells;
  add_box(cells, 1.6f, 1.9f, -0.2f, 0.2f);
  const Plan plan = planner_.plan(Target::to({4, 0}), {}, seen_from({}, cells), 0);
  ASSERT_FALSE(plan.blocked);
  EXPECT_GT(std::fabs(plan.path()[plan.pose_count / 2].y) + std::fabs(plan.path().back().y), 0.3);
}

TEST_F(Planner, AllRoundBlockedSaysSo) {
  Cells cells;
  for (float a = 0; a < 6.28f; a += 0.05f) cells.emplace_back(0.55f * std::cos(a), 0.55f * std::sin(a));
  for (const Target& target : {Target::to({4, 0}), Target::to({-2, 1}), Target::along(0.3, 1.0)}) {
    const Plan plan = planner_.plan(target, {}, seen_from({}, cells), 0);
    EXPECT_TRUE(plan.blocked);
    EXPECT_TRUE(plan.path().empty());
    EXPECT_EQ(plan.max_speed, 0.0);
  }
}

TEST_F(Planner, WithoutCorrespondencesItDrivesThroughWalls) {
  auto emptied = std::make_shared<PlannerLibrary>(*PlannerLibrary::build(wheeled()));
  for (auto& option : emptied->options) option.grid = {};
  FalcoPlanner blind(wheeled(), emptied);
  Cells cells;
  add_box(cells, 1.5f, 1.7f, -3.0f, 3.0f);
  EXPECT_GT(deepest(blind.plan(Target::to({4, 0}), {}, seen_from({}, cells), 0), wheeled(), cells), 0.1);
  EXPECT_LT(deepest(planner_.plan(Target::to({4, 0}), {}, seen_from({}, cells), 0), wheeled(), cells), 0.0);
}

TEST_F(Planner, ArrivesWithinTheTolerance) {
  EXPECT_TRUE(planner_.plan(Target::to({0.2, 0}), {}, {}, 0).arrived);
  EXPECT_FALSE(planner_.plan(Target::to({0.3, 0}), {}, {}, 0).arrived);
}

TEST_F(Planner, NoTargetIsNoPath) {
  const Plan plan = planner_.plan(Target{}, {}, {}, 0);
  EXPECT_TRUE(plan.path().empty());
  EXPECT_FALSE(plan.blocked);
  EXPECT_TRUE(planner_.plan(Target::along(0, 0), {}, {}, 0).path().empty());
}

TEST_F(Planner, AStickBackDrivesBackwards) {
  const Plan plan = planner_.plan(Target::along(M_PI, 0.5), {}, {}, 0);
  EXPECT_TRUE(plan.reverse);
  EXPECT_LT(plan.path().back().x, -1.0);
  EXPECT_LE(plan.max_speed, 0.5);
}

}  // namespace
}  // namespace adit::nav::test
