// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/team_robot.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace adit::agent {
namespace {

TEST(TeamRobots, NoLengthOfARobotKeepsTheRouterBusy) {
  nav::RoutePlanner planner(Platform{}, {});
  for (const double length :
       {600.0, 1e18, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    set_team(planner, {{"r2", Pose2{1, 0, 0}, 0.0, length, length, 1.0}}, 0.3);
}

TEST(TeamRobots, OnlyTheReturnsOfTheirBodiesAreTakenOut) {
  // The body is 0.2 m above the floor and leans by 10 degrees forward; r2 is 3 m ahead of it, a floor lower
  // r3.
  auto scan = std::make_shared<Scan>();
  scan->body.position.z() = 0.2;
  scan->body.orientation = Eigen::AngleAxisd(0.17, Eigen::Vector3d::UnitY());
  const Eigen::Vector3d in_odom[]{{3, 0, 0.5}, {3, 0, 2.6}, {3, 0, -0.8}, {5, 0, 0.0}, {3, 2, 0.5}};
  for (const Eigen::Vector3d& at : in_odom) {
    scan->points.push_back((scan->body.inverse() * at).cast<float>());
    scan->isolated.push_back(static_cast<std::uint8_t>(scan->isolated.size()));
  }
  scan->parts = {{{0.5, 0, 0.5}, 2}, {{-0.5, 0, 0.5}, 3}};
  const auto rest = without_team(
      scan, {{"r2", Pose2{3, 0, 0}, 0.0, 1.0, 0.6, 0.0}, {"r3", Pose2{5, 0, 0}, -3.0, 1.0, 0.6, 0.0}});
  EXPECT_THAT(rest->isolated, testing::ElementsAre(1, 2, 3, 4)) << "ceiling, hole, floor above r3, beside r2";
  EXPECT_EQ(rest->points.size(), 4U);
  ASSERT_EQ(rest->parts.size(), 2U);
  EXPECT_EQ(rest->parts[0].count, 1U);
  EXPECT_EQ(rest->parts[1].count, 3U);
}

TEST(TeamRobots, ReturnsAtTheCornersOfATurnedBodyAreTakenOut) {
  auto scan = std::make_shared<Scan>();
  scan->body = Pose3::level({2.0, -1.0, 0.7}, 0.0);
  const TeamRobot robot{"r2", Pose2{4, 1, 2.1}, 0.0, 1.4, 0.6, 0.0};
  std::size_t inside = 0;
  for (double x = -1.975; x < 2; x += 0.05)
    for (double y = -1.975; y < 2; y += 0.05) {
      const Eigen::Vector2d at = robot.pose * Eigen::Vector2d(x, y);
      scan->points.push_back((scan->body.inverse() * Eigen::Vector3d(at.x(), at.y(), 0.5)).cast<float>());
      inside += std::fabs(x) < 1.0 && std::fabs(y) < 0.6;
    }
  EXPECT_EQ(scan->points.size() - without_team(scan, {robot})->points.size(), inside);
}

TEST(TeamRobots, AReturnOnTwoOfThemIsTakenOutOnce) {
  auto scan = std::make_shared<Scan>();
  scan->points = {{3, 0, 0.5f}, {1, 0, 0.5f}, {1, 1, 0.5f}};
  scan->isolated = {0, 1, 2};
  scan->parts = {{{0, 0, 0.5}, 3}};
  const TeamRobot r2{"r2", Pose2{3, 0, 0}, 0.0, 1.0, 0.6, 0.0},
      r3{"r3", Pose2{3.1, 0, 0}, 0.0, 1.0, 0.6, 0.0};
  const auto rest = without_team(scan, {r2, r3});
  EXPECT_THAT(rest->isolated, testing::ElementsAre(1, 2));
  EXPECT_EQ(rest->parts[0].count, 2U);
}

TEST(TeamRobots, AScanWithoutTheirReturnsIsNotCopied) {
  auto scan = std::make_shared<Scan>();
  scan->points = {{1, 0, 0.5f}, {5, 0, 0.5f}};
  EXPECT_EQ(without_team(scan, {{"r2", Pose2{3, 0, 0}, 0.0, 1.0, 0.6, 0.0}}), scan);
}

}  // namespace
}  // namespace adit::agent
