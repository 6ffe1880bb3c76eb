// SPDX-License-Identifier: Apache-2.0
#include "perception/input/frame_tree.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace adit::perception {
namespace {

Pose3 at(double x, double yaw = 0) { return Pose3::level({x, 0, yaw}, 0); }

TEST(FrameTree, FollowsTheChainOfParents) {
  FrameTree tree;
  ASSERT_TRUE(tree.set("base_footprint", "base_link", at(0.1)));
  ASSERT_TRUE(tree.set("/base_footprint", "/mast", at(1)));
  ASSERT_TRUE(tree.set("mast", "lidar", at(0.5, M_PI / 2)));
  const auto T = tree.find("base_link", "lidar");
  ASSERT_TRUE(T) << T.error().text;
  EXPECT_NEAR(T->position.x(), 1.4, 1e-12);
  EXPECT_NEAR(T->yaw(), M_PI / 2, 1e-12);
}

TEST(FrameTree, AnUnconnectedFrameIsNamed) {
  FrameTree tree;
  ASSERT_TRUE(tree.set("world", "velodyne", at(1)));
  const auto T = tree.find("base_link", "velodyne");
  EXPECT_EQ(T.reason(), Reason::frame_unknown);
  EXPECT_THAT(T.error().text, testing::HasSubstr("velodyne"));
}

TEST(FrameTree, ACircleEnds) {
  FrameTree tree;
  ASSERT_TRUE(tree.set("a", "b", at(1)));
  ASSERT_TRUE(tree.set("b", "a", at(1)));
  EXPECT_EQ(tree.find("base_link", "a").reason(), Reason::frame_unknown);
  EXPECT_EQ(tree.find("a", "c").reason(), Reason::frame_unknown);
}

TEST(FrameTree, RefusesAnInvalidTransform) {
  FrameTree tree;
  EXPECT_EQ(tree.set("a", "a", {}).error().reason, Reason::malformed);
  EXPECT_EQ(tree.set("", "a", {}).error().reason, Reason::malformed);
  EXPECT_EQ(tree.set("a", "b", {{0, 0, 0}, {0, 0, 0, 0}}).error().reason, Reason::malformed);
  EXPECT_EQ(tree.set("a", "b", at(std::numeric_limits<double>::quiet_NaN())).error().reason,
            Reason::malformed);
  for (std::size_t n = 0; n < FrameTree::kCapacity; ++n)
    ASSERT_TRUE(tree.set("base_link", "f" + std::to_string(n), {}));
  EXPECT_EQ(tree.set("base_link", "more", {}).error().reason, Reason::queue_full);
  EXPECT_TRUE(tree.set("base_link", "f3", at(3)));
}

}  // namespace
}  // namespace adit::perception
