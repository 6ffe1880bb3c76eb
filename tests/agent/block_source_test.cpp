// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/block_source.hpp"

#include <gtest/gtest.h>

#include "core/time/random.hpp"
#include "perception/stream/piece.hpp"
#include "robot_agent/perception/pose_source.hpp"

namespace adit::agent {
namespace {

using perception::BlockIndex;
using perception::CoarseBlock;
using transfer::PeerId;

constexpr PeerId kOne{1}, kTwo{2};
constexpr std::uint64_t kAll = ~std::uint64_t{0};

class BlockSourceTest : public testing::Test {
 protected:
  perception::MapPiece next(const std::vector<PeerId>& peers, std::uint64_t& taken,
                            std::size_t bytes = 1200) {
    const auto content = source.next(peers, bytes, now);
    if (!content) return {};
    EXPECT_LE(content->data.size(), bytes);
    taken = content->token;
    const auto piece = perception::decode(content->data, find_stored);
    EXPECT_TRUE(piece.ok()) << piece.error().text;
    if (!piece) return {};
    for (const auto& update : piece->blocks) stored[{piece->key, update.block.index}] = update.block;
    return *piece;
  }
  void put(int x, std::uint64_t known = kAll, std::uint32_t submap = 0) {
    source.update(submap, {{x, 0, 0}, known, known & 1});
  }

  BlockSource source{{.robot = "r1", .start = 5, .max_blocks = 1000}};
  Time now{100s};
  std::uint64_t token{};
  /// What a station that gets all pieces has.
  std::map<std::pair<perception::SubmapKey, BlockIndex>, CoarseBlock> stored{};
  perception::FindStored find_stored = [this](const perception::SubmapKey& key,
                                              const BlockIndex& index) -> std::optional<CoarseBlock> {
    const auto found = stored.find({key, index});
    return found != stored.end() ? std::optional(found->second) : std::nullopt;
  };
};

TEST_F(BlockSourceTest, ASilentPeerStillHasTheStateItAcknowledged) {
  source.join(kOne);
  for (int x = 0; x < 50; ++x) put(x);
  ASSERT_FALSE(next({kOne}, token).blocks.empty());
  source.acknowledged(kOne, token);
  source.settled(token);
  ASSERT_EQ(source.missing(kOne), 0U);
  put(7, 0xff);
  source.join(kTwo);
  now += 200s;
  while (source.missing(kTwo) > 0) ASSERT_FALSE(next({kTwo}, token).blocks.empty());
  EXPECT_EQ(source.missing(kOne), 1U) << "what changed since";
  EXPECT_FALSE(source.complete(kOne, 0));
}

TEST_F(BlockSourceTest, SendsTheNewestFirstAndNothingTwice) {
  source.join(kOne);
  for (int x = 0; x < 100; ++x) put(x);
  std::set<int> sent;
  for (bool first = true; source.missing(kOne) > 0; first = false) {
    const auto piece = next({kOne}, token);
    ASSERT_FALSE(piece.blocks.empty());
    EXPECT_EQ(piece.key, (perception::SubmapKey{"r1", 5, 0}));
    if (first) {
      EXPECT_TRUE(std::any_of(piece.blocks.begin(), piece.blocks.end(),
                              [](const auto& b) { return b.block.index.x == 99; }));
    }
    for (const auto& update : piece.blocks) EXPECT_TRUE(sent.insert(update.block.index.x).second);
    source.acknowledged(kOne, token);
    source.settled(token);
  }
  EXPECT_EQ(sent.size(), 100U);
  EXPECT_FALSE(source.next(std::vector{kOne}, 1200, now));
}

/// Blocks that differ, so that a piece takes about a hundred of them.
class BlockOrderTest : public BlockSourceTest {
 protected:
  BlockOrderTest() : BlockSourceTest() {
    Random random(3);
    for (std::uint32_t x = 0; x < 1000; ++x) {
      const std::uint64_t surface = random.next() & random.next();
      source.open(0, {5, 0, 7, {100, 0, 0}});
      source.update(0, {{static_cast<int>(x), 0, 0}, kAll, x % 2 == 0 ? surface : 0});
    }
    source.join(kOne);
  }
  std::vector<int> piece() {
    std::vector<int> out;
    for (const auto& update : next({kOne}, token).blocks) out.push_back(update.block.index.x);
    source.acknowledged(kOne, token);
    source.settled(token);
    return out;
  }
};

TEST_F(BlockOrderTest, WithABacklogSurfacesGoBeforeFreeSpace) {
  EXPECT_TRUE(source.is_behind());
  const auto first = piece();
  ASSERT_FALSE(first.empty());
  EXPECT_TRUE(std::all_of(first.begin(), first.end(), [](int x) { return x % 2 == 0; }));
}

TEST_F(BlockOrderTest, WithABacklogTheFocusGoesFirstAndThenTheRest) {
  source.focus({{7, {110, 0, 0}, {119, 0, 0}}});  // The lattice begins 100 blocks earlier.
  source.focus(kOne, {{7, {300, 0, 0}, {309, 0, 0}}});
  const auto first = piece();
  ASSERT_GT(first.size(), 20U);
  for (int x = 10; x < 20; ++x) EXPECT_NE(std::find(first.begin(), first.end(), x), first.end()) << x;
  for (int x = 200; x < 210; ++x) EXPECT_NE(std::find(first.begin(), first.end(), x), first.end()) << x;
  std::set<int> all(first.begin(), first.end());
  EXPECT_EQ(all.size(), first.size()) << "each once";
  while (source.missing(kOne) > 0)
    for (const int x : piece()) EXPECT_TRUE(all.insert(x).second) << x;
  EXPECT_EQ(all.size(), 1000U);
}

TEST_F(BlockSourceTest, APieceIsFilledByCodedSizeAndItsBlocksShareOneRevision) {
  source.join(kOne);
  for (int x = 0; x < 400; ++x) put(x);
  const auto piece = next({kOne}, token, 500);
  EXPECT_GT(piece.blocks.size(), 200U);
  for (const auto& update : piece.blocks) EXPECT_EQ(update.revision, piece.blocks.front().revision);
  source.acknowledged(kOne, token);
  source.settled(token);
  // A block that changes now is newer than all of them, wherever it was among them.
  const int x = piece.blocks.front().block.index.x;
  put(x, 1);
  now += 60s;
  std::uint32_t revision = 0;
  for (int pieces = 0; pieces < 8; ++pieces)
    for (const auto& update : next({kOne}, token, 500).blocks)
      if (update.block.index.x == x) revision = update.revision;
  EXPECT_GT(revision, piece.blocks.front().revision);
}

TEST_F(BlockSourceTest, ALostPieceIsMissingAgainInItsNewestState) {
  source.join(kOne);
  put(0, 1);
  (void)next({kOne}, token);
  EXPECT_EQ(source.missing(kOne), 0U);
  put(0, 0x33);
  source.lost(kOne, token);
  source.settled(token);
  EXPECT_EQ(source.missing(kOne), 1U);
  now += 31s;
  const auto piece = next({kOne}, token);
  ASSERT_EQ(piece.blocks.size(), 1U);
  EXPECT_EQ(piece.blocks[0].block.known, 0x33U);
}

TEST_F(BlockSourceTest, ABlockThatChangesOnItsWayIsSentAgainLater) {
  source.join(kOne);
  put(0, 1);
  (void)next({kOne}, token);
  put(0, 3);
  source.acknowledged(kOne, token);
  EXPECT_EQ(source.missing(kOne), 1U);
  EXPECT_FALSE(source.next(std::vector{kOne}, 1200, now)) << "it was sent just now";
  now += 25s;
  EXPECT_FALSE(source.next(std::vector{kOne}, 1200, now)) << "alone it does not fill a piece";
  now += 36s;
  EXPECT_EQ(next({kOne}, token).blocks.size(), 1U);
}

TEST_F(BlockSourceTest, APlaceThatGrowsWaitsForAFullPieceOrSomeSeconds) {
  source.join(kOne);
  put(0, 1);
  (void)next({kOne}, token);
  source.acknowledged(kOne, token);
  now += 1s;
  source.tick(now);
  put(0, 1 | 1ULL << 63U);  // A voxel of 0.4 m that the station does not know.
  for (int i = 0; i < 65; ++i) {
    EXPECT_FALSE(source.next(std::vector{kOne}, 1200, now)) << i;
    now += 100ms;
  }
  now += 200ms;
  EXPECT_EQ(next({kOne}, token).blocks.size(), 1U);
  source.acknowledged(kOne, token);
  source.tick(now);
  Random random(1);
  for (int x = 1; x < 990; ++x) source.update(0, {{x, 0, 0}, kAll, random.next()});
  now += 2100ms;
  EXPECT_GT(next({kOne}, token).blocks.size(), 50U) << "they fill one";
}

TEST_F(BlockSourceTest, TracksTheStateOfEachPeer) {
  source.join(kOne);
  source.join(kTwo);
  put(0);
  (void)next({kOne, kTwo}, token);
  source.acknowledged(kOne, token);
  source.lost(kTwo, token);
  EXPECT_EQ(source.missing(kOne), 0U);
  EXPECT_EQ(source.missing(kTwo), 1U);
  source.join(kOne);  // It was started again.
  EXPECT_EQ(source.missing(kOne), 1U);
}

TEST_F(BlockSourceTest, AnUnchangedBlockIsNotSentAgain) {
  source.join(kOne);
  put(0);
  (void)next({kOne}, token);
  source.acknowledged(kOne, token);
  put(0);
  EXPECT_EQ(source.missing(kOne), 0U);
}

TEST_F(BlockSourceTest, DropsTheOldestSubmapWhenItIsFull) {
  source.join(kOne);
  for (int x = 0; x < 600; ++x) put(x, kAll, 0);
  for (int x = 0; x < 600; ++x) put(x, kAll, 1);
  EXPECT_LE(source.size(), 1000U);
  EXPECT_EQ(source.missing(kOne), source.size());
  EXPECT_EQ(source.dropped(), 600U);
  for (int x = 0; x < 2000; ++x) put(x, kAll, 1);
  EXPECT_LE(source.size(), 1000U);
  while (source.missing(kOne) > 0) EXPECT_FALSE(next({kOne}, token).blocks.empty());
}

TEST_F(BlockSourceTest, ReachesEveryPeerWhateverIsLost) {
  Random random(3);
  source.join(kOne);
  source.join(kTwo);
  std::map<PeerId, std::map<BlockIndex, perception::BlockUpdate>> has;
  for (int round = 0; round < 3000; ++round, now += 100ms) {
    if (round < 1500)
      for (int n = 0; n < 3; ++n)
        source.update(static_cast<std::uint32_t>(round / 500),
                      {{static_cast<int>(random.below(60)), round / 500, 0}, random.next() | 1, 1});
    const std::vector<PeerId> peers =
        source.missing(kTwo) > source.missing(kOne) ? std::vector{kTwo, kOne} : std::vector{kOne, kTwo};
    if (source.missing(peers.front()) == 0) continue;
    const auto piece = next(peers, token, 350);
    for (const PeerId& peer : peers) {
      if (random.chance(0.3)) {
        source.lost(peer, token);
        continue;
      }
      for (const auto& update : piece.blocks) {
        auto& known = has[peer][update.block.index];
        if (update.revision > known.revision) known = update;
      }
      source.acknowledged(peer, token);
    }
    source.settled(token);
  }
  EXPECT_EQ(source.missing(kOne), 0U);
  EXPECT_EQ(source.missing(kTwo), 0U);
  EXPECT_EQ(has[kOne].size(), source.size());
  ASSERT_EQ(has[kTwo].size(), source.size());
  for (const auto& [index, update] : has[kOne]) EXPECT_EQ(update.block, has[kTwo].at(index).block);
}

TEST(PoseSource, SendsEachPoseUntilItArrives) {
  PoseSource source("r1", 5);
  source.join(kOne);
  for (std::uint32_t i = 0; i < 50; ++i) source.update(i, Pose3::level({1.0 * i, 2, 0.5}, 0.1));
  std::map<std::uint32_t, Pose3> has;
  for (int round = 0; source.missing(kOne) > 0; ++round) {
    ASSERT_LT(round, 100);
    const auto content = source.next(std::vector{kOne}, 350, Time{});
    ASSERT_TRUE(content);
    EXPECT_LE(content->data.size(), 350U);
    if (round % 3 == 0) {
      source.lost(kOne, content->token);
    } else {
      const auto poses = perception::decode_poses(content->data);
      ASSERT_TRUE(poses.ok());
      for (const auto& pose : poses->poses) has[pose.key.index] = pose.T_map_submap;
      source.acknowledged(kOne, content->token);
    }
    source.settled(content->token);
  }
  ASSERT_EQ(has.size(), 50U);
  EXPECT_NEAR(has.at(49).position.x(), 49.0, 0.01);
  EXPECT_NEAR(has.at(49).yaw(), 0.5, 0.001);
}

class BlockChangesTest : public BlockSourceTest {
 protected:
  BlockChangesTest() {
    source.join(kOne);
    for (int x = 0; x < 40; ++x) put(x, 0x00ff'00ff);
    std::uint64_t sent = 0;
    EXPECT_EQ(arrives(sent).size(), 40U);
    for (int x = 0; x < 40; ++x) put(x, 0x0fff'00ff);
    now += 60s;
  }
  /// The next piece, which is acknowledged.
  std::vector<perception::BlockUpdate> arrives(std::uint64_t& sent) {
    now += 60s;
    auto out = next({kOne}, sent).blocks;
    source.acknowledged(kOne, sent);
    source.settled(sent);
    return out;
  }
  /// Whether the next piece, which goes to these, has changes only; it is not taken.
  bool is_change(const std::vector<PeerId>& peers) {
    const auto content = source.next(peers, 1200, now);
    EXPECT_TRUE(content);
    if (!content) return false;
    token = content->token;
    const auto piece = perception::decode(content->data, find_stored);
    EXPECT_TRUE(piece.ok());
    if (piece) last = *piece;
    return !perception::decode(content->data).ok();
  }
  void arrive() {
    for (const auto& update : last.blocks) stored[{last.key, update.block.index}] = update.block;
    source.acknowledged(kOne, token);
    source.settled(token);
  }
  void lose(const PeerId& peer) {
    source.lost(peer, token);
    source.settled(token);
  }

  perception::MapPiece last{};
};

TEST_F(BlockChangesTest, SendsOnlyChangesToAnAcknowledgedState) { EXPECT_TRUE(is_change({kOne})); }

TEST_F(BlockChangesTest, ALostChangeIsRepeatedOnceThenTheBlockIsSentComplete) {
  EXPECT_TRUE(is_change({kOne}));
  lose(kOne);
  EXPECT_TRUE(is_change({kOne}));
  lose(kOne);
  EXPECT_FALSE(is_change({kOne}));
  arrive();
  put(3, 0xffff'00ff);
  now += 300s;
  EXPECT_TRUE(is_change({kOne}));
}

TEST_F(BlockChangesTest, TheNextChangeWaitsForTheOneOnItsWay) {
  EXPECT_TRUE(is_change({kOne}));
  for (int x = 0; x < 40; ++x) put(x, 0xffff'00ff);
  now += 300s;
  EXPECT_FALSE(source.next(std::vector{kOne}, 1200, now));
  EXPECT_EQ(source.missing(kOne), 40U);
  arrive();
  now += 1s;
  EXPECT_TRUE(is_change({kOne}));
}

TEST_F(BlockChangesTest, ANewStationGetsCompleteBlocks) {
  source.join(kTwo);
  EXPECT_FALSE(is_change({kTwo, kOne}));
}

class GrowingTest : public BlockSourceTest {
 protected:
  GrowingTest() {
    source.tick(now);
    source.join(kOne);
    for (int x = 0; x < 60; ++x) put(x, 0x0033);
  }
  /// The blocks of the next piece by size of voxels; it arrives.
  struct Sent {
    std::size_t coarse{}, fine{};
    bool operator==(const Sent&) const = default;
  };
  Sent arrives(Duration later, bool lost = false) {
    now += later;
    source.tick(now);
    Sent out;
    std::uint64_t sent = 0;
    for (const auto& update : next({kOne}, sent).blocks) ++(update.coarse ? out.coarse : out.fine);
    if (sent == 0) return out;
    lost ? source.lost(kOne, sent) : source.acknowledged(kOne, sent);
    source.settled(sent);
    return out;
  }
};

TEST_F(GrowingTest, GoInLargeVoxelsAndInSmallOnesOnceTheyRest) {
  EXPECT_EQ(arrives(3s), (Sent{60, 0}));
  EXPECT_EQ(source.missing(kOne), 60U);
  for (int x = 0; x < 60; ++x) put(x, 0x0011);
  EXPECT_EQ(arrives(10s), Sent{}) << "no other voxel of 0.4 m";
  for (int x = 0; x < 40; ++x) put(x, 0x00ff);
  EXPECT_EQ(arrives(3s), (Sent{40, 0}));
  EXPECT_EQ(arrives(60s), (Sent{0, 60}));
  EXPECT_TRUE(source.complete(kOne, 0));
}

TEST_F(GrowingTest, BlocksOfBothSizesShareAPiece) {
  EXPECT_EQ(arrives(3s), (Sent{60, 0}));
  now += 61s;
  source.tick(now);
  for (int x = 60; x < 90; ++x) put(x, 0x0033);
  EXPECT_EQ(arrives(3s), (Sent{30, 60}));
}

TEST_F(GrowingTest, LargeVoxelsThatWereLostGoOnceMore) {
  EXPECT_EQ(arrives(3s, true), (Sent{60, 0}));
  EXPECT_EQ(arrives(1s, true), (Sent{60, 0}));
  EXPECT_EQ(arrives(5s), Sent{}) << "a station that takes none must get the small ones";
  EXPECT_EQ(arrives(60s), (Sent{0, 60}));
}

TEST_F(GrowingTest, SmallVoxelsThatWereLostGoAtOnce) {
  EXPECT_EQ(arrives(3s), (Sent{60, 0}));
  EXPECT_EQ(arrives(61s, true), (Sent{0, 60}));
  EXPECT_EQ(arrives(1s), (Sent{0, 60}));
}

TEST_F(GrowingTest, ABlockSentInSmallVoxelsGrowsInSmallVoxels) {
  EXPECT_EQ(arrives(3s), (Sent{60, 0}));
  EXPECT_EQ(arrives(61s), (Sent{0, 60}));
  for (int x = 0; x < 60; ++x) put(x, 0x00ff);
  EXPECT_EQ(arrives(3s), (Sent{0, 60}));
}

TEST_F(GrowingTest, AStationThatHasAnOlderStateInSmallVoxelsGetsNoLargeOnes) {
  source.join(kTwo);
  now += 61s;
  source.tick(now);
  std::uint64_t first = 0, second = 0;
  ASSERT_EQ(next({kOne, kTwo}, first).blocks.size(), 60U);
  source.acknowledged(kTwo, first);
  for (int x = 0; x < 60; ++x) put(x, 0x00ff);
  now += 3s;
  source.tick(now);
  ASSERT_EQ(next({kTwo}, second).blocks.size(), 60U);
  source.acknowledged(kTwo, second);
  source.acknowledged(kOne, first);
  EXPECT_EQ(arrives(3s), (Sent{0, 60}));
}

TEST_F(GrowingTest, AMissionsRestingBlocksAreNoReasonToSendFewAtOnce) {
  BlockSource large({.robot = "r1", .start = 5, .coarse_pieces = 1});
  large.tick(now);
  large.join(kOne);
  for (int x = 0; x < 900; ++x) large.update(0, {{x, 0, 0}, 0x0033, 0});
  const auto goes = [&](Duration later) {
    now += later;
    large.tick(now);
    const auto content = large.next(std::vector{kOne}, 1200, now);
    if (!content) return false;
    large.acknowledged(kOne, content->token);
    large.settled(content->token);
    return true;
  };
  while (goes(3s)) {
  }
  ASSERT_EQ(large.missing(kOne), 900U) << "they rest";
  large.update(0, {{1000, 0, 0}, 0x0033, 0});
  EXPECT_FALSE(goes(1s));
  EXPECT_TRUE(goes(7s));
}

class CoarseFirstTest : public BlockSourceTest {
 protected:
  static constexpr int kBlocks = 25'000;
  CoarseFirstTest() {
    for (int x = 0; x < kBlocks; ++x) many.update(0, {{x % 100, x / 100, 0}, kAll, 0x1111'1111'1111'1111});
    many.join(kOne);
  }
  std::optional<perception::MapPiece> piece() {
    const auto content = many.next(std::vector{kOne}, 1000, now);
    if (!content) return std::nullopt;
    token = content->token;
    const auto decoded = perception::decode(content->data);
    EXPECT_TRUE(decoded.ok());
    return decoded ? std::optional(*decoded) : std::nullopt;
  }
  void settle(bool arrived) {
    if (arrived)
      many.acknowledged(kOne, token);
    else
      many.lost(kOne, token);
    many.settled(token);
  }

  BlockSource many{{.robot = "r1", .start = 5, .max_blocks = kBlocks, .slice = kBlocks}};
};

TEST_F(CoarseFirstTest, AStationThatLacksMuchGetsLargeVoxelsOfAllFirst) {
  std::map<BlockIndex, int> coarse;
  std::set<BlockIndex> fine;
  for (int pieces = 0; many.missing(kOne) > 0 && pieces < 1000; ++pieces, now += 10s) {
    const auto got = piece();
    if (!got) continue;
    const bool arrived = pieces % 5 != 0;
    settle(arrived);
    for (const auto& update : got->blocks) {
      if (update.coarse) {
        EXPECT_TRUE(fine.empty());
        if (arrived) ++coarse[update.block.index];
      } else if (arrived) {
        EXPECT_TRUE(fine.insert(update.block.index).second);
      }
    }
  }
  EXPECT_EQ(coarse.size(), static_cast<std::size_t>(kBlocks));
  for (const auto& [index, times] : coarse) EXPECT_EQ(times, 1);
  EXPECT_EQ(fine.size(), static_cast<std::size_t>(kBlocks));
  EXPECT_TRUE(many.complete(kOne, 0));
}

TEST_F(CoarseFirstTest, ABlockSentInSmallVoxelsIsNeverSentInLargeOnes) {
  for (; many.missing(kOne) > 0; now += 10s)
    if (piece()) settle(true);
  ASSERT_TRUE(many.complete(kOne, 0));
  for (int x = 0; x < kBlocks; ++x) many.update(1, {{x % 100, x / 100, 0}, kAll, 0x3333});
  now += 600s;
  for (int pieces = 0; pieces < 5; ++pieces) {
    const auto got = piece();
    ASSERT_TRUE(got);
    for (const auto& update : got->blocks) EXPECT_FALSE(update.coarse);
    settle(true);
  }
}

}  // namespace
}  // namespace adit::agent
