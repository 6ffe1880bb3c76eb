// SPDX-License-Identifier: Apache-2.0
// Costs from one place to many, against one plan for each.
#include <gtest/gtest.h>

#include "nav/routing/route_planner.hpp"
#include "tests/nav/route_world.hpp"

namespace adit::nav::test {
namespace {

RouteParams known_only() {
  RouteParams params;
  params.through_unknown = false;
  return params;
}

TEST(RouteCosts, AreThoseOfOnePlanForEachGoal) {
  int found = 0, unreachable = 0;
  double sum = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const GridWorld world = GridWorld::random(200, 200, 40 + static_cast<int>(seed % 4) * 25, seed);
    RoutePlanner planner(wheeled(), known_only());
    world.tell(planner);
    std::mt19937 draw(seed);
    const auto place = [&draw] {
      return middle(5 + static_cast<int>(draw() % 190), 5 + static_cast<int>(draw() % 190));
    };
    const Eigen::Vector3d start = place();
    std::vector<Eigen::Vector3d> goals;
    for (int i = 0; i < 20; ++i) goals.push_back(place());
    const std::vector<float> costs = planner.costs(start, goals);
    ASSERT_EQ(costs.size(), goals.size());
    for (std::size_t i = 0; i < goals.size(); ++i) {
      const Route route = planner.plan(start, goals[i]);
      ASSERT_EQ(route.found(), std::isfinite(costs[i])) << "seed " << seed << " goal " << i;
      ++(route.found() ? found : unreachable);
      if (!route.found()) continue;
      EXPECT_LT(route.cost, costs[i] * 1.02 + 0.3) << "seed " << seed << " goal " << i;
      EXPECT_GT(route.cost, costs[i] * 0.75 - 0.5) << "seed " << seed << " goal " << i;
      sum += costs[i] / std::max(route.cost, 1.0);
    }
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(unreachable, 5);
  EXPECT_LT(sum / found, 1.12);
}

TEST(RouteCosts, EndWithoutASearchOfTheCompleteMap) {
  GridWorld world(400, 100);
  world.border();
  RoutePlanner planner(wheeled(), known_only());
  world.tell(planner);
  const std::vector<Eigen::Vector3d> near{{3.0, 5.0, 0}, {4.0, 4.0, 0}};
  planner.costs({1.5, 5.0, 0}, near);
  const std::size_t few = planner.expanded();
  const std::vector<Eigen::Vector3d> far{{3.0, 5.0, 0}, {38.0, 5.0, 0}};
  planner.costs({1.5, 5.0, 0}, far);
  EXPECT_LT(few, planner.expanded() / 3);
}

TEST(RouteCosts, AGoalOnTheTileOfTheStartCostsItsDistance) {
  GridWorld world(100, 100);
  world.border();
  RoutePlanner planner(wheeled(), known_only());
  world.tell(planner);
  const std::vector<Eigen::Vector3d> goals{{5.15, 5.15, 0}, {5.15, 5.75, 0}};
  const std::vector<float> costs = planner.costs({5.15, 5.15, 0}, goals);
  EXPECT_NEAR(costs[0], 0.0, 0.05);
  EXPECT_NEAR(costs[1], 0.6, 0.05);
}

TEST(RouteCosts, UnknownSpaceLeadsNowhere) {
  GridWorld world(100, 100);
  RoutePlanner planner(wheeled());
  world.tell(planner);
  const std::vector<Eigen::Vector3d> goals{{5.0, 5.0, 0}, {50.0, 5.0, 0}};
  const std::vector<float> costs = planner.costs({2.0, 5.0, 0}, goals);
  EXPECT_TRUE(std::isfinite(costs[0]));
  EXPECT_TRUE(std::isinf(costs[1]));
  EXPECT_TRUE(planner.plan({2.0, 5.0, 0}, goals[1]).found()) << "a plan may try it";
  EXPECT_TRUE(std::isinf(planner.costs({50.0, 5.0, 0}, goals)[0])) << "from unknown space, too";
  EXPECT_TRUE(planner.costs({2.0, 5.0, 0}, {}).empty());
}

}  // namespace
}  // namespace adit::nav::test
