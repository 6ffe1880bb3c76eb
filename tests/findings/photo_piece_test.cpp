// SPDX-License-Identifier: Apache-2.0
// Pieces of photos as they come by radio, genuine or not.
#include "core/findings/photo_piece.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "core/store/crc32c.hpp"
#include "core/time/random.hpp"

namespace adit::findings {
namespace {

PhotoPiece some_photo_piece() {
  return {.part = PhotoPart::picture,
          .content = 77,
          .bytes = 10'000,
          .first = 3,
          .data = store::Bytes(2 * kPhotoBlock, 9)};
}

store::Bytes resealed(store::Bytes bytes) {
  bytes.resize(bytes.size() - 4);
  const std::uint32_t sum = crc32c(bytes);
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(sum >> shift));
  return bytes;
}

TEST(PhotoPiece, ComesBackFromItsBytes) {
  const store::Bytes bytes = encode(some_photo_piece());
  EXPECT_LE(bytes.size(), PhotoPiece::kMaxBytes);
  EXPECT_EQ(bytes.size(), PhotoPiece::kHead + 2 * kPhotoBlock);
  const auto back = decode_photo_piece(bytes);
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(*back, some_photo_piece());
  PhotoPiece last = some_photo_piece();
  last.first = static_cast<std::uint16_t>(blocks_of(10'000) - 1);
  last.data.resize(10'000 - last.first * kPhotoBlock);
  EXPECT_TRUE(decode_photo_piece(encode(last)).ok());
  EXPECT_LE(PhotoPiece::kHead + kPhotoBlock, 356U) << "a piece on links below 250 kbit/s";
}

TEST(PhotoPiece, IsRefusedWhenItIsCutOrDamagedAtAnyByte) {
  const store::Bytes good = encode(some_photo_piece());
  for (std::size_t i = 0; i < good.size(); ++i) {
    EXPECT_FALSE(decode_photo_piece(std::span(good).first(i)).ok()) << i;
    store::Bytes bad = good;
    bad[i] ^= 0x20;
    EXPECT_FALSE(decode_photo_piece(bad).ok()) << i;
  }
  store::Bytes longer = good;
  longer.resize(PhotoPiece::kMaxBytes + 1);
  EXPECT_EQ(decode_photo_piece(longer).reason(), Reason::malformed);
}

TEST(PhotoPiece, WithACorrectChecksumIsRefusedForWhatItSays) {
  const auto refused = [](const std::function<void(PhotoPiece&)>& change) {
    PhotoPiece piece = some_photo_piece();
    change(piece);
    return decode_photo_piece(encode(piece)).reason();
  };
  EXPECT_EQ(refused([](PhotoPiece&) {}), Reason::none);
  EXPECT_EQ(refused([](PhotoPiece& p) { p.part = static_cast<PhotoPart>(2); }), Reason::malformed);
  EXPECT_EQ(refused([](PhotoPiece& p) { p.content = 0; }), Reason::malformed);
  EXPECT_EQ(refused([](PhotoPiece& p) { p.bytes = 0; }), Reason::malformed);
  EXPECT_EQ(refused([](PhotoPiece& p) { p.bytes = PhotoRef::kMaxBytes + 1; }), Reason::malformed);
  EXPECT_EQ(refused([](PhotoPiece& p) { p.bytes = UINT32_MAX; }), Reason::malformed);
  EXPECT_EQ(refused([](PhotoPiece& p) { p.part = PhotoPart::thumbnail; }), Reason::malformed) << "10 kB";
  EXPECT_EQ(refused([](PhotoPiece& p) { p.first = 65535; }), Reason::malformed);
  EXPECT_EQ(refused([](PhotoPiece& p) { p.first = static_cast<std::uint16_t>(blocks_of(10'000) - 1); }),
            Reason::malformed);
  EXPECT_EQ(refused([](PhotoPiece& p) { p.data.pop_back(); }), Reason::malformed);
  store::Bytes other = encode(some_photo_piece());
  other[0] = 2;
  EXPECT_EQ(decode_photo_piece(resealed(other)).reason(), Reason::wrong_protocol);
}

TEST(PhotoPiece, OfRandomBytesNeverDoesMoreThanRefuse) {
  Random random(5);
  for (int n = 0; n < 20'000; ++n) {
    store::Bytes bytes = encode(some_photo_piece());
    bytes.resize(random.below(2) == 0 ? bytes.size() : 4 + random.below(bytes.size() - 4));
    for (std::uint64_t k = random.below(6); k > 0; --k)
      bytes[random.below(bytes.size())] = static_cast<std::uint8_t>(random.next());
    const auto piece = decode_photo_piece(random.below(2) == 0 ? bytes : resealed(bytes));
    if (!piece) continue;
    const std::size_t end = piece->first * kPhotoBlock + piece->data.size();
    EXPECT_LE(end, piece->bytes);
    EXPECT_EQ(*decode_photo_piece(encode(*piece)), *piece);
  }
}

}  // namespace
}  // namespace adit::findings
