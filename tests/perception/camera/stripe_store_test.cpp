// SPDX-License-Identifier: Apache-2.0
#include "perception/camera/stripe_store.hpp"

#include <gtest/gtest.h>
#include <random>

#include "perception/camera/stripe_encoder.hpp"
#include "tests/perception/camera/pictures.hpp"

namespace adit::perception {
namespace {

const PictureFormat kSmall{64, 64, false, 50, 2};  // 32 stripes.

/// A piece with stripes of a byte each. `digest`: of all that were sent until now.
PicturePiece small_piece(std::uint32_t frame, std::uint8_t number, std::uint8_t pieces,
                         std::initializer_list<int> stripes, std::uint32_t digest = 0) {
  PicturePiece piece;
  piece.header.run = 1;
  piece.header.frame = frame;
  piece.header.format = kSmall;
  piece.header.pieces = pieces;
  piece.header.number = number;
  piece.header.digest = digest;
  for (const int index : stripes)
    piece.stripes.push_back({static_cast<std::uint16_t>(index), {static_cast<std::uint8_t>(frame)}});
  return piece;
}

PicturePiece whole_picture(std::uint32_t frame) {
  PicturePiece piece = small_piece(frame, 0, 1, {});
  for (std::uint16_t i = 0; i < 32; ++i) piece.stripes.push_back({i, {static_cast<std::uint8_t>(frame)}});
  return piece;
}

/// Bits of the stripes [begin, end).
std::vector<std::uint8_t> bits(unsigned begin, unsigned end) {
  std::vector<std::uint8_t> out(4);
  for (unsigned i = begin; i < end; ++i) out[i / 8] = static_cast<std::uint8_t>(out[i / 8] | 1U << i % 8);
  return out;
}

TEST(CameraStore, StartsEmpty) {
  StripeStore store;
  EXPECT_FALSE(store.newest());
  EXPECT_FALSE(store.is_complete());
  EXPECT_TRUE(store.missing().empty());
  EXPECT_TRUE(store.as_jpeg().empty());
}

TEST(CameraStore, MarksWhatALostPieceMayHaveHad) {
  StripeStore store;
  EXPECT_TRUE(store.take(whole_picture(1)));
  EXPECT_TRUE(store.take(small_piece(2, 0, 4, {0, 5})));
  EXPECT_TRUE(store.take(small_piece(2, 2, 4, {10})));
  EXPECT_EQ(store.missing(false), bits(6, 10));
  auto late = bits(6, 10);
  late[1] = 0xfb;  // Stripe 10 came.
  late[2] = late[3] = 0xff;
  EXPECT_EQ(store.missing(), late);
  EXPECT_TRUE(store.take(small_piece(2, 3, 4, {20})));
  EXPECT_EQ(store.missing(), bits(6, 10));
  EXPECT_FALSE(store.is_complete());
  // The next picture makes it final, but for the stripes that come again.
  EXPECT_TRUE(store.take(small_piece(3, 0, 1, {7, 8, 9})));
  EXPECT_EQ(store.missing(), bits(6, 7));
  EXPECT_TRUE(store.absent().empty());
}

TEST(CameraStore, ALatePieceFillsItsGap) {
  StripeStore store;
  store.take(whole_picture(1));
  store.take(small_piece(2, 1, 2, {10}));
  EXPECT_EQ(store.missing(), bits(0, 10));
  EXPECT_TRUE(store.take(small_piece(2, 0, 2, {4})));
  EXPECT_TRUE(store.missing().empty());
  EXPECT_TRUE(store.is_complete());
}

TEST(CameraStore, ALostPictureIsInDoubtUntilTheDigestAgrees) {
  const auto digest = [](std::uint32_t newest) {
    std::uint32_t sum = 0;
    for (std::uint16_t i = 0; i < 32; ++i) {
      const std::vector<std::uint8_t> data{static_cast<std::uint8_t>(i == 3 ? newest : 1)};
      sum += stripe_digest(i, data);
    }
    return sum;
  };
  StripeStore store;
  store.take(whole_picture(1));
  store.take(small_piece(3, 0, 1, {}, digest(2)));  // Picture 2 had stripe 3.
  EXPECT_EQ(store.missing(), bits(0, 32));
  store.take(small_piece(5, 0, 1, {3}, digest(5)));
  EXPECT_TRUE(store.missing().empty());
  // A picture without a change that was lost leaves no doubt.
  store.take(small_piece(7, 0, 1, {}, digest(5)));
  EXPECT_TRUE(store.missing().empty());
}

TEST(CameraStore, RefusesOldPiecesAndTakesNewRuns) {
  StripeStore store;
  store.take(whole_picture(5));
  EXPECT_FALSE(store.take(whole_picture(5)));
  EXPECT_FALSE(store.take(whole_picture(4)));
  EXPECT_EQ(store.arrived(), 2u);
  EXPECT_FALSE(store.take(small_piece(5, 1, 2, {1})));  // Contradicts the first piece.
  PicturePiece next = small_piece(1, 0, 2, {0, 1});
  next.header.run = 9;
  EXPECT_TRUE(store.take(next));
  EXPECT_EQ(store.arrived(), 1u);
  EXPECT_EQ(store.absent(), bits(2, 32));
  next.header.frame = 2;
  next.header.format.quality = 60;
  EXPECT_TRUE(store.take(next));
  EXPECT_EQ(store.arrived(), 2u);
  EXPECT_EQ(store.absent(), bits(2, 32));
  next.header.frame = 3;
  next.header.format.span = 0;
  EXPECT_FALSE(store.take(next));
  // A stripe beyond the format, from a caller that did not decode.
  next.header.format = kSmall;
  next.stripes.push_back({500, {1}});
  EXPECT_TRUE(store.take(next));
}

TEST(CameraStore, ADamagedStripeSpoilsItsOwnPixelsAlone) {
  const Picture picture = pictures::textured(96, 64, 3);
  StripeEncoder encoder;
  const auto coded = encoder.encode(picture, {96, 64, true, 60, 0}, 150, Time{});
  std::vector<const std::vector<std::uint8_t>*> stripes;
  for (const Stripe& stripe : coded.stripes) stripes.push_back(&stripe.data);
  const auto good = decode_jpeg_tolerant(jpeg_of(coded.format, stripes), 999, 999);
  ASSERT_TRUE(good);
  std::minstd_rand random(8);
  for (int round = 0; round < 300; ++round) {
    const std::size_t bad = random() % stripes.size();
    std::vector<std::uint8_t> data(1 + random() % (round % 3 == 0 ? 900 : 60));
    for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random() >> 7);
    for (std::size_t i = 0; i < data.size(); ++i)
      if (data[i] == 0xff) data[i] = 0xfe;
    auto damaged = stripes;
    damaged[bad] = &data;
    const auto shown = decode_jpeg_tolerant(jpeg_of(coded.format, damaged), 999, 999);
    ASSERT_TRUE(shown) << shown.error().text;
    std::size_t spoiled = 0;
    for (std::uint32_t y = 0; y < 64; ++y)
      for (std::uint32_t x = 0; x < 96; ++x)
        if (coded.format.stripe_at(x, y) != bad &&
            shown->bytes[(y * 96 + x) * 3] != good->bytes[(y * 96 + x) * 3])
          ++spoiled;
    ASSERT_EQ(spoiled, 0u) << round;
  }
}

TEST(CameraMarks, GreyWhatIsOldAndShowWhatWas) {
  const PictureFormat format{32, 16, true, 50, 1};  // Two stripes.
  Picture picture{32, 16, 3, {}};
  for (int i = 0; i < 32 * 16; ++i) picture.bytes.insert(picture.bytes.end(), {200, 0, 0});
  const Picture whole = picture;
  mark_missing(picture, format, {}, {}, {});
  EXPECT_EQ(picture.bytes, whole.bytes);
  const std::vector<std::uint8_t> first{1}, second{2};
  mark_missing(picture, format, first, {}, {});
  EXPECT_EQ(picture.bytes[0], picture.bytes[1]);
  EXPECT_LT(picture.bytes[0], 200 * 77 / 256);
  EXPECT_EQ(picture.bytes[16 * 3], 200);
  // An absent one shows the picture before, of half the size, grey and darker.
  picture = whole;
  Picture former = pictures::flat(16, 8, 1, 80);
  former.bytes[8] = 160;
  mark_missing(picture, format, second, second, former);
  EXPECT_EQ(picture.bytes[0], 200);
  EXPECT_EQ(picture.bytes[16 * 3], 100);
  EXPECT_EQ(picture.bytes[18 * 3], 50);
  // At half the size.
  Picture half = pictures::flat(16, 8, 1, 80);
  mark_missing(half, format, second, {}, {});
  EXPECT_EQ(half.bytes[7], 80);
  EXPECT_EQ(half.bytes[8], 50);
}

}  // namespace
}  // namespace adit::perception
