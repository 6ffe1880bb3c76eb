// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/map_keeper.hpp"

#include <gtest/gtest.h>

#include "core/exec/virtual_runtime.hpp"
#include "core/transfer/receiver.hpp"
#include "core/transfer/sender.hpp"
#include "perception/stream/piece.hpp"
#include "tests/agent/map_bench.hpp"

namespace adit::agent {
namespace {

/// A map component and its keeper, beside a wall 3 m in front of the start.
class MapKeeperTest : public testing::Test {
 protected:
  MapKeeperTest() { restart(); }
  ~MapKeeperTest() override { stop(); }
  void stop() {
    if (part) part->stop();
    part.reset();
  }
  void restart() {
    stop();
    part = std::make_unique<MapPart>(MapParams{}, *strand, Log{}, service);
    EXPECT_TRUE(part->start().ok());
  }
  /// Occupied voxels farther and nearer than 2.5 m.
  static std::pair<int, int> count_occupied(const MapStep& step) {
    int far = 0, near = 0;
    for (const perception::CoarseBlock& block : step.blocks)
      for (int z = 0; z < perception::CoarseBlock::kEdge; ++z)
        for (int y = 0; y < perception::CoarseBlock::kEdge; ++y)
          for (int x = 0; x < perception::CoarseBlock::kEdge; ++x)
            if (block.at(x, y, z) == perception::Voxel::occupied)
              ++(0.8 * block.index.x + 0.2 * x > 2.5 ? far : near);
    return {far, near};
  }
  /// Offers a scan at x; returns whether it enters the map.
  bool scan(double x, std::uint32_t odom_epoch = 0) {
    auto points = std::make_shared<Scan>();
    points->body = points->located = Pose3::level({x, 0, 0}, 0);
    for (double y = -2; y <= 2; y += 0.05)
      for (double z = 0; z <= 1; z += 0.1)
        points->points.emplace_back(static_cast<float>(3 + std::floor(x / 5) * 5 - x), static_cast<float>(y),
                                    static_cast<float>(z));
    const auto job = keeper.job(points, {}, odom_epoch, strand->now());
    if (!job) return false;
    frame.odom_epoch = odom_epoch;
    service.call(*strand, job, {.deadline = 2s},
                 [this](const Result<MapStep>& step) { keeper.taken(step, frame); });
    run(100ms);
    return true;
  }
  void run(Duration span) { scheduler.run_until(scheduler.elapsed() + span); }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Strand> strand{machine->strand("map")};
  MapService service{"map insertion", 2};
  MapKeeper keeper{{.robot = "r1", .seed = 3, .origin = {0, 0, 0.5}}};
  MapFrame frame{};
  std::unique_ptr<MapPart> part{};
};

TEST_F(MapKeeperTest, ScansEnterTheMapByMotion) {
  EXPECT_TRUE(scan(0.0));
  EXPECT_GT(keeper.blocks(), 10U);
  EXPECT_FALSE(scan(0.1));
  EXPECT_TRUE(scan(0.25));
  run(1s);
  EXPECT_TRUE(scan(0.25)) << "once a second without motion";
  EXPECT_TRUE(scan(0.25, 1)) << "another odometry frame";
}

TEST_F(MapKeeperTest, DustIsNoObstacleInIt) {
  auto cloud = std::make_shared<Scan>();
  for (int n = 0; n < 40; ++n) cloud->points.emplace_back(3.0F, -2.0F + 0.1F * static_cast<float>(n), 0.5F);
  cloud->isolated.assign(cloud->points.size(), 0);
  for (std::size_t n = 0; n < cloud->points.size(); n += 4) {
    cloud->points[n].x() = 1.5F;
    cloud->isolated[n] = 1;
  }
  auto job = std::make_shared<MapJob>();
  job->scan = cloud;
  job->origin = {0, 0, 0.5F};
  std::optional<MapStep> step;
  service.call(*strand, job, {.deadline = 2s}, [&](const Result<MapStep>& done) { step = done.value(); });
  run(100ms);
  ASSERT_TRUE(step);
  const auto [wall, dust] = count_occupied(*step);
  EXPECT_GT(wall, 10);
  EXPECT_EQ(dust, 0);
}

TEST_F(MapKeeperTest, WhatMovesIsNoObstacleInIt) {
  // Someone walks before a wall.
  auto cloud = std::make_shared<Scan>();
  for (int n = 0; n < 40; ++n) cloud->points.emplace_back(3.0F, -2.0F + 0.1F * static_cast<float>(n), 0.5F);
  for (int n = 0; n < 8; ++n) cloud->points.emplace_back(1.5F, 0.5F + 0.05F * static_cast<float>(n), 0.8F);
  // The body is elsewhere in its frame, and turned to the left.
  cloud->body = Pose3::level({10, 5, M_PI / 2}, 0);
  cloud->movers = {{9.3F, 6.6F, 0.5F}};
  EXPECT_EQ(cloud->lasting().size(), 40U);
  cloud->isolated.assign(cloud->points.size(), 0);
  cloud->isolated[3] = 1;
  EXPECT_EQ(cloud->lasting().size(), 39U) << "dust does not last, too";
  auto job = std::make_shared<MapJob>();
  job->scan = cloud;
  job->origin = {0, 0, 0.5};
  std::optional<MapStep> step;
  service.call(*strand, job, {.deadline = 2s}, [&](const Result<MapStep>& done) { step = done.value(); });
  run(100ms);
  ASSERT_TRUE(step);
  const auto [wall, mover] = count_occupied(*step);
  EXPECT_GT(wall, 10);
  EXPECT_EQ(mover, 0);
}

TEST_F(MapKeeperTest, RaysOfASecondLidarBeginWhereItIs) {
  // A plate between the first lidar and the wall that the second one sees.
  const auto scan_of = [](bool plate) {
    auto cloud = std::make_shared<Scan>();
    for (int n = 0; plate && n < 20; ++n)
      cloud->points.emplace_back(0.0F, -0.5F + 0.05F * static_cast<float>(n), 0.5F);
    cloud->parts = {{{-0.5, 0, 0.5}, cloud->points.size()}, {{0.5, 0, 0.5}, 40}};
    for (int n = 0; n < 40; ++n) cloud->points.emplace_back(3.0F, -2.0F + 0.1F * static_cast<float>(n), 0.5F);
    return cloud;
  };
  int plates = 0;
  for (int n = 0; n < 20; ++n) {
    auto job = std::make_shared<MapJob>();
    job->scan = scan_of(n < 3);
    job->origin = {-0.5, 0, 0.5};
    std::optional<MapStep> step;
    service.call(*strand, job, {.deadline = 2s}, [&](const Result<MapStep>& done) { step = done.value(); });
    run(100ms);
    ASSERT_TRUE(step);
    plates = count_occupied(*step).second;
  }
  EXPECT_GE(plates, 5);
}

TEST_F(MapKeeperTest, ALongWayMakesSeveralSubmaps) {
  for (double x = 0; x < 40; x += 0.5) EXPECT_TRUE(scan(x));
  EXPECT_EQ(keeper.submaps(), 3U);
}

TEST_F(MapKeeperTest, AnOdometryFrameHasSubmapsOfItsOwn) {
  EXPECT_TRUE(scan(0.0));
  EXPECT_TRUE(scan(0.5, 1));
  EXPECT_EQ(keeper.submaps(), 2U);
}

TEST_F(MapKeeperTest, TheMapSurvivesARestartOfTheComponent) {
  EXPECT_TRUE(scan(0.0));
  const std::size_t blocks = keeper.blocks();
  restart();
  EXPECT_TRUE(scan(0.5));
  EXPECT_EQ(keeper.submaps(), 2U);
  EXPECT_GT(keeper.blocks(), blocks);
}

TEST_F(MapKeeperTest, GoesOnWhenTheComponentDoesNotAnswer) {
  stop();
  EXPECT_TRUE(scan(0.0));
  run(1s);
  restart();
  EXPECT_TRUE(scan(0.5));
  EXPECT_EQ(keeper.submaps(), 1U);
  EXPECT_GT(keeper.blocks(), 0U);
}

TEST_F(MapKeeperTest, SendsBlocksAndPosesToAStationAndPosesAgainAfterACorrection) {
  EXPECT_TRUE(scan(0.0));
  transfer::Receiver receiver;
  transfer::Sender sender({.session = 7});
  for (transfer::Source* source : keeper.sources()) sender.add(*source);
  std::map<std::uint32_t, Pose3> poses;
  std::map<perception::BlockIndex, perception::CoarseBlock> blocks;
  const auto find_stored = [&](const perception::SubmapKey&, const perception::BlockIndex& index) {
    const auto found = blocks.find(index);
    return found != blocks.end() ? std::optional(found->second) : std::nullopt;
  };
  const auto exchange = [&](Duration span) {
    for (const Time end = strand->now() + span; strand->now() < end; run(50ms)) {
      keeper.follow(frame);
      for (const transfer::Piece& piece : sender.due(strand->now(), {})) {
        receiver.take("r1", sender.session(), piece.id, strand->now());
        if (piece.kind == transfer::Kind::map_poses) {
          const auto decoded = perception::decode_poses(piece.data);
          for (const auto& pose : decoded.value().poses) poses[pose.key.index] = pose.T_map_submap;
        } else {
          const auto decoded = perception::decode(piece.data, find_stored);
          for (const auto& update : decoded.value().blocks) blocks[update.block.index] = update.block;
        }
      }
      if (const auto due = receiver.due(strand->now(), 20e6)) {
        transfer::Ack ack{{1}, 1, {}};
        if (!due->empty()) ack.receipt = due->front().second;
        sender.acknowledged(ack, strand->now());
        keeper.heard(ack);
      }
    }
  };
  exchange(5s);
  EXPECT_EQ(blocks.size(), keeper.blocks());
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_NEAR(poses.at(0).position.x(), 0.0, 0.01);
  frame.T_map_odom = Pose3::level({7, 1, 0.2}, 0.5);
  ++frame.map_epoch;
  exchange(5s);
  EXPECT_NEAR(poses.at(0).position.x(), 7.0, 0.01);
  EXPECT_NEAR(poses.at(0).position.z(), 0.5, 0.01);
  EXPECT_NEAR(poses.at(0).yaw(), 0.2, 0.001);
  const auto place = keeper.place_in_submap({9.0, 1.0, 1.5});
  ASSERT_TRUE(place);
  EXPECT_NEAR((poses.at(place->index) * place->offset - Eigen::Vector3d(9.0, 1.0, 1.5)).norm(), 0.0, 0.02);
  EXPECT_NEAR(place->yaw, 0.2, 0.001);
  const auto pose = keeper.submap_pose(place->start, place->index);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->position.x(), 7.0, 0.01);
  EXPECT_FALSE(keeper.submap_pose(place->start, place->index + 1));
}

/// How many blocks of the first piece of blocks lie near a point of the map, for a station that lacks all.
std::size_t sent_first_near(const Eigen::Vector3d& point, bool look_ahead) {
  MapBench bench;
  bench.frame.T_map_odom = Pose3::level({100, 50}, 1.0);
  bench.drive(0, 200);
  MapBench::Station station;
  bench.sender->acknowledged({station.id, station.start, {}}, bench.strand->now());
  EXPECT_TRUE(bench.keeper->is_behind());
  if (look_ahead) bench.keeper->look_ahead(std::vector{point});
  const wire::LinkProfile thin{.name = "mesh_100k", .bandwidth = 100e3};  // With small pieces.
  const wire::SenderState link{.link = &thin};
  std::size_t near = 0;
  for (int rounds = 0; station.blocks.empty() && rounds < 100; ++rounds) {
    for (const transfer::Piece& piece : bench.sender->due(bench.strand->now(), link))
      if (station.blocks.empty()) bench.hear(station, piece);
    bench.run(50ms);
  }
  for (const auto& [key, blocks] : station.blocks)
    for (const auto& [index, update] : blocks) {
      const Eigen::Vector3d in_submap = (Eigen::Vector3d(index.x, index.y, index.z).array() + 0.5) * 0.8;
      near += (station.poses.at(key).T_map_submap * in_submap - point).norm() < 5.0 ? 1 : 0;
    }
  return near;
}

TEST(MapFocus, AStationThatLacksMuchGetsWhatIsAheadOfTheRobotFirst) {
  const Eigen::Vector3d point = Pose3::level({100, 50}, 1.0) * Eigen::Vector3d(60, 0, 0);
  const std::size_t without = sent_first_near(point, false), with = sent_first_near(point, true);
  EXPECT_GT(with, 2 * without) << with << " " << without;
}

}  // namespace
}  // namespace adit::agent
