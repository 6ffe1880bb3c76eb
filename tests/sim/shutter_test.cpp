// SPDX-License-Identifier: Apache-2.0
// Boxes that appear in the true world, as doors that shut.
#include <gtest/gtest.h>

#include "sim/world/simulation.hpp"

namespace adit::sim {
namespace {

constexpr Box kDoor{2.0, 2.2, -1.0, 1.0, 0.0, 2.0};

Simulation in_the_open(std::vector<PersonSpec> people, Pose2 robot = {0, 0, 0}) {
  SimulationParams params;
  params.lidar = LidarParams::planar();
  params.lidar.range_noise = 0.0;
  params.people = std::move(people);
  const std::array<Box, 1> boxes{Box{-20, -19.8, -20, 20, 0, 3}};
  auto world = std::make_shared<const World>(*make_box_world(boxes, 0, 3));
  auto simulation = Simulation::create(world, {{"r1", Platform{}, robot}}, params);
  EXPECT_TRUE(simulation) << simulation.error().text;
  return std::move(simulation).value();
}

void drive_for(Simulation& s, double seconds, const Twist2& velocity = {}) {
  for (int n = 0; n < 100 * seconds; ++n) {
    s.command(0, velocity);
    s.step();
  }
}

double seen_ahead(const Simulation& s) {
  double nearest = 100;
  for (const Eigen::Vector3f& p : s.scan(0).compute())
    if (std::fabs(p.y()) < 0.1f && p.x() > 0) nearest = std::min<double>(nearest, p.x());
  return nearest;
}

TEST(Shutter, StopsRobotsUntilItIsOpened) {
  Simulation s = in_the_open({});
  EXPECT_GT(seen_ahead(s), 10);
  const std::size_t door = s.close(kDoor);
  drive_for(s, 3, {1, 0, 0});
  EXPECT_TRUE(s.closed(door));
  EXPECT_LT(s.truth(0).pose.position.x(), 2.0 - Platform{}.length / 2);
  ASSERT_EQ(s.collisions().size(), 1u);
  EXPECT_EQ(s.collisions()[0].partner, "world");
  EXPECT_NEAR(seen_ahead(s), 2.0 - s.truth(0).pose.position.x(), 0.05) << "and lidars see it";
  s.open(door);
  drive_for(s, 2, {1, 0, 0});
  EXPECT_GT(s.truth(0).pose.position.x(), 2.5);
  EXPECT_GT(seen_ahead(s), 10);
}

TEST(Shutter, WaitsForARobotThatIsInItOrCannotStopBeforeIt) {
  Simulation s = in_the_open({}, {2.1, 0, 0});
  const std::size_t door = s.close(kDoor);
  drive_for(s, 1);
  EXPECT_FALSE(s.closed(door));
  drive_for(s, 2, {1, 0, 0});
  EXPECT_TRUE(s.closed(door)) << "it has left";
  EXPECT_EQ(s.truth(0).collisions, 0u);

  Simulation fast = in_the_open({});
  drive_for(fast, 1.0, {1, 0, 0});
  const std::size_t in_time = fast.close(kDoor);
  drive_for(fast, 0.1, {1, 0, 0});
  EXPECT_FALSE(fast.closed(in_time)) << "0.7 m before it at 1 m/s";
  drive_for(fast, 3, {1, 0, 0});
  EXPECT_TRUE(fast.closed(in_time));
  EXPECT_EQ(fast.truth(0).collisions, 0u);
}

TEST(Shutter, LetsNoPersonThrough) {
  Simulation s = in_the_open({{{{2.1, 0.5}, {5, 0.5}}, 1.0, false}}, {-5, 0, 0});
  const std::size_t door = s.close(kDoor);
  drive_for(s, 0.1);
  EXPECT_FALSE(s.closed(door)) << "somebody stands in it";
  drive_for(s, 2);
  EXPECT_TRUE(s.closed(door));
  drive_for(s, 8);
  EXPECT_GT(s.people()[0].body().pose.x, 2.2) << "waits before it";
  s.open(door);
  drive_for(s, 2);
  EXPECT_LT(s.people()[0].body().pose.x, 5.0);
}

TEST(Shutter, BelowAStepOrAboveTheRobotIsNotInItsWay) {
  Simulation s = in_the_open({});
  s.close({1.0, 1.2, -1, 1, 0.0, Platform{}.step - 0.01});
  s.close({2.0, 2.2, -1, 1, Platform{}.height + 0.01, 3.0});
  drive_for(s, 4, {1, 0, 0});
  EXPECT_EQ(s.truth(0).collisions, 0u);
  EXPECT_GT(s.truth(0).pose.position.x(), 2.5);
}

}  // namespace
}  // namespace adit::sim
