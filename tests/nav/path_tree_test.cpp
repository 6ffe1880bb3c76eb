// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/falco/path_tree.hpp"

#include <gtest/gtest.h>

#include <set>

namespace adit::nav {
namespace {

TEST(PathTree, HasAtLeast300PathsInSevenGroupsAllDifferent) {
  const PathTree tree;
  static_assert(PathTree::kPaths >= 300 && PathTree::kGroups == 7);
  std::set<std::pair<double, double>> ends;
  for (int i = 0; i < PathTree::kPaths; ++i) {
    const Pose2& end = tree.path(i).back();
    ends.insert({std::round(end.x * 1e4), std::round(end.y * 1e4)});
  }
  EXPECT_EQ(ends.size(), static_cast<std::size_t>(PathTree::kPaths));
}

TEST(PathTree, PathsStartAheadAndAreSpacedEvenly) {
  const PathTree tree;
  for (int i = 0; i < PathTree::kPaths; ++i) {
    const auto path = tree.path(i);
    EXPECT_EQ(path.front(), Pose2{});
    for (std::size_t k = 1; k < path.size(); ++k) {
      const double step = (path[k].position() - path[k - 1].position()).norm();
      ASSERT_NEAR(step, tree.params().spacing, 1e-9);
      ASSERT_GE(step * std::cos(path[k - 1].yaw), -step);
    }
  }
  EXPECT_NEAR(tree.path(171).back().x, 3.0, 1e-9);  // the middle one goes straight
  EXPECT_NEAR(tree.path(171).back().y, 0.0, 1e-9);
}

TEST(PathTree, CurvatureIsBounded) {
  const PathTree tree;
  for (int i = 0; i < PathTree::kPaths; ++i) {
    const auto path = tree.path(i);
    for (std::size_t k = 1; k < path.size(); ++k)
      ASSERT_LE(std::fabs(wrap_angle(path[k].yaw - path[k - 1].yaw)),
                tree.params().curvature[0] * tree.params().spacing + 1e-9);
  }
}

TEST(PathTree, IsSymmetric) {
  const PathTree tree;
  for (int i = 0; i < PathTree::kPaths; ++i) {
    const Pose2& left = tree.path(i).back();
    const Pose2& right = tree.path(PathTree::kPaths - 1 - i).back();
    EXPECT_NEAR(left.x, right.x, 1e-9);
    EXPECT_NEAR(left.y, -right.y, 1e-9);
  }
}

TEST(PathTree, PathsOfAGroupShareItsFirstSegment) {
  const PathTree tree;
  const std::size_t end = tree.last_pose(3);
  for (int i = 0; i < PathTree::kPaths; ++i) {
    const int first = PathTree::path_through(0, i / 49);
    EXPECT_EQ(tree.path(i)[end], tree.path(first)[end]);
  }
}

TEST(PathTree, StagesFollowEachOtherAndFitTheMask) {
  const PathTree tree;
  int bit = 0;
  for (int stage = 0; stage < PathTree::kStages; ++stage) {
    EXPECT_EQ(PathTree::kFirstBit[stage], bit);
    bit += PathTree::kNodes[stage];
    if (stage > 0) {
      EXPECT_GT(tree.stage_end(stage), tree.stage_end(stage - 1));
    }
    EXPECT_NEAR(tree.last_pose(stage) * tree.params().spacing, tree.stage_end(stage), 1e-9);
  }
  EXPECT_EQ(PathTree::kFirstBit[PathTree::kStages], bit);
  EXPECT_LE(bit, 512);
}

TEST(PathTree, StageForADistance) {
  const PathTree tree;
  EXPECT_EQ(tree.stage_for(0.1), 0);
  EXPECT_EQ(tree.stage_for(0.9), 3);
  EXPECT_EQ(tree.stage_for(1.2), 4);
  EXPECT_EQ(tree.stage_for(50.0), 6);
}

TEST(PathTree, EndBearingsGoFromRightToLeft) {
  const PathTree tree;
  EXPECT_LT(tree.end_bearing(3, 0), -20.0f);
  EXPECT_NEAR(tree.end_bearing(3, 3), 0.0f, 1e-3f);
  EXPECT_GT(tree.end_bearing(6, 342), 45.0f);
}

}  // namespace
}  // namespace adit::nav
