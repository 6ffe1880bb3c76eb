// SPDX-License-Identifier: Apache-2.0
#include "sim/world/simulation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/sim/scratch.hpp"
#include "tests/sim/wheeled.hpp"

namespace adit::sim {
namespace {

std::shared_ptr<const World> hall() {  // walls at x = 5 and y = 3
  const std::array<Box, 2> boxes{Box{5, 5.2, -3, 3.2, 0, 3}, Box{-5, 5.2, 3, 3.2, 0, 3}};
  return std::make_shared<const World>(*make_box_world(boxes, 0, 3));
}

Simulation make(std::vector<RobotStart> robots, std::uint64_t seed = 1) {
  SimulationParams params;
  params.seed = seed;
  auto simulation = Simulation::create(hall(), std::move(robots), params);
  EXPECT_TRUE(simulation) << simulation.error().text;
  return std::move(simulation).value();
}

void drive(Simulation& simulation, std::size_t robot, const Twist2& wanted, double time) {
  for (int n = 0; n < std::lround(time / 0.01); ++n) {
    simulation.command(robot, wanted);
    simulation.step();
  }
}

/// Ranges that the ring of a robot at the origin shows straight ahead, m.
double ahead(const Box& box, std::vector<RobotStart> others = {}) {
  SimulationParams params;
  params.lidar = LidarParams::planar();
  params.lidar.range_noise = 0.0;
  others.insert(others.begin(), {"r1", wheeled(), {0, 0, 0}});
  const auto world = std::make_shared<const World>(*make_box_world(std::array<Box, 1>{box}, 0, 3));
  const auto simulation = Simulation::create(world, std::move(others), params);
  EXPECT_TRUE(simulation) << simulation.error().text;
  for (const Eigen::Vector3f& p : simulation->scan(0).compute())
    if (std::abs(p.y()) < 1e-3 && p.x() > 0) return p.x();
  return 0.0;
}

TEST(Simulation, flying_robot_touches_only_obstacles_at_its_height) {
  Platform flyer = wheeled();
  flyer.name = "aerial";
  flyer.drive = Drive::aerial;
  flyer.height = 0.3;
  flyer.step = 0.0;
  flyer.hover_height = 1.0;
  const std::array<Box, 2> boxes{Box{1, 1.2, -1, 1, 0, 0.8}, Box{4, 4.2, -1, 1, 0, 1.1}};
  const auto world = std::make_shared<const World>(*make_box_world(boxes, 0, 3));
  SimulationParams params;
  auto s = Simulation::create(world, {{"r1", flyer, {0, 0, 0}}, {"r2", wheeled(), {2.5, 0, 0}}}, params);
  ASSERT_TRUE(s) << s.error().text;
  EXPECT_NEAR(s->truth(0).pose.position.z(), 1.0, 1e-6);
  EXPECT_NEAR(s->altitude(0), 1.0, 1e-6);
  EXPECT_EQ(s->altitude(1), 0.0);
  drive(*s, 0, {1, 0, 0}, 3.2);
  EXPECT_TRUE(s->collisions().empty()) << "over the wall and over the other robot";
  EXPECT_GT(s->truth(0).pose.position.x(), 2.0);
  drive(*s, 0, {1, 0, 0}, 2.0);
  ASSERT_EQ(s->collisions().size(), 1u) << "the second wall is as high as it flies";
  EXPECT_EQ(s->collisions()[0].partner, "world");
  drive(*s, 0, {-1, 0, 0}, 0.5);
  drive(*s, 0, {0, 0, 0, 0.5}, 1.0);
  drive(*s, 0, {1, 0, 0}, 2.0);
  EXPECT_EQ(s->collisions().size(), 1u) << "higher up it passes";
  EXPECT_GT(s->truth(0).pose.position.x(), 4.5);
  EXPECT_EQ(s->truth(1).collisions, 0u);
}

TEST(Simulation, a_planar_lidar_sees_what_its_rays_meet) {
  EXPECT_NEAR(ahead({9, 9.5, -1, 1, 0, 3}), 9.0, 1e-3) << "a wall";
  EXPECT_NEAR(ahead({2, 2.5, -1, 1, 0, 0.4}), 2.0, 1e-3) << "lower than the lidar, higher than the step";
  EXPECT_NEAR(ahead({1, 1.5, -1, 1, 0.2, 0.35}), 1.0, 1e-3) << "it hangs";
  EXPECT_EQ(ahead({2, 2.5, -1, 1, 0, 0.05}), 0.0) << "a step that it climbs";
  EXPECT_EQ(ahead({2, 2.5, -1, 1, 0.6, 2.5}), 0.0) << "higher than the lidar";
  EXPECT_EQ(ahead({4.5, 5, -1, 1, 0, 0.1}), 0.0) << "between two rays: no robot knows of it";
  Platform low = wheeled();
  low.height = 0.4;
  EXPECT_NEAR(ahead({9, 9.5, -1, 1, 0, 3}, {{"r2", low, {2.5, 0, 0}}}), 2.2, 1e-3) << "a low robot";
}

TEST(Simulation, each_robot_has_the_lidar_of_its_platform) {
  Platform down = wheeled();
  down.lidar_rings = 8;
  down.lidar_lowest = -60;
  const Simulation s =
      make({{"r1", wheeled(), {-4, 0, 0}}, {"r2", down, {2, 0, 0}}, {"r3", down, {-1, 0, 0}}});
  const auto floor = [&](std::size_t robot) {  // nearest return from it, m
    double nearest = 99;
    for (const Eigen::Vector3f& p : s.scan(robot).compute())
      if (p.z() < 0.1f) nearest = std::min(nearest, double{p.head<2>().norm()});
    return nearest;
  };
  EXPECT_NEAR(floor(0), 0.5 / std::tan(15 * M_PI / 180), 0.15);
  EXPECT_NEAR(floor(1), 0.5 / std::tan(60 * M_PI / 180), 0.1);
  EXPECT_EQ(s.scan(0).lidar->size(), 16u * 900);
  EXPECT_EQ(s.scan(1).lidar->size(), 8u * 900);
  EXPECT_EQ(s.scan(1).lidar, s.scan(2).lidar) << "shared";
}

TEST(Simulation, drives_and_keeps_the_books) {
  Simulation s = make({{"r1", wheeled(), {-4, 0, 0}}});
  drive(s, 0, {1, 0, 0}, 3.0);
  const Truth& truth = s.truth(0);
  EXPECT_NEAR(truth.pose.position.x(), -4 + 3.0 - 0.5 / 1.5, 0.01);
  EXPECT_NEAR(truth.distance, truth.pose.position.x() + 4, 1e-9);
  EXPECT_NEAR(seconds(truth.moving), 3.0, 0.05);
  EXPECT_EQ(truth.collisions, 0u);
  EXPECT_NEAR(truth.min_clearance, 2.75, 0.05) << "the wall at y = 3";
  EXPECT_EQ(s.now(), 3s);
  EXPECT_NEAR(s.odometry(0).pose().x, truth.distance, 0.2);
}

TEST(Simulation, odometry_measures_how_far_the_ground_rose) {
  const std::array<Box, 2> boxes{Box{1, 2, -2, 2, 0, 0.07}, Box{2, 9, -2, 2, 0, 0.14}};
  const auto world = std::make_shared<const World>(*make_box_world(boxes, 0, 3));
  auto s = Simulation::create(world, {{"r1", wheeled(), {0, 0, 0}}}, {});
  ASSERT_TRUE(s) << s.error().text;
  drive(*s, 0, {1, 0, 0}, 4);
  EXPECT_NEAR(s->truth(0).pose.position.z(), 0.14, 1e-6);
  EXPECT_NEAR(s->altitude(0), 0.14, 0.14 * 0.05);
  drive(*s, 0, {-1, 0, 0}, 7);
  EXPECT_NEAR(s->altitude(0), 0.0, 1e-6) << "down again";
}

TEST(Simulation, a_wall_stops_the_body_and_is_recorded_once) {
  Simulation s = make({{"r1", wheeled(), {3, 0, 0}}});
  drive(s, 0, {2, 0, 0}, 4.0);
  EXPECT_LE(s.truth(0).pose.position.x(), 4.7);
  EXPECT_GT(s.truth(0).pose.position.x(), 4.65);
  ASSERT_EQ(s.collisions().size(), 1u);
  EXPECT_EQ(s.collisions()[0].partner, "world");
  EXPECT_GT(seconds(s.collisions()[0].at), 0.9);
  EXPECT_EQ(s.truth(0).min_clearance, 0.0);
  drive(s, 0, {-1, 0, 0}, 1.0);
  EXPECT_LT(s.truth(0).pose.position.x(), 4.2) << "it can back off";
  drive(s, 0, {2, 0, 0}, 2.0);
  EXPECT_EQ(s.truth(0).collisions, 2u) << "a second contact";
}

TEST(Simulation, turning_against_a_wall_is_a_contact) {
  Simulation s = make({{"r1", wheeled(), {4.72, 0, M_PI / 2}}});
  drive(s, 0, {0, 0, 1}, 2.0);
  EXPECT_EQ(s.collisions().size(), 1u);
}

TEST(Simulation, robots_hit_each_other) {
  Simulation s =
      make({{"r1", wheeled(), {0, 0, 0}}, {"r2", wheeled(), {2, 0, 1.2}}, {"r3", wheeled(), {-3, 0, 0}}});
  drive(s, 0, {1, 0, 0}, 4.0);
  ASSERT_EQ(s.collisions().size(), 1u);
  EXPECT_EQ(s.collisions()[0].robot, "r1");
  EXPECT_EQ(s.collisions()[0].partner, "r2");
  EXPECT_TRUE(s.collisions()[0].caused);
  EXPECT_FALSE(s.collisions()[0].by_partner) << "it stood";
  EXPECT_EQ(s.truth(0).caused, 1u);
  EXPECT_EQ(s.truth(1).caused, 0u);
  EXPECT_EQ(s.truth(0).collisions, 1u);
  EXPECT_EQ(s.truth(1).collisions, 1u);
  EXPECT_EQ(s.truth(1).min_clearance, 0.0);
  EXPECT_EQ(s.truth(2).collisions, 0u);
  EXPECT_LT(s.truth(0).pose.position.x(), 1.7);
}

TEST(Simulation, refuses_impossible_starts) {
  const auto error = [](std::vector<RobotStart> robots) {
    auto s = Simulation::create(hall(), std::move(robots), {});
    EXPECT_FALSE(s);
    return s ? Error{} : s.error();
  };
  const Error overlap = error({{"r1", wheeled(), {0, 0, 0}}, {"r2", wheeled(), {0.5, 0.3, 1}}});
  EXPECT_EQ(overlap.reason, Reason::bad_argument);
  EXPECT_EQ(overlap.text, "r2: start at (0.50, 0.30) overlaps r1");
  EXPECT_NE(error({{"r1", wheeled(), {4.9, 0, 0}}}).text.find("wall"), std::string::npos);
  EXPECT_EQ(error({{"r1", wheeled(), {0, 0, 0}}, {"r1", wheeled(), {2, 0, 0}}}).reason, Reason::bad_argument);
  EXPECT_EQ(error({{"r1", wheeled(), {std::nan(""), 0, 0}}}).reason, Reason::bad_argument);
  EXPECT_EQ(Simulation::create(nullptr, {}, {}).reason(), Reason::bad_argument);
}

TEST(Simulation, the_same_seed_gives_the_same_run) {
  const auto play = [](std::uint64_t seed) {
    Simulation s = make({{"r1", wheeled(), {0, 0, 0}}, {"r2", wheeled(), {2, 1, 0}}}, seed);
    drive(s, 0, {0.8, 0, 0.4}, 5.0);
    return std::tuple{s.odometry(0).pose(), s.scan(0).compute(), s.truth(0).pose.planar()};
  };
  EXPECT_TRUE(play(1) == play(1));
  const auto a = play(1), b = play(2);
  EXPECT_FALSE(std::get<0>(a) == std::get<0>(b));
  EXPECT_FALSE(std::get<1>(a) == std::get<1>(b));
  EXPECT_TRUE(std::get<2>(a) == std::get<2>(b)) << "the same commands drive the same way";
}

TEST(Simulation, a_scan_job_keeps_its_moment) {
  Simulation s = make({{"r1", wheeled(), {0, 0, 0}}, {"r2", wheeled(), {2, 0, 0}}});
  const Simulation::ScanJob job = s.scan(0);
  const PointCloud before = job.compute();
  drive(s, 1, {0, 0, 1}, 1.0);
  EXPECT_TRUE(job.compute() == before);
  EXPECT_FALSE(s.scan(0).compute() == before);
  EXPECT_FALSE(s.scan(0).seed == s.scan(1).seed);
}

/// The legs that sim/world/README.md recommends in the building, driven by footprints alone.
TEST(Simulation, the_corridor_of_the_building_is_free) {
  if (building_map().empty()) GTEST_SKIP() << "geb079.bt is not installed; run ./run setup";
  const auto world = load_octomap(building_map());
  ASSERT_TRUE(world) << world.error().text;
  const struct {
    double length, width, step, x0, y0, x1, y1, clearance;
  } legs[] = {{0.6, 0.5, 0.08, -5.2, -0.1, 0.6, -0.1, 0.4},
              {0.6, 0.5, 0.08, 0.6, -0.1, 2.4, -0.35, 0.3},
              {0.8, 0.6, 0.15, 14.0, -0.1, 26.0, -0.1, 0.4},
              {0.9, 0.45, 0.22, 4.8, -0.4, 10.2, -0.4, 0.4},
              {0.6, 0.5, 0.08, 10.4, -0.08, 12.6, -0.08, 0.1}};
  for (const auto& leg : legs) {
    const StandingMap map(*world, 0.5, leg.step);
    const double yaw = std::atan2(leg.y1 - leg.y0, leg.x1 - leg.x0);
    for (double f = 0; f <= 1.0; f += 0.01) {
      const Pose2 at{leg.x0 + f * (leg.x1 - leg.x0), leg.y0 + f * (leg.y1 - leg.y0), yaw};
      ASSERT_GE(map.clearance({at, leg.length, leg.width}), leg.clearance) << at.x << ' ' << at.y;
      ASSERT_NEAR(map.ground(at.x, at.y), 0.0, 0.1) << at.x;
    }
  }
}

}  // namespace
}  // namespace adit::sim
