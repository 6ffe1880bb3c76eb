// SPDX-License-Identifier: Apache-2.0
#include "core/transfer/shot_piece.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/time/random.hpp"

namespace adit::transfer {
namespace {

ShotPiece piece_of(std::size_t bytes = 2 * kShotBlock) {
  ShotPiece piece{.camera = "front",
                  .number = 3,
                  .stamp = 7'000'000'000,
                  .age = 250,
                  .place = {{1.0F, 2.0F, 0.5F, 0.1F}},
                  .bytes = 100'000,
                  .crc = 99,
                  .first = 4};
  piece.data.assign(bytes, 0xFF);
  return piece;
}

TEST(ShotPieceTest, ReturnsFromItsBytes) {
  for (const bool placed : {true, false}) {
    ShotPiece piece = piece_of();
    if (!placed) piece.place.reset();
    const auto bytes = encode(piece);
    EXPECT_EQ(bytes.size(), piece.head() + piece.data.size());
    const auto read = decode_shot_piece(bytes);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(*read, piece);
  }
}

TEST(ShotPieceTest, TheLastBlockMayBeShort) {
  ShotPiece piece = piece_of(10);
  piece.bytes = 4 * kShotBlock + 10;
  EXPECT_TRUE(decode_shot_piece(encode(piece)).ok());
  piece.bytes += 1;
  EXPECT_EQ(decode_shot_piece(encode(piece)).reason(), Reason::malformed) << "a block that is not whole";
}

TEST(ShotPieceTest, RefusesWhatNoRobotSends) {
  const auto refused = [](auto change) {
    ShotPiece piece = piece_of();
    change(piece);
    return decode_shot_piece(encode(piece)).reason() == Reason::malformed;
  };
  EXPECT_TRUE(refused([](ShotPiece& p) { p.camera = "a b"; }));
  EXPECT_TRUE(refused([](ShotPiece& p) { p.camera = ""; }));
  EXPECT_TRUE(refused([](ShotPiece& p) { p.number = 0; }));
  EXPECT_TRUE(refused([](ShotPiece& p) { p.bytes = ShotPiece::kMaxPicture + 1; }));
  EXPECT_TRUE(refused([](ShotPiece& p) { p.bytes = 0; }));
  EXPECT_TRUE(refused([](ShotPiece& p) { p.first = 400; })) << "outside of the picture";
  EXPECT_TRUE(refused([](ShotPiece& p) { p.data.clear(); }));
  EXPECT_TRUE(refused([](ShotPiece& p) { (*p.place)[0] = std::nanf(""); }));
  EXPECT_TRUE(refused([](ShotPiece& p) { p.data.resize(5 * kShotBlock); })) << "longer than a piece may be";
}

TEST(ShotPieceTest, ChangedBytesAreRefused) {
  const auto good = encode(piece_of());
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    auto bytes = good;
    bytes[random.below(bytes.size())] ^= static_cast<std::uint8_t>(1 + random.below(255));
    if (i % 3 == 0) bytes.resize(random.below(bytes.size()));
    EXPECT_FALSE(decode_shot_piece(bytes).ok());
  }
}

}  // namespace
}  // namespace adit::transfer
