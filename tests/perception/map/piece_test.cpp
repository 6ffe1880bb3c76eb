// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/piece.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "core/store/crc32c.hpp"
#include "perception/map/submap_grid.hpp"

namespace adit::perception {
namespace {

const SubmapKey kKey{"wheeled_1", 0x0123456789abcdefu, 7};

/// Blocks of a corridor along x, 2 m wide: floor, walls, free space, and what was not seen.
std::vector<BlockUpdate> corridor(std::size_t count) {
  SubmapGrid grid;
  for (int step = 0; step < 160; ++step) {
    std::vector<Eigen::Vector3f> points;
    const float x0 = 0.5f * static_cast<float>(step);
    for (int n = 0; n < 400; ++n) {
      const float x = x0 + 0.01f * static_cast<float>(n) - 2.0f;
      points.push_back({x, 1.03f, 0.2f * static_cast<float>(n % 8) - 0.4f});
      points.push_back({x, -1.02f, 0.2f * static_cast<float>(n % 8) - 0.4f});
      points.push_back({x, 0.1f * static_cast<float>(n % 20) - 1.0f, -0.5f});
    }
    grid.insert({x0, 0.0f, 0.0f}, points, 20.0f);
  }
  std::vector<BlockUpdate> out;
  grid.for_each_block([&](const BlockIndex& index, std::uint32_t revision) {
    if (out.size() < count) out.push_back({*grid.coarse(index), revision});
  });
  return out;
}

std::vector<BlockUpdate> noise(std::size_t count) {
  std::mt19937_64 random(11);
  std::vector<BlockUpdate> out;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t known = random();
    const auto part = [&] { return static_cast<std::int32_t>(random() % 65535) - 32767; };
    out.push_back(
        {{{part(), part(), part()}, known, known & random()}, static_cast<std::uint32_t>(random())});
  }
  return out;
}

std::vector<BlockUpdate> sorted(std::vector<BlockUpdate> blocks) {
  std::sort(blocks.begin(), blocks.end(),
            [](const auto& a, const auto& b) { return a.block.index < b.block.index; });
  return blocks;
}

TEST(Piece, DecodesToWhatWasEncoded) {
  for (const auto& blocks : {corridor(40), corridor(500), noise(64), std::vector<BlockUpdate>{}}) {
    const auto piece = decode(encode(MapPiece{kKey, blocks}));
    ASSERT_TRUE(piece) << piece.error().text;
    EXPECT_EQ(piece->key, kKey);
    EXPECT_EQ(piece->blocks, sorted(blocks));
  }
}

TEST(Piece, HoldsABoundedNumberOfBlocks) {
  const auto piece = decode(encode(MapPiece{kKey, corridor(kMaxPieceBlocks + 40)}));
  ASSERT_TRUE(piece);
  EXPECT_EQ(piece->blocks.size(), kMaxPieceBlocks);
}

TEST(Piece, LeavesOutBlocksThatCannotBeCoded) {
  const CoarseBlock here{{1, 2, 3}, 7, 3}, newer{{1, 2, 3}, 15, 3}, far{{BlockIndex::kLimit, 0, 0}, 7, 3};
  const auto piece = decode(encode(MapPiece{kKey, {{newer, 9}, {here, 8}, {far, 10}}}));
  ASSERT_TRUE(piece);
  EXPECT_EQ(piece->blocks, (std::vector<BlockUpdate>{{newer, 9}}));
}

TEST(Piece, KeepsEachRevision) {
  auto blocks = corridor(40);
  for (std::size_t i = 0; i < blocks.size(); ++i)
    blocks[i].revision = static_cast<std::uint32_t>(0xffffffffu - 977 * i);
  const auto piece = decode(encode(MapPiece{kKey, blocks}));
  ASSERT_TRUE(piece);
  EXPECT_EQ(piece->blocks, blocks);
}

TEST(Piece, PacksAsManyBlocksAsFit) {
  for (const std::size_t max_bytes : {std::size_t{100}, std::size_t{500}, kMaxPieceBytes})
    for (const auto& blocks : {corridor(900), noise(200)}) {
      std::size_t at = 0, pieces = 0;
      ASSERT_GT(blocks.size(), 199u);
      while (at < blocks.size()) {
        const PackedPiece packed = pack(kKey, std::span(blocks).subspan(at), max_bytes);
        ASSERT_GT(packed.count, 0u);
        ASSERT_LE(packed.bytes.size(), max_bytes);
        const auto piece = decode(packed.bytes);
        ASSERT_TRUE(piece);
        ASSERT_EQ(piece->blocks.size(), packed.count);
        EXPECT_EQ(piece->blocks, sorted({blocks.begin() + static_cast<std::ptrdiff_t>(at),
                                         blocks.begin() + static_cast<std::ptrdiff_t>(at + packed.count)}));
        at += packed.count;
        // What is not the end is well filled.
        if (max_bytes > 100 && at < blocks.size() && packed.count < kMaxPieceBlocks) {
          EXPECT_GT(packed.bytes.size(), max_bytes * 3 / 4) << max_bytes;
        }
        ++pieces;
      }
      EXPECT_GT(pieces, 1u);
    }
  EXPECT_EQ(pack(kKey, {}, 1200).count, 0u);
}

TEST(Piece, OfLargerVoxelsShowsAllPartsAlike) {
  const CoarseBlock one{{1, 2, 3}, 0x21, 0x20}, other{{1, 2, 4}, 1ULL << 63, 0};
  const auto piece = decode(encode(MapPiece{kKey, {{one, 4, true}, {other, 4, true}}}));
  ASSERT_TRUE(piece);
  const CoarseBlock block{{1, 2, 3}, 0x0033'0033ULL, 0x0033'0033ULL},
      corner{{1, 2, 4}, 0xcc00'cc00ULL << 32, 0};
  EXPECT_EQ(piece->blocks, (std::vector<BlockUpdate>{{block, 4, true}, {corner, 4, true}}));
  EXPECT_EQ(piece->blocks.front().stored_revision(), BlockUpdate::kCoarseRevision);
  const auto blocks = corridor(200);
  auto large = blocks;
  for (BlockUpdate& update : large) update.coarse = true;
  EXPECT_LT(encode(MapPiece{kKey, large}).size(), encode(MapPiece{kKey, blocks}).size() * 3 / 4);
}

TEST(Piece, MayHaveBlocksInLargeAndInSmallVoxels) {
  auto blocks = corridor(200);
  std::map<std::pair<SubmapKey, BlockIndex>, CoarseBlock> stored;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    blocks[i].coarse = i % 3 == 0;
    if (i % 3 == 1) stored[{kKey, blocks[i].block.index}] = blocks[i].block;
  }
  const auto base = [&](const BlockIndex& index) -> std::optional<CoarseBlock> {
    const auto found = stored.find({kKey, index});
    return found != stored.end() ? std::optional(found->second) : std::nullopt;
  };
  const auto piece = decode(encode(MapPiece{kKey, blocks}, base),
                            [&](const SubmapKey&, const BlockIndex& index) { return base(index); });
  ASSERT_TRUE(piece) << piece.error().text;
  auto wanted = sorted(blocks);
  for (BlockUpdate& update : wanted)
    if (update.coarse) update.block = in_large_voxels(update.block);
  EXPECT_EQ(piece->blocks, wanted);
}

TEST(Piece, OfChangesNeedsTheChangedBlocks) {
  auto blocks = corridor(100);
  std::map<std::pair<SubmapKey, BlockIndex>, CoarseBlock> stored;
  for (BlockUpdate& update : blocks) {
    stored[{kKey, update.block.index}] = update.block;
    update.block.known |= 0xff00, update.block.occupied ^= update.block.known & 4;
  }
  const FindStored find_stored = [&](const SubmapKey& key, const BlockIndex& index) {
    const auto found = stored.find({key, index});
    return found != stored.end() ? std::optional(found->second) : std::nullopt;
  };
  const auto find_base = [&](const BlockIndex& index) { return find_stored(kKey, index); };
  const auto packed = pack(kKey, blocks, kMaxPieceBytes, find_base);
  ASSERT_EQ(packed.count, blocks.size());
  EXPECT_LT(packed.bytes.size(), encode(MapPiece{kKey, blocks}).size());
  const auto piece = decode(packed.bytes, find_stored);
  ASSERT_TRUE(piece) << piece.error().text;
  EXPECT_EQ(piece->blocks, sorted(blocks));
  EXPECT_EQ(decode(packed.bytes).reason(), Reason::out_of_range);
  stored.begin()->second.occupied ^= 1;
  EXPECT_EQ(decode(packed.bytes, find_stored).reason(), Reason::out_of_range);
}

TEST(Piece, ACorridorTakesFewBytesABlock) {
  auto blocks = corridor(200);
  for (BlockUpdate& update : blocks) update.revision = 500;
  EXPECT_LT(encode(MapPiece{kKey, blocks}).size(), 3 * blocks.size() / 2);
}

TEST(Piece, IsRefusedWhenItIsDamaged) {
  const auto blocks = corridor(20);
  const auto complete = encode(MapPiece{kKey, blocks});
  for (std::size_t size = 0; size < complete.size(); ++size)
    EXPECT_FALSE(decode(std::span(complete).first(size)));
  std::mt19937 random(13);
  for (int n = 0; n < 3000; ++n) {
    auto bytes = complete;
    const int flips = 1 + static_cast<int>(random() % 3);
    for (int i = 0; i < flips; ++i)
      bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    if (bytes == complete) continue;
    const auto piece = decode(bytes);
    // Some bits of Zstandard's header mean nothing; the content is checked.
    EXPECT_TRUE(!piece || piece->blocks == blocks);
  }
}

/// A piece with any content behind the checksum.
std::vector<std::uint8_t> piece_of(std::uint8_t version, std::uint8_t kind,
                                   std::span<const std::uint8_t> content) {
  std::vector<std::uint8_t> out{version, kind};
  std::vector<std::uint8_t> summed = out;
  summed.insert(summed.end(), content.begin(), content.end());
  const std::uint32_t sum = crc32c(summed);
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(sum >> 8 * i));
  out.insert(out.end(), content.begin(), content.end());
  return out;
}

TEST(Piece, IsRefusedWhenItsContentIsHostile) {
  const std::vector<std::uint8_t> complete = encode(MapPiece{kKey, corridor(20)});
  const std::vector<std::uint8_t> content(complete.begin() + 6, complete.end());
  ASSERT_TRUE(decode(piece_of(5, complete[1], content)));
  EXPECT_EQ(decode(encode(SubmapPoses{})).reason(), Reason::malformed);
  EXPECT_EQ(decode(piece_of(5, complete[1], std::vector<std::uint8_t>(1 << 20))).reason(), Reason::malformed);
  EXPECT_EQ(decode(encode(MapPiece{{"", 1, 2}, {}})).reason(), Reason::malformed);
}

TEST(Piece, OfAnotherVersionOrOtherTablesIsRefusedByName) {
  const std::vector<std::uint8_t> complete = encode(MapPiece{kKey, corridor(20)});
  const std::vector<std::uint8_t> content(complete.begin() + 6, complete.end());
  for (const int version : {0, 1, 2, 3, 4, 255})
    EXPECT_EQ(decode(piece_of(static_cast<std::uint8_t>(version), complete[1], content)).reason(),
              Reason::wrong_protocol);
  EXPECT_EQ(decode(piece_of(5, static_cast<std::uint8_t>(complete[1] + 0x10), content)).reason(),
            Reason::wrong_protocol);
}

TEST(Piece, RandomContentDoesNoHarm) {
  std::mt19937 random(17);
  const std::uint8_t kind = encode(MapPiece{kKey, {}})[1];
  std::size_t decoded = 0;
  for (int n = 0; n < 3000; ++n) {
    std::vector<std::uint8_t> content(12 + random() % 1200);
    for (std::uint8_t& byte : content) byte = static_cast<std::uint8_t>(random());
    content[0] = 1;
    content[1] = 'r';
    // Small numbers at the beginning lead farther.
    if (n % 2 == 0 && content.size() > 14) content[10] = static_cast<std::uint8_t>(random() % 8);
    if (const auto piece = decode(piece_of(5, kind, content))) {
      ++decoded;
      ASSERT_LE(piece->blocks.size(), kMaxPieceBlocks);
      for (const BlockUpdate& u : piece->blocks) ASSERT_EQ(u.block.occupied & ~u.block.known, 0u);
    }
    if (const auto poses = decode_poses(piece_of(5, 2, content))) {
      for (const SubmapPose& p : poses->poses) ASSERT_TRUE(p.T_map_submap.position.allFinite());
    }
  }
  EXPECT_GT(decoded, 0u);
}

TEST(SubmapPoses, DecodeToWhatWasEncodedWithinTheirUnits) {
  SubmapPoses sent;
  std::mt19937 random(19);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (std::uint32_t i = 0; i < kMaxPiecePoses; ++i) {
    SubmapPose pose{{i < 20 ? "a" : "legged_2", i < 20 ? 5u : 6u, i}, {}, 3 * i};
    pose.T_map_submap.position = 500.0 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    pose.T_map_submap.orientation =
        Eigen::Quaterniond(uniform(random), uniform(random), uniform(random), uniform(random)).normalized();
    sent.poses.push_back(pose);
  }
  const auto bytes = encode(sent);
  EXPECT_LE(bytes.size(), kMaxPieceBytes);
  const auto got = decode_poses(bytes);
  ASSERT_TRUE(got);
  ASSERT_EQ(got->poses.size(), sent.poses.size());
  for (std::size_t i = 0; i < sent.poses.size(); ++i) {
    const SubmapPose &a = sent.poses[i], &b = got->poses[i];
    EXPECT_EQ(a.key, b.key);
    EXPECT_EQ(a.revision, b.revision);
    EXPECT_LT((a.T_map_submap.position - b.T_map_submap.position).norm(), 1e-3);
    EXPECT_LT(a.T_map_submap.orientation.angularDistance(b.T_map_submap.orientation), 1e-4);
  }
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_poses(std::span(bytes).first(size)));
  std::mt19937 flips(23);
  for (int n = 0; n < 2000; ++n) {
    auto damaged = bytes;
    damaged[flips() % damaged.size()] ^= static_cast<std::uint8_t>(1u << flips() % 8);
    const auto poses = decode_poses(damaged);
    EXPECT_TRUE(!poses || poses->poses.size() == sent.poses.size());
  }
}

}  // namespace
}  // namespace adit::perception
