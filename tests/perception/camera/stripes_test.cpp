// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <algorithm>
#include <random>
#include <set>

#include "perception/camera/stripe_encoder.hpp"
#include "perception/camera/stripe_store.hpp"
#include "tests/perception/camera/pictures.hpp"

namespace adit::perception {
namespace {

constexpr std::size_t kStripeMost = 180, kPieceMost = 500;

/// A camera and its link, to be driven picture by picture.
struct CameraSender {
  StripeEncoder encoder{};
  PictureFormat wanted{};
  std::uint32_t frame{};
  Time now{};

  StripeEncoder::Coded last{};
  std::vector<PicturePiece> next(const Picture& picture, Duration period = 500ms) {
    now += period;
    last = encoder.encode(picture, wanted, kStripeMost, now);
    PictureHeader header;
    header.run = 7;
    header.frame = ++frame;
    header.format = last.format;
    header.digest = last.digest;
    return cut(header, last.stripes, kPieceMost);
  }
};

bool take_all(StripeStore& store, const std::vector<PicturePiece>& pieces) {
  bool all = true;
  for (const PicturePiece& piece : pieces) {
    const auto bytes = encode(piece);
    EXPECT_LE(bytes.size(), kPieceMost);
    all = store.take(*decode_picture_piece(bytes)) && all;
  }
  return all;
}

Picture shown(const StripeStore& store) {
  const auto jpeg = store.as_jpeg();
  EXPECT_TRUE(decode_jpeg(jpeg, 2000, 2000));  // Without a warning.
  auto picture = decode_jpeg_tolerant(jpeg, 2000, 2000);
  return picture ? *picture : Picture{};
}

bool is_set(const std::vector<std::uint8_t>& bits, std::uint32_t index) {
  return index / 8 < bits.size() && (bits[index / 8] >> index % 8 & 1) != 0;
}

/// The stripes in which two pictures differ.
std::set<std::uint32_t> different(const Picture& a, const Picture& b, const PictureFormat& format) {
  std::set<std::uint32_t> out;
  for (std::uint32_t y = 0; y < a.height; ++y)
    for (std::uint32_t x = 0; x < a.width; ++x)
      for (std::size_t c = 0; c < a.channels; ++c) {
        const std::size_t i = (std::size_t{y} * a.width + x) * a.channels + c;
        if (a.bytes[i] != b.bytes[i]) out.insert(format.stripe_at(x, y));
      }
  return out;
}

std::set<std::uint32_t> indices(const std::vector<std::uint8_t>& bits, const PictureFormat& format) {
  std::set<std::uint32_t> out;
  for (std::uint32_t i = 0; i < format.stripes(); ++i)
    if (is_set(bits, i)) out.insert(i);
  return out;
}

TEST(CameraStripes, GiveThePictureBackAtAllSizes) {
  for (const auto& [width, height] : {std::pair{161, 121}, {8, 8}, {1, 1}, {320, 240}, {600, 130}, {17, 300}})
    for (const bool colour : {false, true}) {
      const Picture picture = pictures::textured(static_cast<std::uint32_t>(width),
                                                 static_cast<std::uint32_t>(height), colour ? 3 : 1);
      CameraSender sender;
      sender.wanted = {static_cast<std::uint16_t>(width), static_cast<std::uint16_t>(height), colour, 80, 0};
      StripeStore store;
      EXPECT_TRUE(take_all(store, sender.next(picture)));
      EXPECT_TRUE(sender.last.whole);
      EXPECT_TRUE(store.is_complete());
      EXPECT_TRUE(store.missing().empty());
      EXPECT_TRUE(store.absent().empty());
      EXPECT_GT(pictures::psnr(shown(store), picture), 27.0) << width << " " << height << " " << colour;
      for (const Stripe& stripe : sender.last.stripes) EXPECT_LE(stripe.data.size(), kStripeMost);
    }
}

TEST(CameraStripes, EachDecodesAloneInItsPlace) {
  const Picture picture = pictures::textured(168, 120, 3);
  CameraSender sender;
  sender.wanted = {168, 120, true, 70, 0};
  StripeStore whole;
  take_all(whole, sender.next(picture));
  const Picture full = shown(whole);
  const PictureFormat format = sender.last.format;
  ASSERT_GT(format.stripes(), 8u);
  for (const Stripe& stripe : sender.last.stripes) {
    std::vector<const std::vector<std::uint8_t>*> one(format.stripes());
    one[stripe.index] = &stripe.data;
    const auto alone = decode_jpeg_tolerant(jpeg_of(format, one), 2000, 2000);
    ASSERT_TRUE(alone);
    for (std::uint32_t y = 0; y < full.height; ++y)
      for (std::uint32_t x = 0; x < full.width; ++x) {
        const std::size_t i = (std::size_t{y} * full.width + x) * 3;
        const bool inside = format.stripe_at(x, y) == stripe.index;
        ASSERT_EQ(alone->bytes[i], inside ? full.bytes[i] : 128) << stripe.index << " at " << x << " " << y;
      }
  }
}

TEST(CameraStripes, LossLeavesTheMarkedStripesAlone) {
  std::minstd_rand random(9);
  for (int round = 0; round < 6; ++round) {
    CameraSender sender;
    sender.wanted = {200, 152, round % 2 == 0, 60, 0};
    const std::uint8_t channels = sender.wanted.colour ? 3 : 1;
    StripeStore full, lossy;
    for (const std::uint8_t change : {0x00, 0x40}) {  // Every pixel changes.
      Picture picture = pictures::textured(200, 152, channels);
      for (std::uint8_t& byte : picture.bytes) byte ^= change;
      const auto pieces = sender.next(picture);
      take_all(full, pieces);
      for (const PicturePiece& piece : pieces)
        if (change == 0 || (random() % 4 != 0 && piece.header.number != round % 3)) lossy.take(piece);
    }
    ASSERT_FALSE(lossy.is_complete());
    EXPECT_EQ(different(shown(full), shown(lossy), sender.last.format),
              indices(lossy.missing(), sender.last.format));
  }
}

TEST(CameraStripes, UnchangedOnesAreNotSent) {
  Picture picture = pictures::textured(160, 120, 1);
  CameraSender sender;
  sender.wanted = {160, 120, false, 40, 0};
  sender.next(picture);
  EXPECT_TRUE(sender.last.whole);
  std::minstd_rand random(4);
  for (int i = 0; i < 5; ++i) {
    Picture noisy = picture;
    for (std::uint8_t& byte : noisy.bytes) byte = static_cast<std::uint8_t>(byte + random() % 5 - 2);
    const auto pieces = sender.next(noisy, 100ms);
    EXPECT_TRUE(sender.last.stripes.empty());
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(pieces[0].header.pieces, 1);
  }
}

TEST(CameraStripes, ASmallObjectIsSent) {
  const Picture still = pictures::textured(320, 240, 3);
  CameraSender sender;
  sender.wanted = {320, 240, true, 40, 0};
  StripeStore store;
  take_all(store, sender.next(still, 100ms));
  for (std::uint32_t step = 0; step < 5; ++step) {
    Picture moved = still;
    for (std::uint32_t y = 100; y < 116; ++y)
      for (std::uint32_t x = 40 + 16 * step; x < 56 + 16 * step; ++x)
        moved.bytes[(std::size_t{y} * 320 + x) * 3] = static_cast<std::uint8_t>(x * y);
    take_all(store, sender.next(moved, 100ms));
    ASSERT_FALSE(sender.last.stripes.empty());
    EXPECT_LT(sender.last.stripes.size(), sender.last.format.stripes() / 8);
    EXPECT_GT(pictures::psnr(shown(store), moved), 26.0);
  }
}

TEST(CameraStripes, SlowChangesAreSentInTheEnd) {
  CameraSender sender;
  sender.wanted = {64, 64, false, 40, 0};
  sender.next(pictures::flat(64, 64, 1, 100), 10ms);
  std::size_t sent = 0;
  for (std::uint8_t value = 101; value < 107; ++value) {
    sender.next(pictures::flat(64, 64, 1, value), 10ms);
    sent += sender.last.stripes.size();
  }
  EXPECT_EQ(sent, sender.last.format.stripes());
}

TEST(CameraStripes, AllAreRefreshedSpreadOverTime) {
  const Picture picture = pictures::textured(160, 120, 1);
  CameraSender sender;
  sender.wanted = {160, 120, false, 40, 0};
  sender.next(picture);
  const std::size_t all = sender.last.format.stripes();
  for (int cycle = 0; cycle < 3; ++cycle) {
    std::multiset<std::uint16_t> refreshed;
    for (int i = 0; i < 20; ++i) {
      sender.next(picture);
      EXPECT_LT(sender.last.stripes.size(), all / 2);
      for (const Stripe& stripe : sender.last.stripes) refreshed.insert(stripe.index);
    }
    EXPECT_EQ(refreshed.size(), all) << cycle;
    for (std::uint16_t i = 0; i < all; ++i) EXPECT_EQ(refreshed.count(i), 1u);
  }
}

TEST(CameraStripes, MissingOnesAreSentAgain) {
  const Picture picture = pictures::textured(320, 240, 3);
  CameraSender sender;
  sender.wanted = {320, 240, true, 40, 0};
  StripeStore store;
  auto pieces = sender.next(picture);
  ASSERT_GT(pieces.size(), 4u);
  pieces.erase(pieces.begin() + 2);
  take_all(store, pieces);
  const auto missing = store.missing();
  EXPECT_EQ(missing, store.absent());
  sender.encoder.missing(missing);
  take_all(store, sender.next(picture));
  EXPECT_EQ(sender.last.stripes.size(), indices(missing, sender.last.format).size());
  EXPECT_TRUE(store.missing().empty());
  sender.next(picture);
  EXPECT_TRUE(sender.last.stripes.empty());
  sender.encoder.reset();
  sender.next(picture);
  EXPECT_TRUE(sender.last.whole);
}

TEST(CameraStripes, AnotherFormatSendsAll) {
  const Picture picture = pictures::textured(160, 120, 3);
  CameraSender sender;
  StripeStore store;
  for (const PictureFormat format :
       {PictureFormat{160, 120, true, 40, 0}, PictureFormat{160, 120, true, 50, 0},
        PictureFormat{160, 120, false, 50, 0}}) {
    sender.wanted = format;
    take_all(store, sender.next(picture));
    EXPECT_TRUE(sender.last.whole);
    EXPECT_EQ(store.newest()->format, sender.last.format);
    EXPECT_EQ(shown(store).channels, format.colour ? 3 : 1);
  }
  // A picture of another size than the format is not coded, nor a format out of bounds.
  sender.wanted = {80, 120, false, 50, 0};
  EXPECT_EQ(sender.encoder.encode(picture, sender.wanted, 100, sender.now).format.span, 0);
  EXPECT_EQ(sender.encoder.encode(Picture{}, {}, 100, sender.now).format.span, 0);
}

TEST(CameraStripes, TheSpanStaysWhileItFits) {
  CameraSender sender;
  sender.wanted = {320, 240, true, 50, 0};
  sender.next(pictures::textured(320, 240, 3));
  const PictureFormat first = sender.last.format;
  for (unsigned seed = 2; seed < 6; ++seed) {
    sender.next(pictures::textured(320, 240, 3, seed));
    EXPECT_EQ(sender.last.format, first);
  }
  // Flat pictures take long stripes, and noise takes short ones.
  sender.encoder.reset();
  sender.next(pictures::flat(320, 240, 3, 200));
  EXPECT_GT(sender.last.format.span, first.span);
  Picture noise = pictures::textured(320, 240, 3);
  std::minstd_rand random(2);
  for (std::uint8_t& byte : noise.bytes) byte = static_cast<std::uint8_t>(random() >> 8);
  sender.next(noise);
  EXPECT_LT(sender.last.format.span, first.span);
  EXPECT_TRUE(sender.last.whole);
}

TEST(CameraStripes, NoiseAtFullSizeLosesDetailButNoStripe) {
  Picture noise = pictures::flat(1920, 1080, 1, 0);
  std::minstd_rand random(2);
  for (std::uint8_t& byte : noise.bytes) byte = static_cast<std::uint8_t>(random() >> 8);
  StripeEncoder encoder;
  const auto coded = encoder.encode(noise, {1920, 1080, false, 75, 0}, 1100, Time{});
  EXPECT_TRUE(coded.whole);
  EXPECT_LE(coded.format.stripes(), PictureFormat::kMaxStripes);
  for (const Stripe& stripe : coded.stripes) EXPECT_LE(stripe.data.size(), 1100u);
}

}  // namespace
}  // namespace adit::perception
