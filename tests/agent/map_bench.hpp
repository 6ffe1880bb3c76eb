// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <utility>

#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "core/transfer/receiver.hpp"
#include "core/transfer/sender.hpp"
#include "perception/stream/piece.hpp"
#include "robot_agent/perception/map_keeper.hpp"

namespace adit::agent {

/// A robot's map with a disk, and one station, on virtual time. The robot drives along a wall.
struct MapBench {
  struct Station {
    transfer::PeerId id{1};
    std::uint32_t start{1};
    transfer::Receiver receiver{};
    std::map<perception::SubmapKey, std::map<perception::BlockIndex, perception::BlockUpdate>> blocks{};
    std::map<perception::SubmapKey, perception::SubmapPose> poses{};
    std::size_t received{};  ///< Blocks, with repeats.
  };

  /// `computes`: pieces are encoded by `compute`, as on a robot.
  explicit MapBench(std::string robot = "r1", MapDiskParams disk_params = {}, BlockSourceParams blocks = {},
                    bool computes = false)
      : disk_params_(std::move(disk_params)),
        block_params_(std::move(blocks)),
        computes_(computes),
        name(std::move(robot)) {
    restart();
  }
  ~MapBench() {
    if (part) part->stop();
  }

  /// Starts the agent again; what was not written is lost.
  void restart() {
    if (part) part->stop();
    part = std::make_unique<MapPart>(MapParams{}, *strand, Log{}, service);
    EXPECT_TRUE(part->start().ok());
    keeper.reset();
    MapDiskParams params = disk_params_;
    params.robot = name;
    keeper = std::make_unique<MapKeeper>(
        MapKeeperParams{.robot = name, .seed = ++seed, .origin = {0, 0, 0.5}, .blocks = block_params_},
        std::make_unique<MapDisk>(params, disk, *strand, nullptr,
                                  [this](bool fails, const std::string& text) {
                                    failing = fails;
                                    reported = text;
                                  }));
    if (computes_) keeper->encode_on(*strand, [] {});
    loaded = keeper->load();
    sender = std::make_unique<transfer::Sender>(
        transfer::SenderParams{.session = static_cast<std::uint32_t>(seed)});
    for (transfer::Source* source : keeper->sources()) sender->add(*source);
  }
  void scan(double x) {
    auto points = std::make_shared<Scan>();
    points->body = points->located = Pose3::level({x, 0, 0}, 0);
    for (double along = -4; along <= 4; along += 0.2)
      for (double z = 0; z <= 2; z += 0.2)
        points->points.emplace_back(static_cast<float>(along), 3.0F, static_cast<float>(z));
    const auto job = keeper->job(points, {}, frame.odom_epoch, strand->now());
    ASSERT_TRUE(job);
    service.call(*strand, job, {.deadline = 2s},
                 [this](const Result<MapStep>& step) { keeper->taken(step, frame); });
    run(100ms);
  }
  void drive(double from, double to) {
    const double step = to > from ? 1.0 : -1.0;
    for (double x = from; (to - x) * step > 0; x += step) scan(x);
  }
  /// Lets time pass; `station` hears the robot meanwhile.
  void run(Duration span, Station* station = nullptr) {
    for (const Time end = strand->now() + span; strand->now() < end;
         scheduler.run_until(scheduler.elapsed() + 50ms)) {
      keeper->follow(frame);
      keeper->tick(strand->now());
      const auto pieces = sender->due(strand->now(), {});
      if (station == nullptr) continue;
      for (const transfer::Piece& piece : pieces) hear(*station, piece);
      if (const auto due = station->receiver.due(strand->now(), 20e6)) {
        transfer::Ack ack{station->id, station->start, {}};
        if (!due->empty()) ack.receipt = due->front().second;
        if (sender->acknowledged(ack, strand->now())) keeper->heard(ack);
      }
    }
  }
  void hear(Station& station, const transfer::Piece& piece) {
    station.receiver.take(name, sender->session(), piece.id, strand->now());
    if (piece.kind == transfer::Kind::map_poses) {
      const auto decoded = perception::decode_poses(piece.data);
      for (const auto& pose : decoded.value().poses) {
        auto& known = station.poses[pose.key];
        if (pose.revision > known.revision) known = pose;
      }
      return;
    }
    const auto decoded = perception::decode(
        piece.data, [&](const auto& key, const auto& index) -> std::optional<perception::CoarseBlock> {
          const auto known = station.blocks[key].find(index);
          return known != station.blocks[key].end() ? std::optional(known->second.block) : std::nullopt;
        });
    ASSERT_TRUE(decoded.ok()) << decoded.error().text;
    for (const auto& update : decoded.value().blocks) {
      ++station.received;
      auto& known = station.blocks[decoded->key][update.block.index];
      if (update.revision > known.revision) known = update;
    }
  }

  MapDiskParams disk_params_;
  BlockSourceParams block_params_;
  bool computes_;
  std::string name;
  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Strand> strand{machine->strand("map")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  MapService service{"map insertion", 2};
  MapFrame frame{};
  std::uint64_t seed{2};
  LoadedMap loaded{};
  bool failing{false};
  std::string reported{};
  std::unique_ptr<MapKeeper> keeper{};
  std::unique_ptr<transfer::Sender> sender{};
  std::unique_ptr<MapPart> part{};
};

}  // namespace adit::agent
