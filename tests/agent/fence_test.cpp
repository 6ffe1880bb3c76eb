// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/fence.hpp"

#include <gmock/gmock.h>

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
  void at(double x) {
    now += 1s;
    EXPECT_TRUE(frames.update(Pose3::level({x, 0, 0}, 0), {}, ++stamp, now));
    fence.update(areas, frames);
  }
  bool binds(const char* name) const { return fence.binding().find(name) != nullptr; }

  Time now{Duration{1h}};
  std::uint64_t stamp{};
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

TEST_F(FenceTest, BindsUntilTheMiddleOfTheBodyIsOutsideAndAgainOnceAllOfItIsWithin) {
  add("west", nav::AreaKind::keep_in, {{0, -5}, {15, 5}});
  at(0);
  EXPECT_TRUE(binds("west"));
  at(4.9);
  EXPECT_TRUE(binds("west")) << "the front reaches over";
  EXPECT_FALSE(fence.is_obeyed());
  EXPECT_FALSE(fence.border(frames, 5).empty());
  at(5.1);
  EXPECT_FALSE(binds("west")) << "driven out by hand";
  EXPECT_TRUE(fence.border(frames, 5).empty()) << "nothing keeps it from coming back";
  at(4.65);
  EXPECT_FALSE(binds("west")) << "within, but nearer than the margin";
  EXPECT_TRUE(fence.is_obeyed());
  at(4.5);
  EXPECT_TRUE(binds("west"));
}

TEST_F(FenceTest, AreasToKeepOutOfBindOneByOne) {
  add("near", nav::AreaKind::keep_out, {{12, -1}, {14, 1}});
  add("far", nav::AreaKind::keep_out, {{18, -1}, {20, 1}});
  at(3);
  EXPECT_FALSE(binds("near")) << "it stands in it";
  EXPECT_TRUE(binds("far"));
  at(6);
  EXPECT_TRUE(binds("near"));
  areas.remove("near");
  areas.remove("far");
  at(6);
  EXPECT_TRUE(fence.empty());
  EXPECT_TRUE(fence.is_obeyed());
}

TEST_F(FenceTest, ACorrectionOfTheMapBindsNothingThatDidNot) {
  add("west", nav::AreaKind::keep_in, {{0, -5}, {15, 5}});
  at(5.1);
  ASSERT_FALSE(binds("west"));
  frames.set_pose({14.95, 0, 0});
  at(5.1);
  EXPECT_FALSE(binds("west")) << "the body still reaches over the border";
}

}  // namespace
}  // namespace adit::agent
