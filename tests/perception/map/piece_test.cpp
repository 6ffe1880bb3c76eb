// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/piece.hpp"

#include <gtest/gtest.h>
#include <zstd.h>

#include <cmath>
#include <random>

#include "perception/map/submap_grid.hpp"
#include "perception/stream/byte_stream.hpp"

namespace adit::perception {
namespace {

const SubmapKey kKey{"wheeled_1", 0x0123456789abcdefu, 7};

/// Blocks of a corridor along x, 2 m wide: floor, walls, free space, and what was not seen.
std::vector<BlockUpdate> corridor(std::size_t count) {
  SubmapGrid grid;
  for (int step = 0; step < 60; ++step) {
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

TEST(Piece, DecodesToWhatWasEncoded) {
  for (const auto& blocks : {corridor(40), noise(64), std::vector<BlockUpdate>{}}) {
    const auto piece = decode(encode(MapPiece{kKey, blocks}));
    ASSERT_TRUE(piece) << piece.error().text;
    EXPECT_EQ(piece->key, kKey);
    EXPECT_EQ(piece->blocks, blocks);
  }
}

TEST(Piece, HoldsAtMost64Blocks) {
  const auto piece = decode(encode(MapPiece{kKey, noise(100)}));
  ASSERT_TRUE(piece);
  EXPECT_EQ(piece->blocks.size(), 64u);
}

TEST(Piece, PacksAsManyBlocksAsFit) {
  for (const std::size_t max_bytes : {std::size_t{100}, std::size_t{500}, kMaxPieceBytes})
    for (const auto& blocks : {corridor(200), noise(200)}) {
      std::size_t at = 0, pieces = 0;
      while (at < blocks.size()) {
        const PackedPiece packed = pack(kKey, std::span(blocks).subspan(at), max_bytes);
        ASSERT_GT(packed.count, 0u);
        ASSERT_LE(packed.bytes.size(), max_bytes);
        const auto piece = decode(packed.bytes);
        ASSERT_TRUE(piece);
        ASSERT_EQ(piece->blocks.size(), packed.count);
        EXPECT_EQ(piece->blocks.front(), blocks[at]);
        at += packed.count;
        // What is not the end is well filled.
        if (max_bytes > 100 && at < blocks.size() && packed.count < 64) {
          EXPECT_GT(packed.bytes.size(), max_bytes * 3 / 4) << max_bytes;
        }
        ++pieces;
      }
      EXPECT_GT(pieces, 1u);
    }
  EXPECT_EQ(pack(kKey, {}, 1200).count, 0u);
}

TEST(Piece, ACorridorTakesFewBytesABlock) {
  const auto blocks = corridor(64);
  EXPECT_LT(encode(MapPiece{kKey, blocks}).size(), 12 * blocks.size());
}

TEST(Piece, IsRefusedWhenItIsDamaged) {
  const auto blocks = corridor(20);
  const auto whole = encode(MapPiece{kKey, blocks});
  for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_FALSE(decode(std::span(whole).first(size)));
  std::mt19937 random(13);
  for (int n = 0; n < 3000; ++n) {
    auto bytes = whole;
    const int flips = 1 + static_cast<int>(random() % 3);
    for (int i = 0; i < flips; ++i)
      bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    if (bytes == whole) continue;
    const auto piece = decode(bytes);
    // Some bits of Zstandard's header mean nothing; the content is checked.
    EXPECT_TRUE(!piece || piece->blocks == blocks);
  }
}

/// A piece with any content.
std::vector<std::uint8_t> piece_of(std::uint8_t kind, std::span<const std::uint8_t> content) {
  std::vector<std::uint8_t> out(2 + ZSTD_compressBound(content.size()));
  out[0] = 1;
  out[1] = kind;
  out.resize(2 + ZSTD_compress(out.data() + 2, out.size() - 2, content.data(), content.size(), 3));
  return out;
}

TEST(Piece, IsRefusedWhenItsContentIsHostile) {
  EXPECT_EQ(decode(std::vector<std::uint8_t>{2, 1, 0, 0}).reason(), Reason::wrong_protocol);
  EXPECT_EQ(decode(encode(SubmapPoses{})).reason(), Reason::malformed);
  // A megabyte of zeros in a few bytes.
  EXPECT_EQ(decode(piece_of(1, std::vector<std::uint8_t>(1 << 20))).reason(), Reason::malformed);
  const auto content = [](std::int64_t x, std::uint8_t shape, std::uint64_t known, std::uint64_t occupied) {
    ByteWriter out;
    out.text("r");
    out.u64(1);
    out.varint(0);
    out.u8(1);
    out.zigzag(x);
    out.zigzag(0);
    out.zigzag(0);
    out.zigzag(3);
    out.u8(shape);
    out.u64(known);
    out.u64(occupied);
    return out.bytes();
  };
  EXPECT_TRUE(decode(piece_of(1, content(5, 0, 3, 1))));
  EXPECT_EQ(decode(piece_of(1, content(5, 0, 1, 3))).reason(), Reason::malformed);
  EXPECT_EQ(decode(piece_of(1, content(5, 4, 3, 1))).reason(), Reason::malformed);
  EXPECT_EQ(decode(piece_of(1, content(5, 1, 3, 1))).reason(), Reason::malformed);
  EXPECT_EQ(decode(piece_of(1, content(BlockIndex::kLimit, 0, 3, 1))).reason(), Reason::malformed);
  EXPECT_EQ(decode(piece_of(1, content(std::numeric_limits<std::int64_t>::min(), 0, 3, 1))).reason(),
            Reason::malformed);
  EXPECT_EQ(decode(encode(MapPiece{{"", 1, 2}, {}})).reason(), Reason::malformed);
}

TEST(Piece, RandomContentDoesNoHarm) {
  std::mt19937 random(17);

  for (int n = 0; n < 4000; ++n) {
    std::vector<std::uint8_t> content(random() % 80);
    for (std::uint8_t& byte : content)
      byte = static_cast<std::uint8_t>(random() % 3 == 0 ? random() : random() % 4);
    if (content.size() > 12) {
      content[0] = 1;
      content[11] = static_cast<std::uint8_t>(random() % 3);
    }
    for (const std::uint8_t kind : {std::uint8_t{1}, std::uint8_t{2}}) {
      const auto bytes = piece_of(kind, content);
      if (const auto piece = decode(bytes)) {
        for (const BlockUpdate& u : piece->blocks) ASSERT_EQ(u.block.occupied & ~u.block.known, 0u);
      }
      if (const auto poses = decode_poses(bytes)) {
        for (const SubmapPose& p : poses->poses) ASSERT_TRUE(p.T_map_submap.position.allFinite());
      }
    }
  }
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
    EXPECT_LT((a.T_map_submap.position - b.T_map_submap.position).norm(), 2e-4);
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
