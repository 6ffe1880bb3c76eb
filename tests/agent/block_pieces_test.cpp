// SPDX-License-Identifier: Apache-2.0
// A source of blocks on a strand that has little time: pieces are encoded by `compute`, and peers join in
// slices.
#include <gtest/gtest.h>

#include "core/exec/virtual_runtime.hpp"
#include "robot_agent/perception/block_source.hpp"

namespace adit::agent {
namespace {

using transfer::PeerId;

constexpr PeerId kFirst{1}, kSecond{2};

class BlockPiecesTest : public testing::Test {
 protected:
  BlockPiecesTest() {
    source.encode_on(*strand, [this] { ++ready; });
  }
  void put(BlockSource& to, int x, std::uint64_t known) { to.update(0, {{x, 0, 0}, known, known & 1}); }
  void encode() {
    now += 10ms;
    scheduler.run_until(scheduler.elapsed() + 10ms);
  }
  /// Takes the piece that goes to these peers now; what they had of a block comes from `stored`.
  bool take(const std::vector<PeerId>& peers) {
    auto content = source.next(peers, 1200, now);
    if (!content) {
      encode();
      content = source.next(peers, 1200, now);
    }
    if (!content) return false;
    token = content->token;
    const auto piece = perception::decode(content->data, [this](const auto&, const auto& index) {
      const auto known = stored.find(index);
      return known == stored.end() ? std::nullopt : std::optional(known->second);
    });
    EXPECT_TRUE(piece.ok()) << piece.error().text;
    if (!piece) return false;
    for (const auto& update : piece->blocks) stored[update.block.index] = update.block;
    return true;
  }
  void take_all(const PeerId& peer) {
    for (int n = 0; n < 1000 && source.missing(peer) > 0; ++n) {
      now += 5s;
      source.tick(now);
      if (!take({peer})) continue;
      source.acknowledged(peer, token);
      source.settled(token);
    }
    EXPECT_EQ(source.missing(peer), 0U);
  }
  std::uint64_t known(int x) { return stored[{x, 0, 0}].known; }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Strand> strand{machine->strand("command")};
  BlockSource source{{.robot = "r1", .start = 5, .slice = 100}};
  int ready{};
  Time now{100s};
  std::uint64_t token{};
  std::map<perception::BlockIndex, perception::CoarseBlock> stored{};
};

TEST_F(BlockPiecesTest, APieceIsEncodedByComputeAndGoesWhenItIsReady) {
  source.join(kFirst);
  for (int x = 0; x < 90; ++x) put(source, x, 0xff);
  now += 200s;
  EXPECT_FALSE(source.next(std::vector{kFirst}, 1200, now)) << "nothing is encoded within the call";
  EXPECT_FALSE(source.next(std::vector{kFirst}, 1200, now)) << "one at a time";
  EXPECT_EQ(source.missing(kFirst), 90U);
  EXPECT_EQ(ready, 0);
  encode();
  EXPECT_EQ(ready, 1);
  EXPECT_TRUE(source.next(std::vector{kFirst}, 1200, now));
  EXPECT_EQ(source.missing(kFirst), 0U);
}

TEST_F(BlockPiecesTest, ABlockThatChangesWhileItIsEncodedGoesAgain) {
  source.join(kFirst);
  for (int x = 0; x < 90; ++x) put(source, x, 0xff);
  now += 200s;
  ASSERT_FALSE(source.next(std::vector{kFirst}, 1200, now));
  source.tick(now);
  put(source, 7, 0xffff);
  ASSERT_TRUE(take({kFirst}));
  EXPECT_EQ(known(7), 0xffU) << "as it was chosen";
  EXPECT_EQ(source.missing(kFirst), 1U);
  source.acknowledged(kFirst, token);
  source.settled(token);
  EXPECT_FALSE(source.complete(kFirst, 0));
  take_all(kFirst);
  EXPECT_EQ(known(7), 0xffffU);
  EXPECT_TRUE(source.complete(kFirst, 0));
}

TEST_F(BlockPiecesTest, ABlockThatIsErasedWhileItIsEncodedHarmsNothing) {
  source.join(kFirst);
  for (int x = 0; x < 90; ++x) put(source, x, 0xff);
  now += 200s;
  ASSERT_FALSE(source.next(std::vector{kFirst}, 1200, now));
  source.drop(0);
  EXPECT_TRUE(take({kFirst}));
  EXPECT_EQ(source.missing(kFirst), 0U);
  source.lost(kFirst, token);
  EXPECT_EQ(source.missing(kFirst), 0U);
}

TEST_F(BlockPiecesTest, APieceForPeersThatChangedIsChosenAgain) {
  source.join(kFirst);
  for (int x = 0; x < 90; ++x) put(source, x, 0xff);
  take_all(kFirst);
  for (int x = 0; x < 90; ++x) put(source, x, 0xffff);
  now += 200s;
  ASSERT_FALSE(source.next(std::vector{kFirst}, 1200, now)) << "the changes, for one that has the blocks";
  source.join(kSecond);
  stored.clear();
  encode();
  take_all(kSecond);
  EXPECT_EQ(known(7), 0xffffU);
}

TEST_F(BlockPiecesTest, APeerJoinsInSlicesAndIsSentNothingBefore) {
  for (int x = 0; x < 350; ++x) put(source, x, 0xff);
  now += 200s;
  source.join(kFirst);
  EXPECT_EQ(source.missing(kFirst), 350U);
  for (int slice = 1; slice < 4; ++slice) {
    EXPECT_FALSE(take({kFirst})) << slice;
    source.tick(now);
    put(source, 50, 0xff << slice);   // Behind what was looked up, and
    put(source, 340, 0xff << slice);  // before it.
  }
  EXPECT_EQ(source.missing(kFirst), 350U);
  take_all(kFirst);
  EXPECT_EQ(stored.size(), 350U);
  EXPECT_EQ(known(50), 0xffU << 3);
  EXPECT_EQ(known(340), 0xffU << 3);
}

TEST_F(BlockPiecesTest, APeerThatJoinsInThePlaceOfAnotherGetsAll) {
  for (int x = 0; x < 350; ++x) put(source, x, 0xff);
  now += 200s;
  source.join(kFirst);
  take_all(kFirst);
  source.leave(kFirst);
  for (int x = 0; x < 350; x += 2) put(source, x, 0xffff);
  stored.clear();
  source.join(kSecond);
  take_all(kSecond);
  EXPECT_EQ(stored.size(), 350U);
  EXPECT_EQ(known(10), 0xffffU);
  EXPECT_EQ(known(11), 0xffU);
}

TEST_F(BlockPiecesTest, WhatAPeerHasIsNotedWhileItJoins) {
  for (int x = 0; x < 350; ++x) put(source, x, 0xff);
  now += 200s;
  source.join(kFirst);
  source.has(kFirst, {0});
  for (int slice = 1; slice < 4; ++slice) source.tick(now);
  EXPECT_EQ(source.missing(kFirst), 0U);
  EXPECT_TRUE(source.complete(kFirst, 0));
}

}  // namespace
}  // namespace adit::agent
