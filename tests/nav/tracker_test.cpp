// SPDX-License-Identifier: Apache-2.0
#include "nav/tracking/tracker.hpp"

#include <gtest/gtest.h>

#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

/// A room of 16 x 10 m with a person in it, seen at 10 Hz by a robot that drives.
struct Watch {
  BoxWorld room{{{-8, 8, 5, 5.2}, {-8, 8, -5.2, -5}, {8, 8.2, -5, 5}, {-8.2, -8, -5, 5}, {3, 3.3, -5, -2}}};
  Platform platform{wheeled()};
  Tracker tracker{platform};
  std::mt19937 random{5};
  Pose2 pose{};
  Eigen::Vector2d person{100, 100};
  double time{0};
  int rings{1}, columns{360};
  Pose2 slip{};  ///< Error of the odometry.

  void scan() {
    BoxWorld world = room;
    world.boxes.push_back(
        {person.x() - 0.225, person.x() + 0.225, person.y() - 0.225, person.y() + 0.225, 0, 1.75});
    const auto points = world.scan(pose, platform.lidar_height, rings, columns, 0.02, random);
    tracker.look(points, Pose3::level(slip * pose, 0), time);
  }
  void pass(double seconds, const Eigen::Vector2d& walks, const Twist2& drives = {}) {
    for (double end = time + seconds - 1e-6; time < end;) {
      time += 0.1;
      person += 0.1 * walks;
      pose = pose * Pose2{0.1 * drives.vx, 0, 0.1 * drives.wz};
      scan();
    }
  }
  const Mover* moving() const {
    for (const Mover& mover : tracker.movers())
      if (mover.moves) return &mover;
    return nullptr;
  }
};

class TrackerOf : public testing::TestWithParam<int> {};  // rings

TEST_P(TrackerOf, FindsAWalkingPersonAndItsSpeedWithinASecond) {
  struct Case {
    Eigen::Vector2d from, walks;
    Twist2 drives;
  };
  for (const Case& c :
       {Case{{5, 1}, {-1.5, 0}, {}}, Case{{3, -2}, {0, 1.2}, {}}, Case{{5, 0.3}, {-1.5, 0}, {1.5, 0, 0}},
        Case{{3, 3}, {0.5, -1}, {0.5, 0, 0.5}}, Case{{-4, 2}, {1, -0.6}, {}}}) {
    Watch w;
    w.rings = GetParam();
    w.person = c.from;
    w.pass(0.8, {0, 0}, c.drives);
    EXPECT_EQ(w.tracker.movers().size(), 0u) << "he stands";
    w.pass(1.0, c.walks, c.drives);
    const Mover* mover = w.moving();
    ASSERT_NE(mover, nullptr) << c.from.transpose();
    EXPECT_LT((mover->velocity.cast<double>() - c.walks).norm(), 0.4) << c.from.transpose();
    EXPECT_LT((mover->position.cast<double>() - w.person).norm(), 0.35);
    EXPECT_GT(mover->count, 1u);
    for (const Eigen::Vector2f& p : mover->surface())
      EXPECT_LT((p.cast<double>() - w.person).cwiseAbs().maxCoeff(), 0.3) << "of his side that is seen";
    EXPECT_EQ(w.tracker.movers().size(), 1u) << "and nobody else";
  }
}

TEST_P(TrackerOf, RemembersAMoverThatStopped) {
  Watch w;
  w.rings = GetParam();
  w.person = {4, -2};
  w.pass(0.6, {0, 0});
  w.pass(1.5, {0, 1.2});
  ASSERT_NE(w.moving(), nullptr);
  w.pass(1.0, {0, 0});
  EXPECT_EQ(w.moving(), nullptr);
  ASSERT_EQ(w.tracker.movers().size(), 1u);
  EXPECT_TRUE(w.tracker.movers()[0].velocity.isZero());
  EXPECT_LT((w.tracker.movers()[0].position.cast<double>() - w.person).norm(), 0.5);
  w.pass(4.0, {0, 0});
  EXPECT_EQ(w.tracker.movers().size(), 0u);
}

TEST_P(TrackerOf, ARobotThatDrivesAmongWallsSeesNothingMove) {
  Watch w;
  w.rings = GetParam();
  for (const Twist2& drives : {Twist2{2, 0, 0}, Twist2{-1, 0, 0.5}, Twist2{0, 0, 1.5}, Twist2{0, 0, -1.5},
                               Twist2{1.5, 0, -0.8}, Twist2{0.3, 0, 0.1}}) {
    w.pass(2.0, {0, 0}, drives);
    EXPECT_EQ(w.tracker.movers().size(), 0u) << drives.vx << " " << drives.wz;
  }
}

INSTANTIATE_TEST_SUITE_P(Rings, TrackerOf, testing::Values(1, 16),
                         [](const auto& each) { return std::to_string(each.param); });

TEST(Tracker, AJumpOfTheOdometryIsNoMotion) {
  Watch w;
  w.pass(1.0, {0, 0});
  w.slip = {0.6, 0.4, 0.2};
  w.pass(1.5, {0, 0});
  EXPECT_EQ(w.tracker.movers().size(), 0u);
}

TEST(Tracker, FindsAPersonWhoAppearsFromBehindAWallAndNotTheWall) {
  Watch w;
  w.person = {4, -3};  // behind the screen at x = 3
  w.pass(1.0, {0, 0});
  w.pass(1.6, {0, 1.5});
  const Mover* mover = w.moving();
  ASSERT_NE(mover, nullptr);
  EXPECT_LT((mover->position.cast<double>() - w.person).norm(), 0.4);
  EXPECT_EQ(w.tracker.movers().size(), 1u);
}

TEST(Tracker, MoreThanItHasRoomForHarmNothing) {
  const Platform platform = wheeled();
  Tracker tracker(platform);
  for (int scan = 0; scan < 20; ++scan) {
    std::vector<Eigen::Vector3f> points;
    for (int degree = 0; degree < 360; ++degree) {
      const double a = degree * M_PI / 180;
      const bool walker = degree % 8 < 3 && degree < 170 && scan > 5;
      const double range = walker ? 6.0 - 0.15 * (scan - 5) : 7.5;
      points.emplace_back(Eigen::Vector3d(range * std::cos(a), range * std::sin(a), 0.5).cast<float>());
    }
    tracker.look(points, {}, 0.1 * scan);
    EXPECT_LE(tracker.movers().size(), Tracker::kMax);
  }
  EXPECT_EQ(tracker.movers().size(), Tracker::kMax);
}

TEST(Tracker, IgnoresGarbage) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  Tracker tracker(wheeled());
  for (int scan = 0; scan < 10; ++scan)
    tracker.look(std::vector<Eigen::Vector3f>{{nan, 0, 0.5f}, {2, nan, 0.5f}, {2, 0, nan}, {inf, inf, inf}},
                 {}, 0.1 * scan);
  EXPECT_EQ(tracker.movers().size(), 0u);
}

}  // namespace
}  // namespace adit::nav::test
