// SPDX-License-Identifier: Apache-2.0
#include "nav/control/controller.hpp"

#include <gtest/gtest.h>

#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

constexpr double kControlPeriod = 0.02;

/// A straight plan of `length` metres along `yaw` from the origin.
Plan straight(double length, double yaw = 0.0, double speed = 10.0) {
  Plan plan;
  plan.length = length;
  plan.max_speed = speed;
  plan.pose_count = static_cast<std::uint32_t>(std::lround(length / 0.05)) + 1;
  for (std::uint32_t i = 0; i < plan.pose_count; ++i)
    plan.poses[i] = {0.05 * i * std::cos(yaw), 0.05 * i * std::sin(yaw), yaw};
  return plan;
}

/// Follows until it stands or for `seconds`; checks the platform's limits on the way.
Pose2 run(Controller& follower, const Platform& p, Pose2 pose, double seconds) {
  for (double t = 0; t < seconds; t += kControlPeriod) {
    const Twist2 before = follower.command();
    const Twist2 v = follower.follow(pose, kControlPeriod);
    EXPECT_LE(std::hypot(v.vx, v.vy), p.max_speed + 1e-9);
    EXPECT_LE(std::fabs(v.wz), p.max_turn + 1e-9);
    EXPECT_LE(std::hypot(v.vx - before.vx, v.vy - before.vy), p.max_acceleration * kControlPeriod + 1e-9);
    EXPECT_LE(std::fabs(follower.command().wz - before.wz), p.max_turn_acceleration * kControlPeriod + 1e-9);
    if (!p.sideways()) {
      EXPECT_EQ(v.vy, 0.0);
    }
    pose =
        pose * Pose2{v.vx * kControlPeriod, v.vy * kControlPeriod, (1 - p.turn_slip) * v.wz * kControlPeriod};
  }
  return pose;
}

/// Each controller, by its name.
class ControllerTest : public testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<Controller> make(const Platform& platform) {
    return make_controller(GetParam(), platform).value();
  }
};
INSTANTIATE_TEST_SUITE_P(All, ControllerTest, testing::ValuesIn(controller_names()),
                         [](const auto& each) { return each.param; });

TEST(Controllers, AnUnknownNameIsAnError) {
  const auto made = make_controller("mppi", wheeled());
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().text, "no controller 'mppi': ilqr or pure_pursuit");
}

TEST_P(ControllerTest, LearnsHowMuchOfATurnTheGroundSwallows) {
  Platform assumed = tracked();
  assumed.turn_slip = 0.0;  // and the ground takes a third
  const auto follower = make(assumed);
  Plan circle;
  circle.max_speed = 0.6;
  circle.pose_count = Plan::kMaxPath;
  circle.length = 0.05 * (Plan::kMaxPath - 1);
  Pose2 pose;
  for (double t = 0; t < 5.0; t += kControlPeriod) {
    Pose2 ahead = pose;
    for (Pose2& p : circle.poses) p = ahead, ahead = ahead * Pose2{0.05, 0, 0.05};
    follower->set_plan(circle);
    const Twist2 v = follower->follow(pose, kControlPeriod);
    const double turn = v.wz * 2 / 3;
    if (t > 3.0) {
      EXPECT_NEAR(turn, follower->command().wz, 0.02) << t;
    }
    pose = pose * Pose2{v.vx * kControlPeriod, v.vy * kControlPeriod, turn * kControlPeriod};
  }
}

TEST_P(ControllerTest, StopsAtTheEndOfAPath) {
  for (const Platform& p : {wheeled(), tracked(), legged()}) {
    const auto made = make(p);
    Controller& follower = *made;
    follower.set_plan(straight(3.0));
    const Pose2 end = run(follower, p, {0, 0.1, 0.05}, 10);
    EXPECT_NEAR(end.x, 3.0, 0.2) << p.name;
    EXPECT_NEAR(end.y, 0.0, 0.08) << p.name;
    EXPECT_TRUE(follower.command().zero());
  }
}

TEST_P(ControllerTest, TurnsOnTheSpotFirst) {
  const auto made = make(wheeled());
  Controller& follower = *made;
  follower.set_plan(straight(2.0, 2.0));
  const Pose2 turned = run(follower, wheeled(), {}, 1.2);
  EXPECT_LT(turned.position().norm(), 0.05);
  EXPECT_GT(turned.yaw, 0.8);
  const Pose2 end = run(follower, wheeled(), turned, 8);
  EXPECT_LT((end.position() - Eigen::Vector2d(2 * std::cos(2.0), 2 * std::sin(2.0))).norm(), 0.25);
}

TEST_P(ControllerTest, TurnsToTheSideThatIsFree) {
  const auto made = make(wheeled());
  Controller& follower = *made;
  Plan plan = straight(2.0, 2.5);
  plan.turn = -1;  // the long way round
  follower.set_plan(plan);
  EXPECT_LT(run(follower, wheeled(), {}, 0.6).yaw, -0.2);
}

TEST_P(ControllerTest, FollowsBackwards) {
  const auto made = make(tracked());
  Controller& follower = *made;
  Plan plan = straight(2.0, M_PI);
  plan.reverse = true;
  for (auto& pose : plan.poses) pose.yaw = 0;
  follower.set_plan(plan);
  const Pose2 end = run(follower, tracked(), {0, 0.05, 0}, 8);
  EXPECT_NEAR(end.x, -2.0, 0.2);
  EXPECT_NEAR(end.yaw, 0.0, 0.2);
}

TEST_P(ControllerTest, KeepsToThePlansSpeed) {
  const auto made = make(wheeled());
  Controller& follower = *made;
  follower.set_plan(straight(3.0, 0.0, 0.4));
  run(follower, wheeled(), {}, 1.0);
  EXPECT_NEAR(follower.command().vx, 0.4, 0.005);
}

TEST_P(ControllerTest, AnEmptyPlanIsASmoothStopAndStopNowIsZeroAtOnce) {
  const auto made = make(wheeled());
  Controller& follower = *made;
  follower.set_plan(straight(3.0));
  Pose2 pose = run(follower, wheeled(), {}, 0.6);
  ASSERT_GT(follower.command().vx, 0.5);
  follower.set_plan(Plan{});
  pose = run(follower, wheeled(), pose, 0.04);
  EXPECT_GT(follower.command().vx, 0.3);
  EXPECT_TRUE(follower.stop_now().zero());
  EXPECT_TRUE(follower.follow(pose, kControlPeriod).zero());
}

TEST_P(ControllerTest, ContinuesFromTheVelocityThatWasSent) {
  const auto made = make(wheeled());
  Controller& follower = *made;
  follower.set_plan(straight(3.0));
  const Pose2 pose = run(follower, wheeled(), {}, 0.6);
  ASSERT_GT(follower.command().vx, 0.5);
  follower.sent({});  // as a collision monitor does
  EXPECT_LE(follower.follow(pose, kControlPeriod).vx, wheeled().max_acceleration * kControlPeriod + 1e-9);
}

}  // namespace
}  // namespace adit::nav::test
