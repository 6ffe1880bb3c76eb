// SPDX-License-Identifier: Apache-2.0
// Maps that other robots carried to a station, honest and hostile.
#include <gmock/gmock.h>

#include <array>

#include "basestation/content/digest_list.hpp"
#include "basestation/map/map_replica.hpp"
#include "basestation/map/status.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "core/time/random.hpp"
#include "core/transfer/piece.hpp"

namespace adit::station {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Key;

constexpr std::uint64_t kFull = ~std::uint64_t{0};

std::vector<std::uint8_t> carried_blocks_of(const std::string& robot, int x, std::uint64_t known,
                                            std::uint32_t revision, int count = 1) {
  std::vector<perception::BlockUpdate> updates;
  for (int i = 0; i < count; ++i) updates.push_back({{{x + i, 0, 0}, known, known & 1}, revision});
  return perception::pack({robot, 5, 0}, updates, transfer::kMaxPieceBytes).bytes;
}
std::vector<std::uint8_t> carried_pose_of(const std::string& robot, double x, std::uint32_t revision) {
  return perception::encode(perception::SubmapPoses{{{{robot, 5, 0}, Pose3::level({x, 0, 0}, 0), revision}}});
}

class CarriedMapTest : public testing::Test {
 protected:
  CarriedMapTest() { restart(); }
  std::string restart() {
    replica.emplace(++starts, disk, *strand, [](const std::string&) {});
    return replica->load();
  }
  Result<void> take(const std::string& sender, transfer::Kind kind, const std::vector<std::uint8_t>& data) {
    return replica->take(sender, static_cast<std::uint8_t>(kind), 0, data, [this] { ++stored; });
  }
  void run(Duration span) { scheduler.run_until(scheduler.elapsed() + span); }
  const ChunkStore::RobotMap& robot(const std::string& name) const {
    return replica->chunks().robots().at(name);
  }
  std::uint64_t known(const std::string& name, int x) const {
    return robot(name).submaps.begin()->second.blocks.at({x, 0, 0}).known;
  }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("op1", 5s)};
  std::shared_ptr<Strand> strand{machine->strand("station")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::uint32_t starts{40};
  int stored{};
  std::optional<MapReplica> replica{};
};

TEST_F(CarriedMapTest, IsTakenUnderItsRobotsNameAndShownWithTheCarrier) {
  ASSERT_TRUE(take("r2", transfer::Kind::carried_blocks, carried_blocks_of("r1", 0, kFull, 3, 10)).ok());
  ASSERT_TRUE(take("r2", transfer::Kind::carried_poses, carried_pose_of("r1", 0, 1)).ok());
  run(1s);
  EXPECT_EQ(stored, 2);
  EXPECT_THAT(replica->chunks().robots(), ElementsAre(Key("r1")));
  EXPECT_EQ(robot("r1").blocks, 10U);
  EXPECT_EQ(robot("r1").carried_blocks, 10U);
  EXPECT_THAT(map_status_text(replica->receiver(), strand->now()),
              HasSubstr("r1: carried by r2 (1s ago); 10 of 10 blocks came so"));
  const auto json = map_status_json(replica->receiver(), strand->now());
  EXPECT_EQ(json["robots"][0]["carried"][0]["by"], "r2");
  EXPECT_EQ(json["robots"][0]["carried"][0]["parts"], 11);
  EXPECT_EQ(json["robots"][0]["carried_blocks"], 10);
}

TEST_F(CarriedMapTest, DirectAndCarriedPartsMergeByRevision) {
  ASSERT_TRUE(take("r1", transfer::Kind::map_blocks, carried_blocks_of("r1", 0, 0xff, 5, 2)).ok());
  ASSERT_TRUE(take("r2", transfer::Kind::carried_blocks, carried_blocks_of("r1", 0, 0xf, 4)).ok());
  EXPECT_EQ(known("r1", 0), 0xffU) << "older";
  ASSERT_TRUE(take("r2", transfer::Kind::carried_blocks, carried_blocks_of("r1", 1, 0xfff, 6)).ok());
  EXPECT_EQ(known("r1", 1), 0xffU) << "r1 is heard, and sends what is newer itself";
  run(10s);
  ASSERT_TRUE(take("r2", transfer::Kind::carried_blocks, carried_blocks_of("r1", 1, 0xfff, 6)).ok());
  EXPECT_EQ(known("r1", 1), 0xfffU) << "newer";
  EXPECT_EQ(robot("r1").carried_blocks, 1U);
}

TEST_F(CarriedMapTest, WhatTheRobotItselfSendsReplacesALieWhateverItsRevision) {
  ASSERT_TRUE(take("r2", transfer::Kind::carried_blocks, carried_blocks_of("r1", 0, 0xf, 0xffffffffU)).ok());
  ASSERT_TRUE(take("r2", transfer::Kind::carried_poses, carried_pose_of("r1", 70, 0xffffffffU)).ok());
  ASSERT_TRUE(take("r1", transfer::Kind::map_blocks, carried_blocks_of("r1", 0, kFull, 7)).ok());
  ASSERT_TRUE(take("r1", transfer::Kind::map_poses, carried_pose_of("r1", 1, 2)).ok());
  EXPECT_EQ(known("r1", 0), kFull);
  EXPECT_EQ(robot("r1").carried_blocks, 0U);
  EXPECT_NEAR(robot("r1").submaps.begin()->second.T_map_submap->position.x(), 1.0, 1e-3);
  run(1s);
  EXPECT_EQ(restart(), "");
  EXPECT_EQ(known("r1", 0), kFull) << "also after a restart";
}

TEST_F(CarriedMapTest, APieceThatNamesNoOtherRobotIsRefusedAndNotAcknowledged) {
  EXPECT_EQ(take("r2", transfer::Kind::carried_blocks, carried_blocks_of("r2", 0, kFull, 3)).reason(),
            Reason::malformed);
  EXPECT_EQ(take("r2", transfer::Kind::carried_poses, carried_pose_of("r2", 0, 3)).reason(),
            Reason::malformed);
  EXPECT_EQ(take("r2", transfer::Kind::carried_blocks, carried_blocks_of("r 1\x1b[", 0, kFull, 3)).reason(),
            Reason::malformed);
  perception::SubmapPoses two;
  two.poses = {{{"r1", 5, 0}, Pose3{}, 1}, {{"r3", 5, 0}, Pose3{}, 1}};
  EXPECT_EQ(take("r2", transfer::Kind::carried_poses, perception::encode(two)).reason(), Reason::malformed);
  EXPECT_EQ(take("r2", transfer::Kind::map_blocks, carried_blocks_of("r1", 0, kFull, 3)).reason(),
            Reason::malformed);
  run(1s);
  EXPECT_EQ(stored, 0);
  EXPECT_TRUE(replica->chunks().empty());
  EXPECT_EQ(replica->receiver().refused(), 5U);
}

TEST_F(CarriedMapTest, SurvivesDamagedPieces) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const bool poses = random.chance(0.5);
    std::vector<std::uint8_t> bytes =
        poses ? carried_pose_of("r1", 3, 4)
              : carried_blocks_of("r1", 0, random.next(), static_cast<std::uint32_t>(i), 8);
    for (std::uint64_t n = random.below(3); n > 0; --n)
      bytes[random.below(bytes.size())] ^= static_cast<std::uint8_t>(1U << random.below(8));
    if (random.chance(0.2)) bytes.resize(random.below(bytes.size()) + 1);
    (void)take("r2", random.chance(0.5) ? transfer::Kind::carried_blocks : transfer::Kind::carried_poses,
               bytes);
  }
  EXPECT_GT(replica->receiver().refused(), 0U);
  for (const auto& [name, from] : replica->chunks().robots()) EXPECT_EQ(name, "r1");
}

TEST_F(CarriedMapTest, StaysBoundedAndTakesNoRoomFromRobotsThatAreHeard) {
  ChunkStore store({.max_robots = 4,
                    .max_blocks = 100,
                    .max_carried_robots = 2,
                    .max_carried_blocks = 40,
                    .max_carriers = 2});
  const auto piece = [](const std::string& robot, int x, int count, std::uint32_t revision = 1) {
    perception::MapPiece out{{robot, 5, 0}, {}};
    for (int i = 0; i < count; ++i) out.blocks.push_back({{{x + i, 0, 0}, kFull, 0}, revision});
    return out;
  };
  const auto carry = [&store](const std::string& carrier, perception::MapPiece content) {
    const bool complete = store.take_carried(carrier, content, 10, Time{60s});
    return std::pair(complete, content.blocks.size());
  };
  ASSERT_TRUE(store.count("r1", 10, 0, Time{1s}));
  ASSERT_TRUE(store.take("r1", piece("r1", 0, 50)));
  EXPECT_EQ(carry("bad", piece("a", 0, 30)), std::pair(true, std::size_t{30}));
  EXPECT_EQ(carry("bad", piece("b", 0, 30)), std::pair(false, std::size_t{10}));
  EXPECT_EQ(carry("bad", piece("c", 0, 1)), std::pair(false, std::size_t{0}));
  EXPECT_FALSE(store.robots().contains("c"));
  EXPECT_EQ(carry("bad", piece("r1", 0, 50, 9)), std::pair(false, std::size_t{0}));
  EXPECT_EQ(store.robots().at("r1").carried_blocks, 0U);
  EXPECT_EQ(store.robots().at("a").blocks + store.robots().at("b").blocks, 40U);
  EXPECT_EQ(store.refused_carried(), 71U);
  EXPECT_EQ(store.refused(), 0U);
  for (const char* carrier : {"c1", "c2", "c3"}) (void)carry(carrier, piece("a", 0, 1));
  EXPECT_EQ(store.robots().at("a").carriers.size(), 2U);
  // Robots that are heard get the room of those that were only carried here.
  ASSERT_TRUE(store.take("r1", piece("r1", 100, 50)));
  EXPECT_EQ(store.robots().at("r1").blocks, 100U);
  EXPECT_FALSE(store.robots().contains("a"));
  EXPECT_EQ(store.evicted(), 0U) << "no robot counts on that";
  EXPECT_EQ(carry("bad", piece("d", 0, 1)), std::pair(false, std::size_t{0}));
  EXPECT_EQ(store.robots().at("r1").blocks, 100U);
}

TEST_F(CarriedMapTest, IsThereAfterARestartAlsoOfAFileThatWasWrittenAgain) {
  ASSERT_TRUE(take("r1", transfer::Kind::map_blocks, carried_blocks_of("r1", 0, kFull, 3, 4)).ok());
  ASSERT_TRUE(take("r2", transfer::Kind::carried_blocks, carried_blocks_of("r1", 4, kFull, 5, 6)).ok());
  ASSERT_TRUE(take("r2", transfer::Kind::carried_poses, carried_pose_of("r1", 2, 1)).ok());
  run(1s);
  ChunkStore again;
  for (const JournalPiece& piece : pieces_of(replica->chunks())) {
    const bool poses = piece.kind == static_cast<std::uint8_t>(transfer::Kind::carried_poses);
    if (poses) {
      perception::SubmapPoses content = perception::decode_poses(piece.data).value();
      EXPECT_TRUE(again.take_carried(piece.robot, content, 1, std::nullopt));
    } else if (transfer::is_carried(piece.kind)) {
      perception::MapPiece content = perception::decode(piece.data).value();
      EXPECT_TRUE(again.take_carried(piece.robot, content, 1, std::nullopt));
    } else {
      EXPECT_TRUE(again.count(piece.robot, 1, 0, std::nullopt));
      EXPECT_TRUE(again.take(piece.robot, perception::decode(piece.data).value()));
    }
  }
  EXPECT_EQ(restart(), "");
  for (const ChunkStore* chunks : std::array<const ChunkStore*, 2>{&again, &replica->chunks()}) {
    const ChunkStore::RobotMap& r1 = chunks->robots().at("r1");
    EXPECT_EQ(r1.blocks, 10U);
    EXPECT_EQ(r1.carried_blocks, 6U);
    EXPECT_THAT(r1.carriers, ElementsAre(Key("r2")));
    EXPECT_EQ(r1.submaps.begin()->second.blocks.begin()->second.received, 0U);
  }
  EXPECT_EQ(robot("r1").digest, again.robots().at("r1").digest);
}

TEST_F(CarriedMapTest, APieceWithNothingNewIsAcknowledgedAndTakesNoSpaceOnTheDisk) {
  ASSERT_TRUE(take("r2", transfer::Kind::carried_blocks, carried_blocks_of("r1", 0, kFull, 3, 10)).ok());
  run(1s);
  const std::size_t bytes = disk->read(MapJournal::kFile, 1U << 20U).value()->size();
  for (int i = 0; i < 100; ++i)
    ASSERT_TRUE(take("r3", transfer::Kind::carried_blocks, carried_blocks_of("r1", 0, kFull, 3, 10)).ok());
  run(1s);
  EXPECT_EQ(stored, 101);
  EXPECT_EQ(disk->read(MapJournal::kFile, 1U << 20U).value()->size(), bytes);
}

TEST_F(CarriedMapTest, WhatACarrierHasStillToSendIsItsNewestWord) {
  const auto own = carried_blocks_of("r2", 0, kFull, 1, 10);
  ASSERT_TRUE(replica->take("r2", 1, 500, own, [] {}).ok());
  EXPECT_EQ(robot("r2").waiting, 500U);
  ASSERT_TRUE(replica->take("r2", 4, 7, carried_blocks_of("r1", 0, kFull, 1, 10), [] {}).ok());
  EXPECT_EQ(robot("r2").waiting, 7U);
  EXPECT_EQ(robot("r1").waiting, 0U);
}

TEST_F(CarriedMapTest, ABlockKnowsWhenItCame) {
  run(3s);
  ASSERT_TRUE(take("r1", transfer::Kind::map_blocks, carried_blocks_of("r1", 0, kFull, 3)).ok());
  run(20s);
  ASSERT_TRUE(take("r2", transfer::Kind::carried_blocks, carried_blocks_of("r1", 1, kFull, 4)).ok());
  const auto& blocks = robot("r1").submaps.begin()->second.blocks;
  const std::uint32_t now = replica->chunks().clock(strand->now());
  EXPECT_EQ(now - blocks.at({0, 0, 0}).received, 200U) << "tenths of a second";
  EXPECT_EQ(blocks.at({1, 0, 0}).received, now);
}

TEST_F(CarriedMapTest, StatusSaysWhichShareOfTheAreaIsHowOld) {
  ASSERT_TRUE(take("r1", transfer::Kind::map_poses, carried_pose_of("r1", 0, 1)).ok());
  ASSERT_TRUE(take("r1", transfer::Kind::map_blocks, carried_blocks_of("r1", 0, kFull, 3, 4)).ok());
  run(1s);
  ASSERT_EQ(restart(), "");
  const auto shares = [this] { return map_status_json(replica->receiver(), strand->now())["share_by_age"]; };
  EXPECT_EQ(shares()["unknown"], 1.0) << "it is from the disk";
  ASSERT_TRUE(take("r1", transfer::Kind::map_blocks, carried_blocks_of("r1", 0, kFull, 4, 2)).ok());
  run(40s);
  ASSERT_TRUE(take("r2", transfer::Kind::carried_blocks, carried_blocks_of("r1", 0, kFull, 5, 1)).ok());
  EXPECT_EQ(shares()["within_10s"], 0.25);
  EXPECT_EQ(shares()["within_1min"], 0.5);
  EXPECT_EQ(shares()["within_10min"], 0.5);
  EXPECT_EQ(shares()["unknown"], 0.5);
  run(700s);
  EXPECT_EQ(shares()["within_10min"], 0.0);
  EXPECT_THAT(
      map_status_text(replica->receiver(), strand->now()),
      HasSubstr("received within 10 s: 0 %, 1 min: 0 %, 10 min: 0 %, before the station's start: 50 %"));
}

TEST(DigestList, ListsAFewInTurnAndSaysWhenThatIsAll) {
  ChunkStore chunks;
  DigestList list;
  Time now{10s};
  auto due = list.due(chunks, 0, 0.0, now);
  ASSERT_TRUE(due);
  EXPECT_TRUE(due->all);
  EXPECT_TRUE(due->list.empty());
  EXPECT_FALSE(list.due(chunks, 0, 0.0, now + 1s));
  for (const char* robot : {"a", "b", "c", "d", "e"}) ASSERT_TRUE(chunks.count(robot, 1, 0, now));
  std::vector<std::string> listed;
  for (int i = 0; i < 4; ++i) {
    due = list.due(chunks, i < 3 ? 0 : 16, 0.0, now += 4s);
    ASSERT_TRUE(due);
    EXPECT_FALSE(due->all);
    for (const auto& digest : due->list) listed.push_back(digest.robot);
  }
  EXPECT_THAT(listed, ElementsAre("a", "b", "c", "d", "e", "a", "b", "c", "d", "e"));
}

}  // namespace
}  // namespace adit::station
