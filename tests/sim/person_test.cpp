// SPDX-License-Identifier: Apache-2.0
// People who walk in the true world.
#include "sim/world/person.hpp"

#include <gmock/gmock.h>

#include "sim/world/simulation.hpp"

namespace adit::sim {
namespace {

std::shared_ptr<const World> plain() {
  const std::array<Box, 1> boxes{Box{-20, -19.8, -20, 20, 0, 3}};
  return std::make_shared<const World>(*make_box_world(boxes, 0, 3));
}

Simulation with(std::vector<PersonSpec> people, Pose2 robot = {0, 0, 0}) {
  SimulationParams params;
  params.lidar = LidarParams::planar();
  params.lidar.range_noise = 0.0;
  params.people = std::move(people);
  auto simulation = Simulation::create(plain(), {{"r1", Platform{}, robot}}, params);
  EXPECT_TRUE(simulation) << simulation.error().text;
  return std::move(simulation).value();
}

double x(const Simulation& s) { return s.people()[0].body().pose.x; }

TEST(Person, WalksThereAndBack) {
  Simulation s = with({{{{5, 5}, {8, 5}}, 1.0}});
  for (int n = 0; n < 200; ++n) s.step();
  EXPECT_NEAR(x(s), 7.0, 1e-9);
  for (int n = 0; n < 200; ++n) s.step();
  EXPECT_NEAR(x(s), 7.0, 1e-9) << "on the way back";
  for (int n = 0; n < 300; ++n) s.step();
  EXPECT_NEAR(x(s), 6.0, 1e-9) << "and there again";
}

TEST(Person, WaitsBeforeARobotThatStands) {
  Simulation s = with({{{{5, 0}, {-5, 0}}, 1.5}});
  for (int n = 0; n < 1000; ++n) s.step();
  EXPECT_GT(x(s), 0.0);
  EXPECT_EQ(s.truth(0).collisions, 0u);
  EXPECT_NEAR(s.truth(0).min_clearance, Person::kRespect, 0.05) << "and it is near";
}

TEST(Person, IsHitByARobotThatDoesNotLook) {
  Simulation s = with({{{{2, 0}, {2, 0.01}}, 0.01}});
  for (int n = 0; n < 300; ++n) {
    s.command(0, {1, 0, 0});
    s.step();
  }
  EXPECT_EQ(s.truth(0).collisions, 1u);
  ASSERT_EQ(s.collisions().size(), 1u);
  EXPECT_EQ(s.collisions()[0].partner, "a person");
}

void run(Simulation& s, double seconds, const Twist2& velocity = {}) {
  for (int n = 0; n < 100 * seconds; ++n) {
    s.command(0, velocity);
    s.step();
  }
}

TEST(Person, WithoutYieldingCausesTheContactWithAStationaryRobot) {
  Simulation s = with({{{{5, 0}, {-5, 0}}, 1.5, false}});
  run(s, 4);
  ASSERT_EQ(s.collisions().size(), 1u) << "he leans on it, once";
  EXPECT_FALSE(s.collisions()[0].caused);
  EXPECT_TRUE(s.collisions()[0].by_partner);
  EXPECT_EQ(s.truth(0).collisions, 1u);
  EXPECT_EQ(s.truth(0).caused, 0u);
  EXPECT_EQ(s.truth(0).min_clearance, 0.0);
  EXPECT_NEAR(x(s), 0.3 + Person::kSize / 2, 0.02) << "he does not pass through it";
}

TEST(Person, CatchingUpWithARobotCausesTheContact) {
  Simulation s = with({{{{5, 0}, {-15, 0}}, 1.5, false}});
  run(s, 10, {-0.8, 0, 0});
  ASSERT_GE(s.collisions().size(), 1u);
  for (const Collision& contact : s.collisions()) {
    EXPECT_FALSE(contact.caused);
    EXPECT_TRUE(contact.by_partner);
  }
}

TEST(Person, AndARobotThatComesTowardsHimBothCauseIt) {
  Simulation s = with({{{{5, 0}, {-5, 0}}, 1.5, false}});
  run(s, 3, {0.5, 0, 0});
  ASSERT_EQ(s.collisions().size(), 1u);
  EXPECT_TRUE(s.collisions()[0].caused);
  EXPECT_TRUE(s.collisions()[0].by_partner);
  EXPECT_EQ(s.truth(0).caused, 1u);
}

TEST(Person, IsHitByARobotThatTurnsIntoHim) {
  // Beside the robot, out of its way unless it turns: the corners reach 0.39 m.
  Simulation s = with({{{{0, 0.56}, {0.001, 0.56}}, 0.001, false}});
  run(s, 2, {0, 0, 1});
  ASSERT_GE(s.collisions().size(), 1u);
  EXPECT_TRUE(s.collisions()[0].caused);
  EXPECT_FALSE(s.collisions()[0].by_partner);
}

TEST(Person, RunningIntoTheSideOfAPassingRobotCausesTheContact) {
  Simulation s = with({{{{2, 3}, {2, -3}}, 1.5, false}}, {0.3, 0, 0});
  run(s, 4, {1, 0, 0});
  ASSERT_GE(s.collisions().size(), 1u);
  EXPECT_FALSE(s.collisions()[0].caused) << "its way led past him";
}

TEST(Person, IsSeen) {
  Simulation s = with({{{{3, 0}, {3, 0.01}}, 0.01}});
  float nearest = 100.0f;
  for (const Eigen::Vector3f& p : s.scan(0).compute())
    if (std::abs(p.y()) < 0.1f && p.x() > 0) nearest = std::min(nearest, p.x());
  EXPECT_NEAR(nearest, 3.0 - Person::kSize / 2, 0.02);
}

TEST(Person, WithoutAPathIsAnError) {
  SimulationParams params;
  params.people = {{{{1, 1}}, 1.0}};
  EXPECT_EQ(Simulation::create(plain(), {}, params).reason(), Reason::bad_argument);
  params.people = {{{{1, 1}, {2, 2}}, -1.0}};
  EXPECT_EQ(Simulation::create(plain(), {}, params).reason(), Reason::bad_argument);
}

}  // namespace
}  // namespace adit::sim
