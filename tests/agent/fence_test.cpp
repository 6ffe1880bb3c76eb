// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/fence.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace adit::agent {
namespace {

/// A robot of 0.6 x 0.5 m whose odometry begins at x = 10 in the map, and is set by the test.
class FenceTest : public testing::Test {
 protected:
  FenceTest() { at(0); }
  static Platform platform() {
    Platform platform{};
    platform.max_speed = platform.max_turn = 1000;  // The tests put the robot elsewhere, which is no jump.
    return platform;
  }
  void add(const char* name, nav::AreaKind kind, std::vector<Eigen::Vector2d> corners) {
    ASSERT_TRUE(areas.add(nav::checked({.name = name, .kind = kind, .corners = std::move(corners)}).value()));
  }
  /// In the odometry frame.
  void at(double x, bool bound = true) {
    now += 1s;
    EXPECT_TRUE(frames.update(Pose3::level({x, 0, 0}, 0), {}, ++stamp, now));
    fence.update(areas, frames, sigma, bound);
  }
  /// The largest x at which the front of the robot may be, its y being 0.
  double farthest() const {
    double x = 0.0;
    while (x < 20.0 && fence.binding().permits({x + 0.01, 0, 0}, 0.0)) x += 0.01;
    return x;
  }

  Time now{Duration{1h}};
  std::uint64_t stamp{};
  double sigma{};
  Frames frames{Pose2{10, 0, 0}, platform()};
  nav::AreaSet areas{};
  Fence fence{platform()};
};

TEST_F(FenceTest, IsEmptyWithoutAreas) {
  EXPECT_TRUE(fence.empty());
  EXPECT_TRUE(fence.is_obeyed());
  EXPECT_TRUE(fence.border(frames, 5).empty());
}

TEST_F(FenceTest, AreasAreThoseOfTheOdometryFrame) {
  add("west", nav::AreaKind::keep_in, {{0, -5}, {15, 5}});
  at(0);
  EXPECT_TRUE(fence.all().permits({4.9, 0, 0}));
  EXPECT_FALSE(fence.all().permits({5.1, 0, 0}));
  frames.set_pose({12, 0, 0});
  at(0);
  EXPECT_TRUE(fence.all().permits({2.9, 0, 0}));
  EXPECT_FALSE(fence.all().permits({3.1, 0, 0})) << "the map was corrected";
}

// The robot is 0.6 m long, and the border of `west` is at x = 5.
TEST_F(FenceTest, TheDistanceGrowsWithTheUncertaintyOfThePlace) {
  add("west", nav::AreaKind::keep_in, {{0, -5}, {15, 5}});
  at(0);
  EXPECT_NEAR(farthest(), 4.9, 0.015);
  sigma = 0.2;
  at(0);
  EXPECT_NEAR(farthest(), 4.3, 0.015);
  EXPECT_FALSE(fence.all().permits({4.1, 0, 0}, 0.25)) << "nor is a goal there";
  EXPECT_NEAR(Fence::margin(0.01), 0.15, 1e-9) << "in steps";
  EXPECT_NEAR(Fence::margin(std::numeric_limits<double>::infinity()), 10.0, 1e-9);
  at(4.3);
  EXPECT_NEAR(farthest(), 4.3, 0.015) << "nor does the border yield to a robot that drives";
}

TEST_F(FenceTest, AUncertaintyThatGrowsLeavesTheBodyWhereItIs) {
  add("west", nav::AreaKind::keep_in, {{0, -5}, {15, 5}});
  at(4.5);
  sigma = 0.2;
  at(4.5);
  EXPECT_NEAR(farthest(), 4.87, 0.04) << "as before";
  at(4.2);
  EXPECT_NEAR(farthest(), 4.6, 0.061) << "it follows the body back";
  at(4.5);
  EXPECT_LE(farthest(), 4.61) << "and stays there";
}

TEST_F(FenceTest, ABodyThatWasDrivenOutComesBackAndGetsNoFartherOut) {
  add("west", nav::AreaKind::keep_in, {{0, -5}, {15, 5}});
  at(0);
  at(5.1, false);
  EXPECT_FALSE(fence.is_obeyed());
  EXPECT_FALSE(fence.is_far_out());
  at(5.1);
  EXPECT_GE(farthest(), 5.44) << "the front is at 5.4";
  EXPECT_LE(farthest(), 5.51);
  for (const Eigen::Vector2f& point : fence.border(frames, 5)) EXPECT_GT(point.x(), 5.43F);
  at(5.3);
  EXPECT_LE(farthest(), 5.51) << "it is bound";
  at(4.8);
  EXPECT_LE(farthest(), 5.21);
  at(4.5);
  at(4.9);
  EXPECT_NEAR(farthest(), 4.9, 0.06) << "it is back";
}

TEST_F(FenceTest, ABodyFarOutDoesNotComeBackByItself) {
  add("west", nav::AreaKind::keep_in, {{0, -5}, {15, 5}});
  at(5.6, false);
  EXPECT_FALSE(fence.is_far_out());
  at(5.8, false);
  EXPECT_TRUE(fence.is_far_out());
}

TEST_F(FenceTest, ACorrectionOfTheMapMovesTheBorderOutToTheBody) {
  add("west", nav::AreaKind::keep_in, {{0, -5}, {15, 5}});
  at(4.5);
  frames.set_pose({15.1, 0, 0});  // 0.6 m farther
  at(4.5);
  EXPECT_FALSE(fence.is_obeyed());
  EXPECT_GE(farthest(), 4.84) << "the front is at 4.8, the border at 4.4";
  EXPECT_LE(farthest(), 4.91);
  frames.set_pose({15.13, 0, 0});
  at(4.5);
  EXPECT_LE(farthest(), 4.91) << "small corrections add up to nothing";
}

TEST_F(FenceTest, AreasToKeepOutOfBindOneByOne) {
  add("near", nav::AreaKind::keep_out, {{12, -1}, {14, 1}});
  add("far", nav::AreaKind::keep_out, {{18, -1}, {20, 1}});
  at(2.0);
  EXPECT_FALSE(fence.is_obeyed());
  EXPECT_TRUE(fence.binding().permits({2.25, 0, 0})) << "its border is moved to the body";
  EXPECT_FALSE(fence.binding().permits({3, 0, 0})) << "the middle is farther in";
  EXPECT_FALSE(fence.binding().permits({8.2, 0, 0}));
  for (const Eigen::Vector2f& point : fence.border(frames, 3))
    EXPECT_FALSE(fence.all().permits({point.x(), point.y(), 0})) << "no line lies in the way out";
  at(1.0);
  EXPECT_FALSE(fence.binding().permits({2.1, 0, 0}));
  areas.remove("near");
  areas.remove("far");
  at(6);
  EXPECT_TRUE(fence.empty());
  EXPECT_TRUE(fence.is_obeyed());
}

}  // namespace
}  // namespace adit::agent
