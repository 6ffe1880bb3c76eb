// SPDX-License-Identifier: Apache-2.0
// Robots among people and other robots in the simulated world, and in worlds where nothing moves.
#include <gtest/gtest.h>

#include "sim/world/generate.hpp"
#include "tests/folders/folders.hpp"
#include "tests/nav/sim_drive.hpp"

namespace adit::nav::test {
namespace {

sim::SimulationParams planar(std::uint64_t seed, std::vector<sim::PersonSpec> people = {}) {
  sim::SimulationParams params;
  params.lidar = sim::LidarParams::planar();
  params.seed = seed;
  params.people = std::move(people);
  return params;
}

/// 40 m long, along x, its middle at y = 0.
std::shared_ptr<const sim::World> corridor(double width) {
  const double y = width / 2;
  const std::array<sim::Box, 4> walls{sim::Box{-4, 36, y, y + 0.2, 0, 2},
                                      sim::Box{-4, 36, -y - 0.2, -y, 0, 2}, sim::Box{-4.2, -4, -y, y, 0, 2},
                                      sim::Box{36, 36.2, -y, y, 0, 2}};
  return std::make_shared<const sim::World>(*sim::make_box_world(walls, 0, 3));
}

void expect_none_caused(const SimDrive& d, std::uint64_t seed) {
  for (const sim::Collision& contact : d.simulation.collisions())
    EXPECT_FALSE(contact.caused) << "seed " << seed << ": " << contact.robot << " ran into "
                                 << contact.partner << " at " << seconds(contact.at) << " s";
}

class StaticWorld : public testing::TestWithParam<const char*> {};

TEST_P(StaticWorld, FindsNoMoverInAnyDrive) {
  for (const bool full : {false, true}) {
    const auto made = sim::generate_world(GetParam(), full ? 2 : 1).value();
    const auto world = std::make_shared<const sim::World>(*sim::make_box_world(made.boxes, 0, 3));
    sim::SimulationParams params = planar(3);
    if (full) params.lidar = {};
    SimDrive d(world, {{"r1", wheeled(), {made.start.x(), made.start.y(), 0}}}, params);
    for (const double part : {0.7, 0.3}) {
      d.robots[0].goal = Eigen::Vector2d(part * made.size.x(), part * made.size.y());
      d.drive(full ? 8 : 25);
    }
    EXPECT_GT(d.simulation.truth(0).distance, 5.0);
    EXPECT_EQ(d.robots[0].moving, 0u) << (full ? "16 rings" : "one ring");
  }
}

INSTANTIATE_TEST_SUITE_P(All, StaticWorld, testing::Values("corridor", "cave", "rubble", "rooms", "car_park"),
                         [](const auto& each) { return std::string(each.param); });

TEST(Moving, TwoRobotsReachTheirGoalsAmongYieldingPeopleWithoutContact) {
  for (std::uint64_t seed = 1; seed <= seeds(1, 4); ++seed) {
    SimDrive d(
        corridor(4.0), {{"r1", wheeled(), {0, 0, 0}}, {"r2", wheeled(), {30, 0, M_PI}}},
        planar(seed,
               {{{{8, -1.5}, {8, 1.5}}, 1.5}, {{{12, 1.5}, {19, -1.5}}, 1.2}, {{{28, 1.3}, {3, 1.3}}, 1.5}}));
    d.robots[0].goal = Eigen::Vector2d(29, -0.8);
    d.robots[1].goal = Eigen::Vector2d(1, -0.8);
    EXPECT_TRUE(d.drive(120)) << seed;
    EXPECT_TRUE(d.simulation.collisions().empty()) << seed;
  }
}

TEST(Moving, RobotCausesNoContactWithPeopleWhoDoNotYield) {
  for (std::uint64_t seed = 1; seed <= seeds(1, 4); ++seed) {
    SimDrive d(corridor(4.0), {{"r1", wheeled(), {0, 0, 0}}},
               planar(seed, {{{{24, 0.2}, {-3, -0.2}}, 1.5, false}, {{{20, -1.2}, {2, 1.2}}, 1.2, false}}));
    d.robots[0].goal = Eigen::Vector2d(25, 0);
    d.drive(60);
    EXPECT_GT(d.simulation.truth(0).distance, 5.0) << seed;
    expect_none_caused(d, seed);
  }
}

TEST(Moving, RobotsHeadOnPassEachOther) {
  struct Case {
    double width;
    Platform a, b;
  };
  for (const Case& c : {Case{4.0, wheeled(), wheeled()},
                        {2.2, wheeled(), wheeled()},
                        {2.2, wheeled(), legged()},
                        {2.4, tracked(), tracked()}})
    for (std::uint64_t seed = 1; seed <= seeds(1, 3); ++seed) {
      SimDrive d(corridor(c.width), {{"r1", c.a, {0, 0, 0}}, {"r2", c.b, {16, 0, M_PI}}}, planar(seed));
      d.robots[0].goal = Eigen::Vector2d(15.5, 0);
      d.robots[1].goal = Eigen::Vector2d(0.5, 0);
      EXPECT_TRUE(d.drive(80)) << c.width << " m, " << c.a.name << " and " << c.b.name << ", seed " << seed;
      EXPECT_TRUE(d.simulation.collisions().empty()) << c.width << " m, seed " << seed;
    }
}

}  // namespace
}  // namespace adit::nav::test
