// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/falco/correspondence.hpp"

#include <gtest/gtest.h>

namespace adit::nav {
namespace {

constexpr double kHalfLength = 0.4, kHalfWidth = 0.3;
const Footprint kBody(kHalfLength, kHalfWidth);

/// The bits that an obstacle at (x, y) blocks.
PathMask mask_at(const CorrespondenceGrid& grid, double x, double y) {
  const int ring = CorrespondenceGrid::ring_of(static_cast<float>(std::hypot(x, y)));
  const int angle = (static_cast<int>(std::floor(std::atan2(y, x) * 180 / M_PI)) + 360) % 360;
  return ring < grid.rings() ? grid.at(ring, angle) : PathMask{};
}

/// How deep (x, y) gets into the body anywhere on a part of a path.
double deepest(const PathTree& tree, int stage, int node, double x, double y) {
  double most = -1e9;
  const auto path = tree.path(PathTree::path_through(stage, node));
  for (std::size_t i = stage == 0 ? 0 : tree.last_pose(stage - 1); i <= tree.last_pose(stage); ++i) {
    const Eigen::Vector2d p = path[i].inverse() * Eigen::Vector2d(x, y);
    most = std::max(most, std::min(kHalfLength - std::fabs(p.x()), kHalfWidth - std::fabs(p.y())));
  }
  return most;
}

TEST(Correspondence, AgreesWithTheSweptBody) {
  // Places all around, against the sweep worked out pose by pose; the cell's own size is the tolerance.
  const PathTree tree;
  const CorrespondenceGrid grid(tree, kBody);
  int blocked = 0, checked = 0;
  for (double x = -0.9; x < 3.6; x += 0.23)
    for (double y = -2.0; y < 2.0; y += 0.19) {
      if (std::fabs(x) < kHalfLength + 0.05 && std::fabs(y) < kHalfWidth + 0.05) continue;
      const PathMask mask = mask_at(grid, x, y);
      for (int stage = 0; stage < PathTree::kStages; ++stage)
        for (int node = 0; node < PathTree::kNodes[stage]; node += stage == 6 ? 5 : 1) {
          const double depth = deepest(tree, stage, node, x, y);
          const bool bit = mask.test(PathTree::kFirstBit[stage] + node);
          if (depth > 0.06) {
            ASSERT_TRUE(bit) << x << ' ' << y << ' ' << stage << ' ' << node;
          } else if (depth < -0.06) {
            ASSERT_FALSE(bit) << x << ' ' << y << ' ' << stage << ' ' << node;
          }
          blocked += bit;
          ++checked;
        }
    }
  EXPECT_GT(blocked, checked / 50);
}

TEST(Correspondence, AnObstacleAheadBlocksTheStraightPathFromWhereItStands) {
  const PathTree tree;
  const CorrespondenceGrid grid(tree, kBody);
  const PathMask mask = mask_at(grid, 1.7, 0.01);
  EXPECT_FALSE(mask.test(PathTree::kFirstBit[3] + 3));         // up to 1 m: the body's front is at 1.4
  EXPECT_TRUE(mask.test(PathTree::kFirstBit[4] + 3 * 7 + 3));  // up to 1.5 m
}

TEST(Correspondence, ObstacleInsideTheMarginBlocksOnlyPathsIntoIt) {
  const PathTree tree;
  const CorrespondenceGrid grid(tree, kBody);
  // Beside the body's left front, inside its margin.
  const PathMask mask = mask_at(grid, 0.3, 0.27);
  const auto blocks = [&mask](int group) {  // anywhere in the first segment
    bool any = false;
    for (int stage = 0; stage < 4; ++stage) any |= mask.test(PathTree::kFirstBit[stage] + group);
    return any;
  };
  EXPECT_FALSE(blocks(3));  // straight on along it
  EXPECT_TRUE(blocks(6));   // turning into it
}

TEST(Correspondence, HalfAngleCoversAllThatBlocks) {
  const PathTree tree;
  const CorrespondenceGrid grid(tree, kBody);
  for (int ring = 0; ring < grid.rings(); ++ring)
    for (int a = 0; a < CorrespondenceGrid::kAngles; ++a)
      if (grid.at(ring, a).any()) {
        ASSERT_LE(a < 180 ? a : 359 - a, grid.half_angle(ring));
      }
  EXPECT_LT(grid.half_angle(grid.rings() - 8), 120);
}

TEST(Correspondence, AnEmptyGridBlocksNothing) { EXPECT_EQ(CorrespondenceGrid().rings(), 0); }

TEST(PathMask, DeadWhenAllGroupsAreBlockedAtTheirStart) {
  PathMask mask;
  EXPECT_FALSE(mask.any());
  for (int g = 0; g < 6; ++g) mask.set(g);
  EXPECT_FALSE(mask.dead());
  PathMask other;
  other.set(6);
  mask |= other;
  EXPECT_TRUE(mask.dead());
  EXPECT_TRUE(mask.any());
}

}  // namespace
}  // namespace adit::nav
