// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/time/random.hpp"
#include "perception/map/voxel_image.hpp"
#include "perception/stream/piece.hpp"
#include "robot_agent/perception/block_source.hpp"

namespace adit::agent {
namespace {

using perception::BlockIndex;
using perception::CoarseBlock;
using transfer::PeerId;

constexpr PeerId kEarly{1}, kLate{2};

/// A robot that drives to and fro past the same 10 x 10 blocks: submap after submap sees them, each with a
/// few errors, and in between the world changes.
class BlockCulling : public testing::Test {
 protected:
  static constexpr int kSize = 10;
  using Map = std::map<std::uint32_t, std::map<BlockIndex, perception::BlockUpdate>>;

  void drive(std::uint32_t submap) {
    const BlockIndex offset{static_cast<int>(submap) * 3, 0, 1};
    source.open(submap, {5, submap, 1, offset});
    if (submap % 3 == 2) world[random.below(world.size())] ^= random.next() & random.next();
    for (int round = 0; round < 4; ++round)
      for (int cell = 0; cell < kSize * kSize; ++cell) {
        const std::uint64_t known = round == 0 ? random.next() : ~std::uint64_t{0};
        const std::uint64_t error = random.chance(0.1) ? std::uint64_t{1} << random.below(64) : 0;
        const CoarseBlock block{{cell % kSize - offset.x, cell / kSize - offset.y, -offset.z},
                                known,
                                (world[static_cast<std::size_t>(cell)] ^ error) & known};
        source.update(submap, block);
        own[submap][block.index] = {block, 0};
        if (cell % 25 == 0) exchange(1);
      }
  }
  void exchange(int rounds) {
    for (; rounds > 0; --rounds, now += 250ms) {
      std::vector<PeerId> peers;
      for (const auto& [id, has] : stations) peers.push_back(id);
      std::sort(peers.begin(), peers.end(),
                [&](const PeerId& a, const PeerId& b) { return source.missing(a) > source.missing(b); });
      if (peers.empty()) continue;
      const auto content = source.next(peers, 1200, now);
      if (!content) continue;
      for (const PeerId& peer : peers) {
        const auto piece = perception::decode(content->data, [&](const auto& key, const BlockIndex& index) {
          const auto known = stations[peer][key.index].find(index);
          return known != stations[peer][key.index].end() ? std::optional(known->second.block) : std::nullopt;
        });
        ASSERT_TRUE(piece.ok()) << piece.error().text;
        if (random.chance(0.2)) {
          source.lost(peer, content->token);
          continue;
        }
        for (const auto& update : piece->blocks) {
          ++received[peer];
          auto& known = stations[peer][piece->key.index][update.block.index];
          if (update.revision > known.revision && (!update.coarse || known.coarse || known.revision == 0))
            known = update;
        }
        source.acknowledged(peer, content->token);
      }
      source.settled(content->token);
    }
  }
  void join(const PeerId& peer) {
    source.join(peer);
    stations[peer] = {};
  }
  static perception::VoxelImage merged(const Map& map) {
    perception::VoxelImage image(CoarseBlock::kVoxel);
    for (const auto& [submap, blocks] : map) {
      std::vector<CoarseBlock> all;
      for (const auto& [index, update] : blocks) all.push_back(update.block);
      const Eigen::Vector3d at = 0.8 * Eigen::Vector3d(3.0 * submap, 0, 1);
      image.add({at, Eigen::Quaterniond::Identity()}, all);
    }
    return image;
  }
  /// Voxels that the station shows otherwise than the robot.
  std::size_t different(const PeerId& peer) {
    const auto all = merged(own), shown = merged(stations[peer]);
    std::size_t out = 0;
    all.for_each(
        [&](const auto& index, perception::Voxel voxel) { out += shown.at(index) != voxel ? 1 : 0; });
    shown.for_each(
        [&](const auto& index, perception::Voxel voxel) { out += all.at(index) != voxel ? 1 : 0; });
    return out;
  }

  BlockSource source{{.robot = "r1", .start = 5}};
  Random random{11};
  Time now{100s};
  std::vector<std::uint64_t> world = [this] {
    std::vector<std::uint64_t> out(kSize * kSize);
    for (std::uint64_t& block : out) block = random.chance(0.5) ? 0 : random.next() & random.next();
    return out;
  }();
  Map own{};
  std::map<PeerId, Map> stations{};
  std::map<PeerId, std::size_t> received{};
};

TEST_F(BlockCulling, TheStationsMergeIsThatOfAllBlocksWhateverIsLost) {
  join(kEarly);
  for (std::uint32_t submap = 0; submap < 12; ++submap) {
    drive(submap);
    exchange(400);
    EXPECT_EQ(different(kEarly), 0U) << submap;
  }
}

TEST_F(BlockCulling, APlaceThatWasSeenManyTimesCostsLittleMore) {
  join(kEarly);
  drive(0);
  exchange(400);
  const std::size_t once = received[kEarly];
  for (std::uint32_t submap = 1; submap < 12; ++submap) {
    drive(submap);
    exchange(400);
  }
  EXPECT_LT(received[kEarly], 6 * once);
}

TEST_F(BlockCulling, APlaceTakesTheSpaceOfAFewSubmapsHoweverOftenItIsSeen) {
  for (std::uint32_t submap = 0; submap < 30; ++submap) {
    drive(submap);
    EXPECT_LE(source.size(), 4U * kSize * kSize);
  }
  EXPECT_EQ(source.dropped(), 0U);
  EXPECT_GT(source.take_pruned(0), 0U);
  EXPECT_EQ(source.take_pruned(0), 0U);
  join(kLate);
  exchange(400);
  EXPECT_EQ(different(kLate), 0U);
}

TEST_F(BlockCulling, ALateStationGetsOnlyTheBlocksThatShow) {
  for (std::uint32_t submap = 0; submap < 12; ++submap) drive(submap);
  join(kLate);
  const std::size_t lacks = source.missing(kLate);
  EXPECT_LT(lacks, 3U * kSize * kSize);
  EXPECT_TRUE(source.is_covered(9));
  EXPECT_FALSE(source.is_covered(11));
  exchange(400);
  EXPECT_EQ(different(kLate), 0U);
}

TEST_F(BlockCulling, TwoStationsShowTheSameAfterALateJoinAndAnAbsence) {
  join(kEarly);
  for (std::uint32_t submap = 0; submap < 3; ++submap) drive(submap);
  join(kLate);
  drive(3);
  const Map away = stations[kEarly];
  stations.erase(kEarly);  // It is silent: the sender does not serve it.
  for (std::uint32_t submap = 4; submap < 8; ++submap) drive(submap);
  exchange(400);
  EXPECT_EQ(different(kLate), 0U);
  stations[kEarly] = away;
  exchange(800);
  EXPECT_EQ(different(kEarly), 0U);
  EXPECT_EQ(different(kLate), 0U);
}

}  // namespace
}  // namespace adit::agent
