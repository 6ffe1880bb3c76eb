// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/chunk_store.hpp"

#include <gtest/gtest.h>

#include "basestation/map/floor_height.hpp"
#include "basestation/map/ground_area.hpp"
#include "basestation/map/merged_map.hpp"

namespace adit::station {
namespace {

using perception::BlockIndex;
using perception::MapPiece;
using perception::SubmapKey;
using perception::SubmapPoses;

constexpr std::uint64_t kAll = ~std::uint64_t{0};

MapPiece piece_of(const SubmapKey& key, BlockIndex index, std::uint64_t known, std::uint64_t occupied,
                  std::uint32_t revision) {
  return {key, {{{index, known, occupied}, revision}}};
}
SubmapPoses pose_of(const SubmapKey& key, const Pose3& pose, std::uint32_t revision) {
  return {{{key, pose, revision}}};
}

class ChunkStoreTest : public testing::Test {
 protected:
  ChunkStoreTest() { EXPECT_TRUE(chunks.count("r1", 100, 7, Time{})); }
  ChunkStore chunks{};
  SubmapKey key{"r1", 5, 0};
  std::uint32_t sent_{};
};

TEST_F(ChunkStoreTest, TheHigherRevisionWinsInAnyOrder) {
  EXPECT_TRUE(chunks.take("r1", piece_of(key, {0, 0, 0}, 3, 1, 9)));
  EXPECT_TRUE(chunks.take("r1", piece_of(key, {0, 0, 0}, kAll, 0, 8)));
  const auto& block = chunks.robots().at("r1").submaps.at(key).blocks.at({0, 0, 0});
  EXPECT_EQ(block.known, 3U);
  EXPECT_EQ(block.revision, 9U);
  EXPECT_TRUE(chunks.take("r1", piece_of(key, {0, 0, 0}, kAll, 1, 10)));
  EXPECT_EQ(block.known, kAll);
  EXPECT_EQ(chunks.blocks(), 1U);
}

TEST_F(ChunkStoreTest, LargeVoxelsOnlyFillWhatIsNotThere) {
  EXPECT_TRUE(chunks.take("r1", piece_of(key, {0, 0, 0}, 3, 1, 9)));
  MapPiece coarse{key, {{{{0, 0, 0}, kAll, 0}, 10, true}, {{{1, 0, 0}, kAll, 0}, 10, true}}};
  EXPECT_TRUE(chunks.take("r1", coarse));
  const auto& blocks = chunks.robots().at("r1").submaps.at(key).blocks;
  EXPECT_EQ(blocks.at({0, 0, 0}).known, 3U) << "another station lacks it, this one does not";
  EXPECT_EQ(blocks.at({1, 0, 0}).known, kAll);
  EXPECT_TRUE(chunks.take("r1", piece_of(key, {1, 0, 0}, 5, 1, 9))) << "it was sent before, and comes later";
  EXPECT_EQ(blocks.at({1, 0, 0}).known, 5U);
}

TEST_F(ChunkStoreTest, LargeVoxelsAddToEachOther) {
  constexpr std::uint64_t kLow = 0x0033'0033, kHigh = kLow << 32;
  const auto large = [this](std::uint64_t known, std::uint64_t occupied, std::uint32_t revision) {
    return MapPiece{key, {{{{2, 0, 0}, known, occupied}, revision, true}}};
  };
  EXPECT_TRUE(chunks.take("r1", large(kLow | kHigh, kHigh, 15)));
  EXPECT_TRUE(chunks.take("r1", large(kLow, kLow, 12)));
  const auto& block = chunks.robots().at("r1").submaps.at(key).blocks.at({2, 0, 0});
  EXPECT_EQ(block.known, kLow | kHigh) << "the later piece was made before, and came later";
  EXPECT_EQ(block.occupied, kLow | kHigh);
  EXPECT_TRUE(chunks.take("r1", piece_of(key, {2, 0, 0}, 5, 1, 9)));
  EXPECT_EQ(block.known, 5U);
  ChunkStore same;
  EXPECT_TRUE(same.count("r1", 1, 0, Time{}));
  EXPECT_TRUE(same.take("r1", piece_of(key, {2, 0, 0}, 5, 1, 9)));
  EXPECT_EQ(chunks.robots().at("r1").digest, same.robots().at("r1").digest);
}

TEST_F(ChunkStoreTest, AnOlderPoseChangesNothing) {
  EXPECT_TRUE(chunks.take("r1", pose_of(key, Pose3::level({1, 0, 0}, 0), 4)));
  EXPECT_TRUE(chunks.take("r1", pose_of(key, Pose3::level({2, 0, 0}, 0), 3)));
  EXPECT_EQ(chunks.robots().at("r1").submaps.at(key).T_map_submap->position.x(), 1.0);
}

/// Where the newest submap of r1 begins, m.
double newest_x(const ChunkStore& chunks) {
  for (const MapPart& part : parts_of(chunks, "r1"))
    if (part.newest) return part.T_map_submap.position.x();
  return -1.0;
}

TEST_F(ChunkStoreTest, TheNewestMapIsThatOfTheRobotOfANameThatWasHeardLast) {
  // The first robot was started five times; then another one, with a new disk, takes its place.
  const std::vector<SubmapKey> keys{{"r1", perception::map_start(4, 0xaaaa, 1), 0},
                                    {"r1", perception::map_start(5, 0xaaaa, 1), 0},
                                    {"r1", perception::map_start(1, 0xbbbb, 1), 0}};
  const auto send = [&](std::size_t which) {
    EXPECT_TRUE(chunks.take("r1", piece_of(keys[which], {0, 0, 0}, kAll, which, 1 + ++sent_)));
    const Pose3 pose = Pose3::level({static_cast<double>(which), 0, 0}, 0);
    EXPECT_TRUE(chunks.take("r1", pose_of(keys[which], pose, 1)));
  };
  send(0);
  send(1);
  EXPECT_EQ(newest_x(chunks), 1.0);
  send(0);
  EXPECT_EQ(newest_x(chunks), 1.0) << "a start of the same disk that comes late";
  send(2);
  EXPECT_EQ(newest_x(chunks), 2.0);
  MapPiece carried = piece_of(keys[1], {1, 0, 0}, kAll, 1, 1);
  EXPECT_TRUE(chunks.take_carried("r2", carried, 100, Time{}));
  EXPECT_EQ(newest_x(chunks), 2.0) << "another robot carried the map of the dead one";
}

TEST_F(ChunkStoreTest, OnlyTheRobotItselfAddsToItsMap) {
  EXPECT_FALSE(chunks.take("r1", piece_of({"r2", 5, 0}, {0, 0, 0}, 1, 1, 1)));
  EXPECT_FALSE(chunks.take("r1", pose_of({"r2", 5, 0}, {}, 1)));
  EXPECT_TRUE(chunks.empty());
  EXPECT_EQ(chunks.refused(), 2U);
}

TEST_F(ChunkStoreTest, StaysBounded) {
  ChunkStore small({.max_robots = 2, .max_submaps = 3, .max_blocks = 10});
  EXPECT_TRUE(small.count("r1", 1, 0, Time{}));
  for (std::uint32_t n = 0; n < 10; ++n)
    for (int x = 0; x < 10; ++x) (void)small.take("r1", piece_of({"r1", 5, n}, {x, 0, 0}, 1, 0, 1));
  EXPECT_EQ(small.blocks(), 10U);
  EXPECT_EQ(small.robots().at("r1").submaps.size(), 3U);
  EXPECT_EQ(small.refused(), 90U);
  EXPECT_TRUE(small.count("r2", 1, 0, Time{}));
  EXPECT_FALSE(small.count("r3", 1, 0, Time{}));
}

TEST_F(ChunkStoreTest, AreaCountsWhatTwoSubmapsSawOnce) {
  EXPECT_EQ(ground_area(chunks, {}).m2, 0.0);
  chunks.take("r1", piece_of(key, {0, 0, 0}, kAll, 0, 1));
  chunks.take("r1", piece_of(key, {0, 0, 1}, kAll, 0, 1));
  EXPECT_EQ(ground_area(chunks, {}).m2, 0.0) << "where the submap is is not known yet";
  chunks.take("r1", pose_of(key, {}, 1));
  EXPECT_NEAR(ground_area(chunks, {}).m2, 0.64, 1e-6);
  const SubmapKey other{"r1", 5, 1};
  chunks.take("r1", piece_of(other, {0, 0, 0}, kAll, 0, 1));
  chunks.take("r1", pose_of(other, {}, 1));
  EXPECT_NEAR(ground_area(chunks, {}).m2, 0.64, 1e-6);
  chunks.take("r1", pose_of(other, Pose3::level({8.0, 0, 0}, 0), 2));
  EXPECT_NEAR(ground_area(chunks, {}, "r1").m2, 1.28, 1e-6);
  EXPECT_EQ(ground_area(chunks, {}, "r2").m2, 0.0);
}

TEST_F(ChunkStoreTest, PartsHaveWhatIsPlaced) {
  chunks.take("r1", piece_of(key, {0, 0, 0}, kAll, 1, 1));
  EXPECT_TRUE(parts_of(chunks).empty());
  chunks.take("r1", pose_of(key, {}, 1));
  EXPECT_EQ(parts_of(chunks).size(), 1U);
  EXPECT_EQ(parts_of(chunks, "r1").size(), 1U);
  EXPECT_TRUE(parts_of(chunks, "r2").empty());
  EXPECT_FALSE(merged(parts_of(chunks), nullptr, 0.2).empty());
}

TEST_F(ChunkStoreTest, TheFloorOfAPlaceIsTheNearestToAHeight) {
  constexpr std::uint64_t kFloor = 0xffff, kThick = 0xffff'ffff'ffff;
  EXPECT_FALSE(floor_height(chunks, 0.3, 0.3, 0.0)) << "no map";
  EXPECT_TRUE(chunks.take("r1", piece_of(key, {0, 0, 0}, kAll, kFloor, 1)));
  EXPECT_FALSE(floor_height(chunks, 0.3, 0.3, 0.0)) << "its place is not known";
  EXPECT_TRUE(chunks.take("r1", pose_of(key, Pose3::level({10.0, 5.0, M_PI / 2}, 2.0), 1)));
  EXPECT_TRUE(chunks.take("r1", piece_of(key, {0, 0, 4}, kAll, kFloor, 1)));
  EXPECT_TRUE(chunks.take("r1", piece_of(key, {0, 0, 8}, kAll, kThick, 1)));
  const double x = 10.0 - 0.3, y = 5.0 + 0.5;  // (0.5, 0.3) of the submap.
  EXPECT_NEAR(floor_height(chunks, x, y, 0.0).value_or(-1), 2.1, 1e-6);
  EXPECT_NEAR(floor_height(chunks, x, y, 4.5).value_or(-1), 5.3, 1e-6);
  EXPECT_NEAR(floor_height(chunks, x, y, 9.0).value_or(-1), 5.3, 1e-6)
      << "nothing is seen free above the other";
  EXPECT_FALSE(floor_height(chunks, 10.0 + 0.3, y, 0.0)) << "beside the submap";
  EXPECT_FALSE(floor_height(chunks, 1e9, y, 0.0));
}

}  // namespace
}  // namespace adit::station
