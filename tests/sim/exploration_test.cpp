// SPDX-License-Identifier: Apache-2.0
// What robots truly saw of a world.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/truth/exploration_record.hpp"
#include "sim/world/generate.hpp"

namespace adit::sim {
namespace {

Platform with_lidar() {
  Platform out;
  out.lidar_height = 0.75;
  return out;
}

std::shared_ptr<const World> world_of(std::span<const Box> boxes) {
  return std::make_shared<World>(make_box_world(boxes, 0.0, 3.0).value());
}

/// A room of 10 x 6 m without a way out, beside one that no robot can enter.
std::shared_ptr<const World> two_rooms() {
  return world_of(std::vector<Box>{{-0.3, 20.3, -0.3, 0, 0, 3},
                                   {-0.3, 20.3, 6, 6.3, 0, 3},
                                   {-0.3, 0, 0, 6, 0, 3},
                                   {20, 20.3, 0, 6, 0, 3},
                                   {10, 10.3, 0, 6, 0, 3}});
}

ExplorationTruth truth_of(const std::shared_ptr<const World>& world, std::vector<Pose2> starts) {
  std::vector<ExplorationRobot> robots;
  for (const Pose2& start : starts) robots.push_back({with_lidar(), start});
  return ExplorationTruth::create(world, robots).value();
}

TEST(ExplorationTruth, CountsTheCellsThatTaresYardstickCounts) {
  // Counted by the program that measured TARE, for a lidar of 16 beams at 0.75 m (docs/references.md).
  EXPECT_EQ(truth_of(world_of(generate_blocks(3, 0).boxes), {{1.6, 1.6, 0}}).possible(), 20706u);
}

TEST(ExplorationTruth, ARoomThatNobodyCanEnterDoesNotCount) {
  auto truth = truth_of(two_rooms(), {{5, 3, 0}});
  EXPECT_LE(truth.possible(), 20u * 12u * 6u);
  EXPECT_GT(truth.possible(), 20u * 12u * 5u) << "all of the room but what is under and over the lidar";
  EXPECT_EQ(truth.share(ExplorationArea{10.5, 0, 20, 6}, {}), 1.0) << "nothing can be seen there";
}

TEST(ExplorationTruth, SeesVoxelsThatRaysPassWithinTwelveMetres) {
  const auto corridor = world_of(std::vector<Box>{{-0.3, 40.3, -0.3, 0, 0, 3},
                                                  {-0.3, 40.3, 3, 3.3, 0, 3},
                                                  {-0.3, 0, 0, 3, 0, 3},
                                                  {40, 40.3, 0, 3, 0, 3}});
  auto truth = truth_of(corridor, {{1.6, 1.6, 0}, {38.4, 1.6, 0}});
  EXPECT_EQ(truth.share(), 0.0);
  truth.look(0, Pose3::level({1.6, 1.6, 0}, 0));
  const std::size_t first = 0, second = 1;
  EXPECT_EQ(truth.share(ExplorationArea{14.1, 0, 40, 3}, {}), 0.0) << "farther than 12 m away";
  EXPECT_GT(truth.share(ExplorationArea{4, 0, 13, 3}, {}), 0.8);
  const double one = truth.share();
  EXPECT_GT(one, 0.2);
  EXPECT_LT(one, 0.4);
  truth.look(1, Pose3::level({38.4, 1.6, 0}, 0));
  EXPECT_NEAR(truth.share({}, std::span(&first, 1)), one, 1e-9);
  EXPECT_NEAR(truth.share({}, std::span(&second, 1)), one, 0.05);
  EXPECT_EQ(truth.overlap(), 0.0);
  truth.look(1, Pose3::level({1.6, 1.6, 0}, 0));
  EXPECT_NEAR(truth.overlap(), 0.5, 0.05) << "the half that the first robot saw";
}

TEST(ExplorationTruth, ALeaningLidarSeesOtherCells) {
  auto level = truth_of(two_rooms(), {{5, 3, 0}}), leaning = level;
  level.look(0, Pose3::level({5, 3, 0}, 0));
  Pose3 pose = Pose3::level({5, 3, 0}, 0);
  pose.orientation = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX());
  leaning.look(0, pose);
  leaning.look(0, Pose3::level({5, 3, 0}, 0));
  EXPECT_GT(leaning.seen(), level.seen());
}

TEST(ExplorationTruth, RefusesAWorldWithoutAStart) {
  EXPECT_EQ(ExplorationTruth::create(two_rooms(), {}).reason(), Reason::bad_argument);
}

TEST(ExplorationRecord, RecordsWhenEachShareWasReached) {
  ExplorationRecord record(truth_of(two_rooms(), {{1, 3, 0}}), 1);
  for (int n = 0; n <= 40; ++n) {
    const Pose3 pose = Pose3::level({1 + 0.2 * n, 3, 0}, 0);
    record.add(0.2 * n, std::span(&pose, 1));
  }
  const ExplorationResult result = record.result();
  ASSERT_TRUE(result.reached.front()) << "half of it";
  EXPECT_EQ(result.reached.front()->time_s, 0.0) << "seen from where it starts";
  EXPECT_GT(result.share, 0.9);
  EXPECT_NEAR(result.metres, 8.0, 1e-9);
  EXPECT_EQ(result.curve.size(), 9u) << "once a second";
}

TEST(RepeatedWay, CountsMetresDrivenAgainLater) {
  RepeatedWay way(2);
  double time = 0;
  const auto drive = [&](std::size_t robot, double from, double to) {
    for (int n = 0; n <= 100; ++n, time += 0.2) way.add(robot, time, {from + (to - from) * n / 100, 0});
  };
  drive(0, 0, 20);
  EXPECT_EQ(way.share(), 0.0) << "its own track of just now";
  drive(0, 20, 0);
  // It turned at 20 m: what it drove in the last 10 s is 10 m long, and 1.5 m are near.
  EXPECT_NEAR(way.metres(), 40.0, 1e-9);
  EXPECT_NEAR(way.share(), (20 - 5 + 0.75) / 40, 0.02);
  drive(1, 0, 20);
  EXPECT_GT(way.share(), 0.55) << "another robot's track counts too";
}

TEST(GeneratedBlocks, AreTheWorldsOfTaresRunsAndOthersBySeed) {
  const auto three = generate_blocks(3, 0), five = generate_blocks(5, 0);
  EXPECT_EQ(three.boxes.size(), 9u + 4 + 10);
  EXPECT_EQ(five.boxes.size(), 25u + 4 + 10);
  EXPECT_DOUBLE_EQ(three.size.x(), 36.8);
  EXPECT_DOUBLE_EQ(five.size.x(), 59.2);
  EXPECT_EQ(three.boxes.back(), (Box{20.577, 21.077, 22.650, 23.150, 0, 0.9}));
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto made = generate_blocks(3, seed);
    EXPECT_EQ(made.boxes, generate_blocks(3, seed).boxes);
    EXPECT_NE(made.boxes, three.boxes);
    EXPECT_TRUE(make_box_world(made.boxes, 0, 3));
  }
}

}  // namespace
}  // namespace adit::sim
