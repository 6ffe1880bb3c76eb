// SPDX-License-Identifier: Apache-2.0
// Faults between a drive and the ground: what the body does, and what its odometry says.
#include "sim/world/traction.hpp"

#include <gtest/gtest.h>

#include "sim/world/simulation.hpp"
#include "tests/sim/wheeled.hpp"

namespace adit::sim {
namespace {

/// A robot on a plain of 40 x 40 m; its odometry has no error.
Simulation make(const Platform& platform, bool realistic) {
  SimulationParams params;
  params.realistic = realistic;
  params.noise = 0.0;
  params.odometry = OdometryParams{}.scaled(0.0);
  const std::array<Box, 1> wall{Box{20, 21, -20, 20, 0, 3}};
  return *Simulation::create(std::make_shared<const World>(*make_box_world(wall, 0, 3)),
                             {{"r1", platform, {1, 2, 0.5}}}, params);
}

void drive(Simulation& s, const Twist2& wanted, double time) {
  for (int n = 0; n < std::lround(time / 0.01); ++n) {
    s.command(0, wanted);
    s.step();
  }
}

class TractionTest : public testing::TestWithParam<bool> {
 protected:
  bool realistic() const { return GetParam(); }
};

INSTANTIATE_TEST_SUITE_P(Lidar, TractionTest, testing::Bool(),
                         [](const auto& p) { return p.param ? "full" : "planar"; });

TEST_P(TractionTest, WheelsOfAStuckBodyTurnAsTheSlipSaysWhateverIsCommanded) {
  for (const Twist2& wanted : {Twist2{}, Twist2{-0.5, 0.0, 0.3}}) {
    Simulation s = make(wheeled(), realistic());
    drive(s, {0.8, 0, 0}, 2.0);
    const Pose2 stood = s.truth(0).pose.planar(), counted = s.odometry(0).pose();
    s.traction(0).slip({1.5, 0.0, 0.0}, true);
    drive(s, wanted, 4.0);
    EXPECT_EQ(s.truth(0).pose.planar().position(), stood.position());
    EXPECT_EQ(s.truth(0).pose.yaw(), stood.yaw);
    EXPECT_TRUE(s.truth(0).twist.zero());
    EXPECT_EQ(s.truth(0).collisions, 0U);
    const Pose2 way = counted.inverse() * s.odometry(0).pose();
    EXPECT_NEAR(way.x, 6.0, 1e-6);
    EXPECT_NEAR(way.y, 0.0, 1e-6);
    EXPECT_NEAR(s.odometry(0).twist().vx, 1.5, 1e-6);
  }
}

TEST_P(TractionTest, WheelsOfASlipMayTurnBackwardsAndOnTheSpot) {
  Simulation s = make(wheeled(), realistic());
  s.traction(0).slip({-1.0, 0.0, 0.0}, true);
  drive(s, {}, 1.0);
  EXPECT_NEAR(s.odometry(0).pose().x, -1.0, 1e-6);
  s.traction(0).slip({-1.0, 0.0, 0.0}, false);
  s.traction(0).slip({0.0, 0.0, 0.7}, true);
  drive(s, {}, 2.0);
  EXPECT_NEAR(s.odometry(0).pose().x, -1.0, 1e-6);
  EXPECT_NEAR(s.odometry(0).pose().yaw, 1.4, 1e-6);
  EXPECT_NEAR(s.odometry(0).twist().wz, 0.7, 1e-6);
}

TEST_P(TractionTest, EachSlipEndsOnlyItselfAndThenTheBodyDrivesOn) {
  Simulation s = make(wheeled(), realistic());
  Traction& traction = s.traction(0);
  const Twist2 first{1.0, 0.0, 0.0}, second{0.5, 0.0, 0.0};
  traction.slip(first, true);
  traction.slip(second, true);
  drive(s, {1, 0, 0}, 1.0);
  EXPECT_NEAR(s.odometry(0).pose().x, 0.5, 1e-6) << "the newest counts";
  traction.slip(second, false);
  drive(s, {1, 0, 0}, 1.0);
  EXPECT_NEAR(s.odometry(0).pose().x, 1.5, 1e-6);
  traction.jam(true);
  traction.slip(first, false);
  drive(s, {1, 0, 0}, 1.0);
  EXPECT_NEAR(s.odometry(0).pose().x, 1.5, 1e-6) << "jammed wheels stand";
  EXPECT_EQ(s.truth(0).distance, 0.0);
  traction.jam(false);
  drive(s, {1, 0, 0}, 3.0);
  EXPECT_GT(s.truth(0).distance, 2.0);
  EXPECT_NEAR(s.odometry(0).pose().x, 1.5 + s.truth(0).distance, 1e-6);
}

TEST_P(TractionTest, TurnSlipTakesItsShareOfTheBodysTurnAndNothingOfTheWheels) {
  Platform tracked = wheeled();
  tracked.drive = Drive::tracked;
  tracked.turn_slip = 0.2;  // Known to the driver, whose odometry allows for it.
  for (const Platform& platform : {wheeled(), tracked}) {
    Simulation free = make(platform, realistic()), skids = make(platform, realistic());
    skids.traction(0).turn_slip(0.5, true);
    for (Simulation* s : {&free, &skids}) drive(*s, {0.5, 0, 0.8}, 3.0);
    const double all = free.odometry(0).pose().yaw;
    EXPECT_NEAR(free.truth(0).pose.yaw() - 0.5, all, 1e-9);
    EXPECT_NEAR(skids.odometry(0).pose().yaw, all, 1e-9);
    EXPECT_NEAR(skids.odometry(0).twist().wz, free.odometry(0).twist().wz, 1e-9);
    EXPECT_NEAR(skids.odometry(0).pose().x, free.odometry(0).pose().x, 1e-9);
    EXPECT_NEAR(skids.truth(0).pose.yaw() - 0.5, 0.5 * all, 1e-9);
    EXPECT_NEAR(skids.truth(0).distance, free.truth(0).distance, 1e-3) << "it drives as far";
    skids.traction(0).turn_slip(0.5, false);
    const double before = skids.truth(0).pose.yaw();
    drive(skids, {0, 0, 0.8}, 1.0);
    EXPECT_NEAR(skids.truth(0).pose.yaw() - before, skids.odometry(0).pose().yaw - all, 1e-9);
  }
}

TEST_P(TractionTest, TurnThatSlipsAwayLeavesTheBodyStandingAndACarGoesStraighter) {
  Simulation spot = make(wheeled(), realistic());
  spot.traction(0).turn_slip(1.0, true);
  drive(spot, {0, 0, 1.0}, 2.0);
  EXPECT_EQ(spot.truth(0).pose.yaw(), make(wheeled(), realistic()).truth(0).pose.yaw());
  EXPECT_GT(spot.odometry(0).pose().yaw, 1.5);

  Platform car = wheeled();
  car.drive = Drive::car;
  car.wheelbase = 0.4;
  car.max_steering = 0.5;
  Simulation free = make(car, realistic()), skids = make(car, realistic());
  skids.traction(0).turn_slip(0.3, true);
  for (Simulation* s : {&free, &skids}) drive(*s, {0.5, 0, 0.4}, 3.0);
  EXPECT_NEAR(skids.odometry(0).pose().yaw, free.odometry(0).pose().yaw, 1e-9);
  EXPECT_NEAR(skids.odometry(0).pose().y, free.odometry(0).pose().y, 1e-9);
  EXPECT_NEAR(skids.truth(0).pose.yaw() - 0.5, 0.7 * free.odometry(0).pose().yaw, 1e-9);
}

TEST_P(TractionTest, WallStopsTheWheelsOfABodyThatSkids) {
  Simulation s = make(wheeled(), realistic());
  s.traction(0).turn_slip(0.5, true);
  drive(s, {2.0, 0, 0}, 14.0);
  ASSERT_EQ(s.truth(0).collisions, 1U);
  EXPECT_NEAR(s.odometry(0).pose().x, s.truth(0).distance, 1e-6);
}

TEST_P(TractionTest, RestartedDriverCountsOnFromTheOriginOfItsFrame) {
  Simulation s = make(wheeled(), realistic());
  drive(s, {0.5, 0, 0.4}, 3.0);
  const Pose2 stood = s.truth(0).pose.planar(), origin{30.0, -4.0, 2.0};
  s.reset_odometry(0, origin);
  EXPECT_EQ(s.odometry(0).pose(), origin);
  EXPECT_EQ(s.truth(0).pose.planar(), stood);
  drive(s, {0.5, 0, 0.4}, 2.0);
  const Pose2 expected = origin * (stood.inverse() * s.truth(0).pose.planar());
  EXPECT_NEAR(s.odometry(0).pose().x, expected.x, 1e-6);
  EXPECT_NEAR(s.odometry(0).pose().y, expected.y, 1e-6);
  EXPECT_NEAR(s.odometry(0).pose().yaw, expected.yaw, 1e-6);
}

TEST(Traction, GyroSeesTheBodyTurnAndNoSpinOfItsWheels) {
  Simulation s = make(wheeled(), true);
  s.traction(0).turn_slip(0.5, true);
  drive(s, {0, 0, 0.8}, 3.0);
  EXPECT_NEAR(s.take_imu(0).back().gyro.z(), 0.4, 1e-3);
  s.traction(0).slip({0.0, 0.0, 1.5}, true);
  drive(s, {0, 0, 0.8}, 3.0);
  EXPECT_NEAR(s.take_imu(0).back().gyro.z(), 0.0, 1e-6);
}

}  // namespace
}  // namespace adit::sim
