// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/map_replica.hpp"

#include <gmock/gmock.h>

#include "basestation/map/ground_area.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "core/time/random.hpp"
#include "core/transfer/piece.hpp"

namespace adit::station {
namespace {

class MapReplicaTest : public testing::Test {
 protected:
  MapReplicaTest() { restart(); }
  std::string restart(MapJournalParams params = {}) {
    replica.emplace(
        ++starts, disk, *strand, [this](const std::string& text) { troubles.push_back(text); }, params);
    return replica->load();
  }
  Result<void> take(transfer::Kind kind, const std::vector<std::uint8_t>& data,
                    const std::string& robot = "r1") {
    return replica->take(robot, static_cast<std::uint8_t>(kind), 0, data, [this] { ++stored; });
  }
  /// A piece of a kind that this release does not know.
  void send_unknown() {
    EXPECT_EQ(replica->take("r1", 77, 0, std::vector<std::uint8_t>{1, 2}, [this] { ++stored; }).reason(),
              Reason::not_supported);
  }
  /// Some blocks of a submap, with any revisions.
  void send_blocks(std::uint32_t submap, int count) {
    std::vector<perception::BlockUpdate> blocks;
    for (int i = 0; i < count; ++i) {
      const std::uint64_t known = random.next();
      blocks.push_back({{{static_cast<int>(random.below(40)), static_cast<int>(random.below(40)), 0},
                         known,
                         known & random.next()},
                        static_cast<std::uint32_t>(random.below(100'000))});
    }
    EXPECT_TRUE(take(transfer::Kind::map_blocks,
                     perception::pack({"r1", 5, submap}, blocks, transfer::kMaxPieceBytes).bytes)
                    .ok());
  }
  void send_pose(std::uint32_t submap, double x, std::uint32_t revision, const std::string& robot = "r1") {
    EXPECT_TRUE(take(transfer::Kind::map_poses,
                     perception::encode({{{{robot, 5, submap}, Pose3::level({x, 1, 0.5}, 0.2), revision}}}),
                     robot)
                    .ok());
  }
  std::size_t file_bytes() const { return disk->read(MapJournal::kFile)->value().size(); }
  void run(Duration span) { scheduler.run_until(scheduler.elapsed() + span); }
  using Content = std::map<std::pair<std::uint32_t, perception::BlockIndex>, std::array<std::uint64_t, 3>>;
  Content content() const {
    Content out;
    for (const auto& [name, robot] : replica->chunks().robots())
      for (const auto& [key, submap] : robot.submaps)
        for (const auto& [index, block] : submap.blocks)
          out[{key.index, index}] = {block.known, block.occupied, block.revision};
    return out;
  }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("op1", 5s)};
  std::shared_ptr<Strand> strand{machine->strand("station")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  Random random{4};
  std::uint32_t starts{40};
  int stored{};
  std::vector<std::string> troubles{};
  std::optional<MapReplica> replica{};
};

TEST_F(MapReplicaTest, AStationThatRestartsHasItsMapAndItsStart) {
  const std::uint32_t start = replica->start();
  for (std::uint32_t submap = 0; submap < 5; ++submap) {
    send_pose(submap, submap, 1);
    send_blocks(submap, 60);
  }
  run(1s);
  EXPECT_EQ(stored, 10);
  const Content before = content();
  const double area = ground_area(replica->chunks(), {}).m2;
  EXPECT_EQ(restart(), "");
  EXPECT_EQ(replica->start(), start);
  EXPECT_EQ(content(), before);
  EXPECT_EQ(ground_area(replica->chunks(), {}).m2, area);
  EXPECT_FALSE(replica->chunks().robots().at("r1").heard) << "it was not heard since the start";
}

TEST_F(MapReplicaTest, WhatWasNotAcknowledgedMayBeMissingAfterARestart) {
  send_blocks(0, 10);
  EXPECT_EQ(stored, 0);
  restart();
  EXPECT_TRUE(content().empty());
  run(1s);
  EXPECT_EQ(stored, 0) << "the piece of the start before is not acknowledged";
}

TEST_F(MapReplicaTest, ADamagedFileMakesTheStartANewOneAndKeepsWhatCanBeRead) {
  send_blocks(0, 30);
  run(1s);
  const Content before = content();
  send_blocks(1, 30);
  run(1s);
  store::Bytes bytes = disk->read(MapJournal::kFile)->value();
  bytes[bytes.size() - 20] ^= 1;
  disk->plant(MapJournal::kFile, bytes);
  const std::uint32_t start = replica->start();
  EXPECT_THAT(restart(), testing::HasSubstr("damaged"));
  EXPECT_NE(replica->start(), start);
  EXPECT_EQ(content(), before);
  EXPECT_EQ(restart(), "") << "what was left is a whole file again";
  EXPECT_EQ(content(), before);
}

TEST_F(MapReplicaTest, ALongFileOfOldStatesIsWrittenAgain) {
  for (int n = 0; n < 500; ++n) {
    send_blocks(0, 60);
    if (n % 20 == 0) run(200ms);
  }
  run(1s);
  const Content before = content();
  const std::size_t size = disk->read(MapJournal::kFile)->value().size();
  restart();
  EXPECT_LT(disk->read(MapJournal::kFile)->value().size(), size / 10);
  EXPECT_EQ(content(), before) << "with their revisions";
  const std::uint32_t start = replica->start();
  restart();
  EXPECT_EQ(content(), before);
  EXPECT_EQ(replica->start(), start);
}

TEST_F(MapReplicaTest, ForgetsEverythingAlsoWhileItIsBeingWritten) {
  for (const Duration pause : {0ms, 101ms, 1000ms}) {
    send_blocks(0, 30);
    run(pause);
    const std::uint64_t revision = replica->chunks().revision();
    replica->forget(900);
    EXPECT_TRUE(content().empty());
    EXPECT_GT(replica->chunks().revision(), revision) << "front ends see it";
    run(1s);
    send_pose(3, 1, 1);
    run(1s);
    restart();
    EXPECT_TRUE(content().empty());
    EXPECT_EQ(replica->start(), 900U);
    EXPECT_EQ(replica->chunks().robots().at("r1").submaps.size(), 1U);
  }
}

TEST_F(MapReplicaTest, WhatWasAcknowledgedWithoutBeingUnderstoodEndsTheStart) {
  send_blocks(0, 30);
  run(1s);
  const Content before = content();
  const std::uint32_t start = replica->start();
  send_unknown();
  EXPECT_EQ(stored, 1) << "the disk does not say yet that something is missing";
  run(1s);
  EXPECT_EQ(stored, 2) << "it would come again without end";
  send_unknown();
  EXPECT_EQ(stored, 3) << "the disk says so";
  send_pose(0, 1, 1);
  run(1s);
  EXPECT_EQ(restart(), "");
  EXPECT_NE(replica->start(), start);
  EXPECT_EQ(content(), before);
  EXPECT_TRUE(replica->chunks().robots().at("r1").submaps.begin()->second.T_map_submap)
      << "the journal goes on";
}

TEST_F(MapReplicaTest, APieceThatIsRefusedDoesNotWriteTheMapAgain) {
  for (std::uint32_t submap = 0; submap < 20; ++submap) send_blocks(submap, 60);
  run(1s);
  const std::uint64_t before = disk->steps();
  for (int n = 0; n < 1000; ++n) {
    send_unknown();
    if (n % 100 == 0) run(200ms);
  }
  run(1s);
  EXPECT_LT(disk->steps() - before, 100U) << "bytes, and syncs";
}

TEST_F(MapReplicaTest, APowerCutDoesNotBringAnEndedStartBack) {
  for (std::uint64_t step = 0; step < 40; ++step) {
    disk = std::make_shared<store::MemoryDisk>(step);
    restart();
    send_blocks(0, 30);
    run(1s);
    const std::uint32_t start = replica->start();
    stored = 0;
    disk->cut_power_after(step);
    send_unknown();
    run(1s);
    disk->power_up();
    restart();
    EXPECT_TRUE(stored == 0 || replica->start() != start) << step;
    EXPECT_FALSE(content().empty());
  }
}

TEST_F(MapReplicaTest, ARobotThatMadeRoomDoesNotComeBackAndTheOneThatIsHeardStays) {
  for (int robot = 0; robot < 64; ++robot) send_pose(0, robot, 1, "old" + std::to_string(robot));
  run(1s);
  EXPECT_EQ(restart(), "");
  const std::uint32_t start = replica->start();
  const std::uint64_t before = disk->steps();
  send_pose(0, 7, 1, "r1");
  EXPECT_FALSE(replica->chunks().robots().contains("old0"));
  run(1s);
  EXPECT_LT(disk->steps() - before, 300U);
  send_pose(0, 8, 1, "r2");
  send_pose(0, 9, 1, "old0");
  run(1s);
  EXPECT_EQ(restart(), "") << "nothing is damaged";
  EXPECT_NE(replica->start(), start) << "what was forgotten was acknowledged";
  const auto& robots = replica->chunks().robots();
  EXPECT_EQ(robots.size(), 64U);
  for (const char* name : {"r1", "r2", "old0"}) EXPECT_TRUE(robots.contains(name)) << name;
  for (const char* name : {"old1", "old10"}) EXPECT_FALSE(robots.contains(name)) << name;
}

TEST_F(MapReplicaTest, AFileAtItsLimitIsWrittenAgainWhileTheStationRuns) {
  const MapJournalParams params{.max_bytes = 40'000};
  restart(params);
  const std::uint32_t start = replica->start();
  std::uint32_t sent = 0;
  for (int n = 0; n < 2000; ++n, ++sent) {
    send_pose(0, n, static_cast<std::uint32_t>(n) + 1);
    if (n % 10 == 0) run(200ms);
    if (n % 100 == 0) {
      send_blocks(1, 3);
      ++sent;
    }
    ASSERT_LE(file_bytes(), params.max_bytes);
  }
  run(1s);
  EXPECT_TRUE(troubles.empty()) << troubles[0];
  EXPECT_EQ(stored, static_cast<int>(sent));
  const Content before = content();
  EXPECT_EQ(restart(params), "");
  EXPECT_EQ(replica->start(), start) << "nothing is missing";
  EXPECT_EQ(content(), before);
  EXPECT_EQ(replica->chunks().robots().at("r1").submaps.begin()->second.pose_revision, 2000U);
}

TEST_F(MapReplicaTest, AFileOfChangesIsWrittenAgainWhileSomeWait) {
  const MapJournalParams params{.max_bytes = 20'000};
  restart(params);
  const std::uint32_t start = replica->start();
  const perception::SubmapKey key{"r1", 5, 0};
  const auto find_base = [&](const perception::BlockIndex& index) {
    return replica->chunks().find(key, index);
  };
  for (std::uint32_t n = 1; n <= 1500; ++n) {
    std::vector<perception::BlockUpdate> blocks;
    for (int x = 0; x < 30; ++x)
      if (random.chance(0.4)) blocks.push_back({{{x, 0, 0}, ~0ULL, random.next()}, n});
    ASSERT_TRUE(take(transfer::Kind::map_blocks,
                     perception::pack(key, blocks, transfer::kMaxPieceBytes, find_base).bytes)
                    .ok());
    if (n % 3 == 0) run(200ms);
    ASSERT_LE(file_bytes(), params.max_bytes);
  }
  run(1s);
  EXPECT_TRUE(troubles.empty()) << troubles[0];
  EXPECT_EQ(stored, 1500);
  const Content before = content();
  EXPECT_EQ(restart(params), "");
  EXPECT_EQ(replica->start(), start);
  EXPECT_EQ(content(), before);
}

TEST_F(MapReplicaTest, AnEndedStartStaysEndedWhenTheFileIsWrittenAgain) {
  const MapJournalParams params{.max_bytes = 10'000};
  restart(params);
  const std::uint32_t start = replica->start();
  send_unknown();
  for (int n = 0; n < 500; ++n) {
    send_pose(0, n, static_cast<std::uint32_t>(n) + 1);
    if (n % 10 == 0) run(200ms);
  }
  EXPECT_TRUE(troubles.empty());
  restart(params);
  EXPECT_NE(replica->start(), start);
}

TEST_F(MapReplicaTest, ForgettingWhileTheFileIsWrittenAgainForgetsAll) {
  const MapJournalParams params{.max_bytes = 10'000, .write = 50ms};
  for (int pause = 0; pause < 30; ++pause) {
    restart(params);
    for (int n = 0; n < 100; ++n) {
      send_pose(0, n, static_cast<std::uint32_t>(n) + 1);
      if (n % 10 == 0) run(160ms);
    }
    run(pause * 10ms);
    replica->forget(900);
    run(1s);
    restart(params);
    EXPECT_TRUE(replica->chunks().robots().empty());
  }
}

TEST_F(MapReplicaTest, APowerCutWhileTheFileIsWrittenAgainLosesNothing) {
  const MapJournalParams params{.max_bytes = 10'000};
  for (std::uint64_t step = 0; step < 12'000; step += 97) {
    disk = std::make_shared<store::MemoryDisk>(step);
    restart(params);
    stored = 0;
    disk->cut_power_after(step);
    int n = 0;
    for (; n < 160; ++n) {
      send_pose(static_cast<std::uint32_t>(n % 3), n, static_cast<std::uint32_t>(n) + 1);
      if (n % 10 == 0) run(200ms);
    }
    disk->power_up();
    restart(params);
    std::uint32_t newest = 0;
    if (const auto& robots = replica->chunks().robots(); robots.contains("r1"))
      for (const auto& [key, submap] : robots.at("r1").submaps)
        newest = std::max(newest, submap.pose_revision);
    EXPECT_GE(newest, static_cast<std::uint32_t>(stored)) << "cut after " << step;
  }
}

TEST_F(MapReplicaTest, AForgottenMapDoesNotComeBackWhenTheDiskWasFull) {
  send_blocks(0, 30);
  run(1s);
  disk->set_full(true);
  replica->forget(900);
  run(1s);
  disk->set_full(false);
  restart();
  EXPECT_TRUE(content().empty());
}

TEST_F(MapReplicaTest, RobotsOfEarlierMissionsMakeRoomForThoseThatAreHeard) {
  ChunkStore chunks({.max_robots = 2, .max_blocks = 10});
  EXPECT_TRUE(chunks.count("old1", 1, 0, std::nullopt));
  EXPECT_TRUE(chunks.count("old2", 1, 0, std::nullopt));
  EXPECT_FALSE(chunks.count("old3", 1, 0, std::nullopt)) << "the disk has too many";
  perception::MapPiece piece{{"old2", 1, 0}, {}};
  for (int x = 0; x < 10; ++x) piece.blocks.push_back({{{x, 0, 0}, 1, 0}, 1});
  EXPECT_TRUE(chunks.take("old2", piece));
  EXPECT_TRUE(chunks.count("r1", 1, 0, Time{1s}));
  EXPECT_FALSE(chunks.robots().contains("old1"));
  EXPECT_EQ(chunks.evicted(), 1U);
  piece.key.robot = "r1";
  EXPECT_TRUE(chunks.take("r1", piece));
  EXPECT_FALSE(chunks.robots().contains("old2"));
  EXPECT_EQ(chunks.blocks(), 10U);
}

TEST_F(MapReplicaTest, TheRobotOfANameThatWasHeardLastHasTheNewestMapAfterARestart) {
  // The first was started five times; then another one, with a new disk, takes its place.
  const std::uint64_t first = perception::map_start(5, 0xaaaa, 1),
                      second = perception::map_start(1, 0xbbbb, 1);
  for (const std::uint64_t map : {first, second})
    EXPECT_TRUE(
        take(transfer::Kind::map_blocks,
             perception::pack({"r1", map, 0}, std::vector<perception::BlockUpdate>{{{{0, 0, 0}, 3, 1}, 1}},
                              transfer::kMaxPieceBytes)
                 .bytes)
            .ok());
  EXPECT_EQ(by_age(replica->chunks().robots().at("r1")).back()->start, second);
  // As after the file was written again, and read by the next start.
  ChunkStore again;
  for (const JournalPiece& piece : pieces_of(replica->chunks())) {
    const auto content = perception::decode(piece.data);
    ASSERT_TRUE(content.ok());
    EXPECT_TRUE(again.count("r1", 1, 0, std::nullopt));
    EXPECT_TRUE(again.take("r1", *content));
  }
  EXPECT_EQ(by_age(again.robots().at("r1")).back()->start, second);
}

}  // namespace
}  // namespace adit::station
