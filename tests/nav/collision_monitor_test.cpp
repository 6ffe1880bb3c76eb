// SPDX-License-Identifier: Apache-2.0
#include "nav/monitor/held_watch.hpp"

#include <gtest/gtest.h>

#include "tests/folders/folders.hpp"
#include "tests/nav/box_world.hpp"
#include "tests/nav/scanned_monitor.hpp"

namespace adit::nav::test {
namespace {

using Cause = CollisionMonitor::Cause;
using Policy = CollisionMonitor::Policy;

/// A monitor that has seen a world from where the robot stands.
struct Seen {
  BoxWorld world{};
  Platform platform{wheeled()};
  Pose2 pose{};
  ScannedMonitor monitor{platform};
  std::mt19937 random{3};
  double noise{0.0};
  int columns{720};  ///< Of a scan; fewer make a test with many scans faster

  Seen(std::vector<Box> boxes, const Platform& p = wheeled(), const Pose2& at = {})
      : world{std::move(boxes)}, platform(p), pose(at), monitor(p) {
    look(0.0);
  }
  void look(double time) {
    monitor.look(world.scan(pose, platform.lidar_height, 16, columns, noise, random), Pose3::level(pose, 0),
                 time);
  }
  CollisionMonitor::Verdict ask(const Twist2& wanted, Policy policy = Policy::stop, double now = 0.0) const {
    return monitor.check(wanted, pose, now, policy);
  }
  /// Drives with that wish, a new scan every 0.1 s, as a body that brakes as fast as its platform can; how
  /// near it came, m.
  double drive(const Twist2& wanted, double seconds, Policy policy = Policy::stop) {
    double least = 10, time = 0;
    Twist2 v{};
    for (int i = 0; time < seconds; ++i) {
      if (i % 5 == 0) look(time);
      constexpr double kDt = 0.02;
      const Twist2 allowed = monitor.check(wanted, pose, time, policy).velocity;
      const auto step = [](double from, double to, double most) {
        return from + std::clamp(to - from, -most, most);
      };
      v = {step(v.vx, allowed.vx, platform.max_acceleration * kDt),
           step(v.vy, allowed.vy, platform.max_acceleration * kDt),
           step(v.wz, allowed.wz, platform.max_turn_acceleration * kDt)};
      pose = pose * Pose2{v.vx * kDt, v.vy * kDt, v.wz * kDt};
      time += kDt;
      least = std::min(least, world.clearance(platform, pose));
    }
    return least;
  }
};

TEST(CollisionMonitor, FreeSpaceLetsEverythingThrough) {
  const Seen seen({{5, 5.2, -3, 3}});
  for (const Twist2& t : {Twist2{2, 0, 0}, Twist2{-2, 0, 0}, Twist2{1, 0, 1.5}, Twist2{0, 0, -1.5}}) {
    const auto verdict = seen.ask(t);
    EXPECT_EQ(verdict.velocity, t);
    EXPECT_EQ(verdict.cause, Cause::none);
  }
}

TEST(CollisionMonitor, SlowsHeadOnAndStopsAtTheMargin) {
  for (const Platform& p : {wheeled(), tracked(), legged()}) {
    Seen seen({{2.5, 2.7, -3, 3}}, p);
    const double least = seen.drive({p.max_speed, 0, 0}, 12);
    EXPECT_GT(least, 0.0) << p.name;
    EXPECT_LT(least, 0.1) << p.name << ": it came as near as it safely can";
    EXPECT_EQ(seen.ask({p.max_speed, 0, 0}, Policy::stop, 12).cause, Cause::stopped);
  }
}

TEST(CollisionMonitor, LegsMayWalkUpToStairsAndNotIntoAWallBehindThem) {
  std::vector<Box> stairs;
  for (int n = 0; n < 4; ++n) stairs.push_back({0.6 + 0.3 * n, 3, -3, 3, 0, 0.2 * (n + 1)});
  const Seen legs(stairs, legged());
  EXPECT_GT(legs.ask({1.2, 0, 0}).velocity.vx, 0.5) << "slower, for what is as high as its lidar";
  EXPECT_LT(Seen(stairs, tracked()).ask({1.2, 0, 0}).velocity.vx, legs.ask({1.2, 0, 0}).velocity.vx);
  Seen bar({{2, 2.1, -3, 3, 0.58, 0.7}}, legged());
  EXPECT_GT(bar.drive({1.2, 0, 0}, 6), 0.0) << "nothing is seen below it";
  Seen wall({{1.5, 3, -3, 3, 0, 0.6}}, legged());
  EXPECT_GT(wall.drive({1.2, 0, 0}, 6), 0.0) << "as high as three steps, and none";
}

TEST(CollisionMonitor, LegsThatLookDownClimbStairsThatLookedLikeAWall) {
  std::vector<Box> stairs;
  for (int n = 0; n < 6; ++n) stairs.push_back({2.0 + 0.3 * n, 6, -3, 3, 0, 0.2 * (n + 1)});
  Seen legs(stairs, legged());
  legs.noise = 0.02;
  legs.look(0.0);
  // Not lifted by them: it looks from where it stands. What it saw from afar is no wall when it stands before
  // it.
  legs.world.lowest = -45;
  legs.pose.x = 1.4;
  for (int i = 1; i < 6; ++i) legs.look(0.1 * i);
  EXPECT_EQ(legs.ask({0.6, 0, 0}, Policy::stop, 0.5).velocity.vx, 0.6);
}

TEST(CollisionMonitor, LegsStopBeforeStepsThatAreTooHigh) {
  for (const Box& box :
       {Box{1.5, 3, -3, 3, 0, 0.30}, Box{1.5, 3, -3, 3, 0.55, 0.62}, Box{1.5, 3, -3, 3, 0, 0.35}}) {
    Seen legs({box}, legged());
    legs.world.lowest = -45;
    EXPECT_GT(legs.drive({0.8, 0, 0}, 5), 0.0) << box.z0 << " to " << box.z1;
  }
}

TEST(CollisionMonitor, TheSlowZoneGrowsWithTheSpeed) {
  const Seen seen({{1.5, 1.7, -3, 3}});
  EXPECT_EQ(seen.ask({0.5, 0, 0}).cause, Cause::none);
  const auto fast = seen.ask({2, 0, 0});
  EXPECT_EQ(fast.cause, Cause::slowed);
  EXPECT_GT(fast.velocity.vx, 0.8);
  EXPECT_LT(fast.velocity.vx, 1.9);
}

TEST(CollisionMonitor, SweepsTheArc) {
  // A post to the left: straight on passes it, a left bend meets it, a right bend does not.
  const Seen seen({{0.8, 1.0, 0.5, 0.7}});
  EXPECT_EQ(seen.ask({1.2, 0, 0}).cause, Cause::none);
  const auto left = seen.ask({1.2, 0, 1.1});
  EXPECT_EQ(left.cause, Cause::slowed);
  EXPECT_NEAR(left.velocity.wz / left.velocity.vx, 1.1 / 1.2, 1e-9) << "the arc is kept";
  EXPECT_EQ(seen.ask({1.2, 0, -1.1}).cause, Cause::none);
}

TEST(CollisionMonitor, ObstacleBehindStopsOnlyReverse) {
  Seen seen({{-0.7, -0.5, -1, 1}});
  EXPECT_EQ(seen.ask({1.5, 0, 0}).cause, Cause::none);
  EXPECT_NE(seen.ask({-1.0, 0, 0}).cause, Cause::none);
  EXPECT_GT(seen.drive({-1.0, 0, 0}, 6), 0.0);
}

TEST(CollisionMonitor, LetsHolonomicRobotsDriveSideways) {
  Seen seen({{-1, 1, 0.8, 1.0}}, legged());
  EXPECT_EQ(seen.ask({0, -1, 0}).cause, Cause::none);
  EXPECT_GT(seen.drive({0, 1, 0}, 6), 0.0);
}

TEST(CollisionMonitor, TurnsOnTheSpotBesideAWallAsFarAsThereIsRoom) {
  // 0.8 m x 0.6 m with a wall 8 cm beside it: the corners need 10 cm.
  Seen seen({{-2, 2, 0.38, 0.5}}, tracked());
  EXPECT_EQ(seen.ask({0.6, 0, 0}).cause, Cause::none) << "along the wall";
  EXPECT_GT(seen.drive({0, 0, 1.0}, 6), 0.0);
  EXPECT_LT(std::fabs(seen.pose.yaw), 0.7);
  Seen open({{-2, 2, 0.6, 0.8}}, tracked());
  open.drive({0, 0, 1.0}, 2);
  EXPECT_GT(open.pose.yaw, 1.4);
}

TEST(CollisionMonitor, SeesAWallThatIsNearerThanTheErrorsOfTheSensors) {
  // Bias and mounting make a wall 2 cm beside the body look as if it were 1 cm beside it, or touched it.
  for (const double gap : {0.01, 0.0}) {
    Seen seen({{-3, 3, tracked().width / 2 + gap, 1}}, tracked());
    seen.noise = 0.02;
    seen.look(0.0);
    EXPECT_EQ(seen.ask({0.3, 0, 0.3}).cause, Cause::stopped) << gap;
    EXPECT_EQ(seen.ask({0, 0, 0.5}).cause, Cause::stopped) << gap;
  }
}

TEST(CollisionMonitor, TheNoiseOfAWallIsNoNearerWall) {
  Seen seen({{-3, 3, wheeled().width / 2 + 0.045, 1}});
  seen.noise = 0.02;
  for (int i = 0; i < 20; ++i) {
    seen.look(0.1 * i);
    const auto verdict = seen.ask({0.3, 0, 0}, Policy::stop, 0.1 * i);
    EXPECT_EQ(verdict.cause, Cause::none) << i << ": " << verdict.velocity.vx;
  }
}

TEST(CollisionMonitor, LetsARobotInContactLeave) {
  Seen seen({{0.325, 0.5, -1, 1}});
  EXPECT_TRUE(seen.ask({0.3, 0, 0}).velocity.zero());
  EXPECT_EQ(seen.ask({-0.3, 0, 0}).velocity, (Twist2{-0.3, 0, 0}));
}

TEST(CollisionMonitor, AnOldScanStops) {
  const Seen seen({});
  EXPECT_EQ(seen.ask({1, 0, 0}, Policy::stop, 0.4).cause, Cause::none);
  const auto late = seen.ask({1, 0, 0}, Policy::stop, 0.6);
  EXPECT_EQ(late.cause, Cause::stale);
  EXPECT_TRUE(late.velocity.zero());
  const CollisionMonitor never(wheeled());
  EXPECT_TRUE(never.check({1, 0, 0}, {}, 0.0, Policy::stop).velocity.zero());
}

TEST(CollisionMonitor, ManualIsLimitedAndNeverStopped) {
  const Seen blocked({{0.33, 0.5, -1, 1}});
  const auto at_wall = blocked.ask({1, 0, 0}, Policy::limit);
  EXPECT_EQ(at_wall.cause, Cause::stopped);
  EXPECT_NEAR(at_wall.velocity.vx, 0.3, 1e-9);
  EXPECT_NEAR(blocked.ask({0.2, 0, 0}, Policy::limit).velocity.vx, 0.2, 1e-9) << "it is slow already";
  const auto late = blocked.ask({1, 0, 0.5}, Policy::limit, 9);
  EXPECT_EQ(late.cause, Cause::stale);
  EXPECT_NEAR(late.velocity.vx, 0.3, 1e-9);
  EXPECT_NEAR(late.velocity.wz, 0.15, 1e-9);
  EXPECT_LT(blocked.ask({0, 0, 1.5}, Policy::limit, 9).velocity.wz, 0.8) << "a corner's 0.3 m/s";
}

TEST(CollisionMonitor, ManualStopIsOnlyForSeenObstacles) {
  const Seen blocked({{0.33, 0.5, -1, 1}});
  EXPECT_TRUE(blocked.ask({1, 0, 0}, Policy::stop_seen).velocity.zero());
  EXPECT_NEAR(blocked.ask({1, 0, 0}, Policy::stop_seen, 9).velocity.vx, 0.3, 1e-9);
}

TEST(CollisionMonitor, RemembersObstaclesThatTheLidarNoLongerSees) {
  // A crate 0.25 m high is below the lowest ray when it is right before the robot.
  Seen seen({{1.6, 1.9, -0.3, 0.3, 0.0, 0.25}});
  EXPECT_GT(seen.drive({0.8, 0, 0}, 8), 0.0);
  EXPECT_LT(seen.pose.x, 1.3);
}

TEST(CollisionMonitor, AScanThatShowsItGoneFreesTheWay) {
  Seen seen({{0.8, 1.0, -0.3, 0.3}});
  EXPECT_NE(seen.ask({1.5, 0, 0}).cause, Cause::none);
  seen.world.boxes.clear();
  seen.look(0.1);
  EXPECT_EQ(seen.ask({1.5, 0, 0}, Policy::stop, 0.1).cause, Cause::none);
}

TEST(CollisionMonitor, ARampIsNoWallAndACeilingNoObstacle) {
  std::vector<Eigen::Vector3f> ramp;
  for (float x = 0.4f; x < 3.0f; x += 0.05f)
    for (float y = -1.0f; y < 1.0f; y += 0.05f) {
      ramp.emplace_back(x, y, 0.3f * (x - 0.4f));
      ramp.emplace_back(x, y, 1.2f);
    }
  ScannedMonitor monitor(wheeled());
  monitor.look(ramp, {}, 0);
  EXPECT_EQ(monitor.check({2, 0, 0}, {}, 0, Policy::stop).cause, Cause::none);
  for (float z = 0.0f; z < 0.5f; z += 0.05f) ramp.emplace_back(1.2f, 0.0f, 0.24f + z);  // a post on it
  monitor.look(ramp, {}, 0);
  EXPECT_EQ(monitor.check({2, 0, 0}, {}, 0, Policy::stop).cause, Cause::slowed);
}

TEST(CollisionMonitor, PassesAGapThatIsTenCentimetresWider) {
  for (const Platform& p : {wheeled(), tracked(), legged()}) {
    const double side = p.width / 2 + 0.05;
    Seen seen({{1, 3, side, side + 0.2}, {1, 3, -side - 0.2, -side}}, p);
    seen.noise = 0.02;
    seen.drive({0.5, 0, 0}, 9);
    EXPECT_GT(seen.pose.x, 3.5) << p.name;
  }
}

/// A person who walks, and a robot that drives with that wish as far as the monitor lets it.
struct Meeting {
  BoxWorld hall{{{-9, 9, 6, 6.2}, {-9, 9, -6.2, -6}, {9, 9.2, -6, 6}, {-9.2, -9, -6, 6}}};
  Platform platform{wheeled()};
  ScannedMonitor monitor{platform};
  std::mt19937 random{3};
  Pose2 pose{};
  Eigen::Vector2d person{0, 0}, walks{0, 0};
  Twist2 v{};
  double time{0};

  double apart() const {
    return BoxWorld{
        {{person.x() - 0.225, person.x() + 0.225, person.y() - 0.225, person.y() + 0.225, 0, 1.75}}}
        .clearance(platform, pose);
  }
  /// Until they touch, or for so long; true when they touched.
  bool touch(const Twist2& wish, double seconds) {
    constexpr double kDt = 0.02;
    for (int i = 0; i < static_cast<int>(seconds / kDt); ++i, time += kDt) {
      if (i % 5 == 0) {
        BoxWorld world = hall;
        world.boxes.push_back(
            {person.x() - 0.225, person.x() + 0.225, person.y() - 0.225, person.y() + 0.225, 0, 1.75});
        monitor.look(world.scan(pose, platform.lidar_height, 1, 360, 0.02, random), Pose3::level(pose, 0),
                     time);
      }
      const Twist2 allowed = monitor.check(wish, pose, time, Policy::stop).velocity;
      const auto step = [](double from, double to, double most) {
        return from + std::clamp(to - from, -most, most);
      };
      v = {step(v.vx, allowed.vx, platform.max_acceleration * kDt), 0,
           step(v.wz, allowed.wz, platform.max_turn_acceleration * kDt)};
      pose = pose * Pose2{v.vx * kDt, 0, v.wz * kDt};
      person += kDt * walks;
      if (apart() <= 0) return true;
    }
    return false;
  }
};

TEST(CollisionMonitor, StopsWhenAPersonWalksIntoIt) {
  for (const double speed : {0.6, 1.0, 1.5})
    for (const double wish : {0.5, 1.0, 2.0}) {
      Meeting m;
      m.person = {7.5, 0.1};
      m.pose.x = -2;
      EXPECT_FALSE(m.touch({wish, 0, 0}, 0.6));
      m.walks = {-speed, 0};
      EXPECT_TRUE(m.touch({wish, 0, 0}, 20));
      EXPECT_LT(m.v.vx, 0.05) << "he at " << speed << ", it at " << wish;
    }
}

TEST(CollisionMonitor, WithoutItsTrackerItWouldStillMove) {
  // What the test before would say of a monitor that takes him to stand.
  Meeting m;
  m.monitor.knows_movers = false;
  m.person = {7.5, 0.1};
  m.pose.x = -2;
  m.touch({2, 0, 0}, 0.6);
  m.walks = {-1.5, 0};
  EXPECT_TRUE(m.touch({2, 0, 0}, 20));
  EXPECT_GT(m.v.vx, 0.3);
}

TEST(CollisionMonitor, LetsItDriveAwayFromAPersonWhoCatchesUp) {
  Meeting m;
  m.person = {-4, 0};
  m.touch({}, 0.6);
  m.walks = {1.5, 0};
  m.touch({}, 1.2);
  EXPECT_FALSE(m.touch({1.8, 0, 0}, 3.0)) << "faster than he is";
  EXPECT_GT(m.v.vx, 1.7);
}

TEST(CollisionMonitor, WaitsForACrossingPersonAndGoesOn) {
  Meeting m;
  m.pose.x = -2;
  m.person = {1.5, -3.5};
  m.touch({}, 0.6);
  m.walks = {0, 1.3};
  EXPECT_FALSE(m.touch({1.2, 0, 0}, 5.0));
  EXPECT_GT(m.pose.x, 1.5) << "behind him it went on";
}

TEST(CollisionMonitor, StaysFartherFromAnObstacleOfFewNoisyReturns) {
  // At a blunt wall end and a corner, for a long time: one ring of 360 with 2 cm of noise.
  for (const Platform& p : {wheeled(), tracked(), legged()})
    for (std::uint64_t seed = 1; seed <= seeds(2, 6); ++seed)
      for (const double yaw : {0.0, 0.5, -0.9}) {
        Seen seen({{1.2, 1.5, 0.1, 3}, {0.9, 1.1, -1.6, -0.5}}, p, {0, 0, yaw});
        seen.random.seed(seed);
        const Twist2 wish{0.6, 0, yaw == 0.0 ? 0.3 : -0.2};
        double least = 10;
        for (int i = 0; i < 1500; ++i) {
          if (i % 5 == 0)
            seen.monitor.look(seen.world.scan(seen.pose, p.lidar_height, 1, 360, 0.02, seen.random),
                              Pose3::level(seen.pose, 0), 0.02 * i);
          const Twist2 v = seen.monitor.check(wish, seen.pose, 0.02 * i, Policy::stop).velocity;
          seen.pose = seen.pose * Pose2{0.02 * v.vx, 0, 0.02 * v.wz};
          least = std::min(least, seen.world.clearance(p, seen.pose));
        }
        EXPECT_GT(least, 0.0) << p.name << " seed " << seed << " yaw " << yaw;
      }
}

/// What its odometry says of how it moves: `share` of it, `late` s ago.
struct Odometer {
  double share{1}, late{0};
};

/// A car that drives along a wall and then wants to turn towards it; how near it came, m.
double turns_towards_a_wall(double speed, double apart, double turn, const Odometer& odometer) {
  Platform p = wheeled();
  p.drive = Drive::car;
  p.wheelbase = 0.4;
  Seen seen({{-5, 20, p.width / 2 + apart, 6}}, p);
  seen.noise = 0.02;
  seen.columns = 180;
  double least = 10, bend = 0;
  Twist2 v{speed, 0, 0}, allowed = v;
  std::vector<Twist2> driven{v};
  for (int i = 0; i < 300; ++i) {
    constexpr double kDt = 0.01, kBends = 2.0;  // s, 1/m per s
    const double time = kDt * i;
    if (i % 10 == 0) seen.look(time);
    const auto late = static_cast<std::size_t>(std::lround(odometer.late / kDt));
    const Twist2& was = driven[driven.size() - 1 - std::min(late, driven.size() - 1)];
    const Twist2 reported{odometer.share * was.vx, 0, odometer.share * was.wz};
    if (i % 5 == 0)
      allowed =
          seen.monitor.check({speed, 0, speed * turn}, seen.pose, time, Policy::stop, {reported, allowed.vx})
              .velocity;
    v.vx += std::clamp(allowed.vx - v.vx, -p.max_acceleration * kDt, p.max_acceleration * kDt);
    if (allowed.vx > 1e-3) bend += std::clamp(allowed.wz / allowed.vx - bend, -kBends * kDt, kBends * kDt);
    v.wz = bend * v.vx;
    driven.push_back(v);
    seen.pose = seen.pose * Pose2{v.vx * kDt, p.rear_axle() * v.wz * kDt, v.wz * kDt};
    least = std::min(least, seen.world.clearance(p, seen.pose));
  }
  return least;
}

class TurnTowardsAWall : public testing::TestWithParam<double> {};

TEST_P(TurnTowardsAWall, TooFastBrakesOnItsOwnArc) {
  const double speed = GetParam();
  double blind = 10;
  for (const double apart : {0.1, 0.3, 0.6})
    for (const double turn : {0.3, 1.2}) {
      for (const Odometer& odometer : {Odometer{}, Odometer{1.05}, Odometer{0.95}, Odometer{1, 0.1}})
        EXPECT_GT(turns_towards_a_wall(speed, apart, turn, odometer), 0.0)
            << apart << " m apart, " << turn << " per m, told " << odometer.share << " of it "
            << odometer.late << " s late";
      if (speed >= 2) blind = std::min(blind, turns_towards_a_wall(speed, apart, turn, {0.0}));
    }
  if (speed >= 2) {
    EXPECT_LT(blind, 0.0) << "braking on the arc that was asked for is too late";
  }
}

INSTANTIATE_TEST_SUITE_P(CollisionMonitor, TurnTowardsAWall, testing::Values(0.5, 1.0, 2.0));

TEST(CollisionMonitor, AVelocityThatIsNoneIsNotDriven) {
  Seen seen({{0.45, 0.7, -3, 3}});
  const Twist2 wanted{0.5, 0, 0};
  const Twist2 allowed = seen.ask(wanted).velocity;
  for (const Twist2& moves : {Twist2{500, 0, 0}, Twist2{-0.5, 0, 0}, Twist2{0.1, 0.1, 0}})
    EXPECT_EQ(seen.monitor.check(wanted, seen.pose, 0, Policy::stop, {moves}).velocity, allowed) << moves.vx;
}

TEST(CollisionMonitor, ForgetsNearPlacesThatRaysPass) {
  // Somebody who stood at the nose, nearer than the lidar sees, and left.
  Platform p = wheeled();
  ScannedMonitor monitor(p);
  std::mt19937 random{1};
  BoxWorld world{{{3, 3.2, -3, 3}, {0.33, 0.6, -0.2, 0.2}}};
  const auto look = [&](double time) {
    std::vector<Eigen::Vector3f> points = world.scan({}, p.lidar_height, 1, 360, 0.0, random);
    monitor.look(points, {}, time);
  };
  look(0.0);
  EXPECT_TRUE(monitor.check({0.5, 0, 0}, {}, 0.0, Policy::stop).velocity.zero());
  world.boxes.pop_back();
  for (int i = 1; i < 4; ++i) look(0.1 * i);
  EXPECT_EQ(monitor.check({0.5, 0, 0}, {}, 0.3, Policy::stop).cause, Cause::none);
}

TEST(CollisionMonitor, GarbageIsNoObstacleAndHarmsNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  ScannedMonitor monitor(wheeled());
  monitor.look(
      std::vector<Eigen::Vector3f>{{nan, 0, 0.3f}, {0.6f, nan, 0.3f}, {0.6f, 0, nan}, {inf, inf, inf}}, {},
      0);
  EXPECT_EQ(monitor.check({2, 0, 0}, {}, 0, Policy::stop).cause, Cause::none);
  monitor.look(std::vector<Eigen::Vector3f>{{0.6f, 0, 0.3f}}, {}, 0);
  EXPECT_EQ(monitor.check({2, 0, 0}, {}, 0, Policy::stop).cause, Cause::none) << "one return alone is noise";
}

TEST(HeldWatch, ShortBreaksDoNotEndItWayAndLongOnesDo) {
  const Eigen::Vector2d here{1, 2};
  HeldWatch watch;
  EXPECT_FALSE(watch.held(0.0, 0.0)) << "never stopped";
  watch.look(true, here, 0.0);
  watch.look(false, here, 0.4);
  watch.look(true, here, 0.5);
  EXPECT_FALSE(watch.held(1.4, 1.5));
  EXPECT_TRUE(watch.held(1.5, 1.5));
  watch.look(false, here, 1.1);
  EXPECT_FALSE(watch.held(2.0, 1.5)) << "0.6 s without being stopped";
  watch.look(true, here, 2.0);
  watch.look(true, here + Eigen::Vector2d(0.31, 0), 2.1);
  EXPECT_FALSE(watch.held(3.5, 1.5)) << "slow, not held";
  EXPECT_TRUE(watch.held(3.6, 1.5));
  watch.clear();
  EXPECT_FALSE(watch.held(9.0, 1.5));
}

}  // namespace
}  // namespace adit::nav::test
