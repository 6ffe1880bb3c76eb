// SPDX-License-Identifier: Apache-2.0
#include "core/findings/photo.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/findings/drawn_photo.hpp"

namespace adit::findings {
namespace {

TEST(Photo, ASmallOneIsStoredAsItIs) {
  const store::Bytes jpeg = draw({});
  ASSERT_LT(jpeg.size(), Photo::kMaxBytes);
  const auto photo = make_photo(jpeg);
  ASSERT_TRUE(photo.ok()) << photo.error().text;
  EXPECT_EQ(photo->picture, jpeg);
  EXPECT_EQ(photo->hash, photo_hash(jpeg));
  EXPECT_GT(photo->thumbnail.size(), 300U);
  EXPECT_LE(photo->thumbnail.size(), Photo::kMaxThumbnail);
  EXPECT_TRUE(make_photo(photo->thumbnail).ok());
}

TEST(Photo, ALargeOneIsScaledAndRecompressed) {
  for (const bool noise : {false, true}) {
    const store::Bytes jpeg = draw({.width = 3000, .height = 2000, .quality = 98, .noise = noise});
    if (jpeg.size() > Photo::kMaxInput) continue;
    ASSERT_GT(jpeg.size(), Photo::kMaxBytes);
    const auto photo = make_photo(jpeg);
    ASSERT_TRUE(photo.ok()) << photo.error().text;
    EXPECT_LE(photo->picture.size(), Photo::kMaxBytes);
    EXPECT_LE(photo->thumbnail.size(), Photo::kMaxThumbnail);
    EXPECT_TRUE(make_photo(photo->picture).ok());
  }
}

TEST(Photo, IsDecodedAndALargeOneScaled) {
  const auto small = decode_photo(draw({.width = 640, .height = 480}));
  ASSERT_TRUE(small.ok()) << small.error().text;
  EXPECT_EQ(small->width, 640U);
  EXPECT_EQ(small->height, 480U);
  EXPECT_EQ(small->rgb.size(), 640U * 480U * 3U);
  const auto large = decode_photo(draw({.width = 3000, .height = 2000}));
  ASSERT_TRUE(large.ok()) << large.error().text;
  EXPECT_GE(large->width, Photo::kSide);
  EXPECT_LT(large->width, 2000U);
  EXPECT_FALSE(decode_photo(store::Bytes(100, 0xff)).ok());
}

TEST(Photo, NoiseFitsToo) {
  const auto photo = make_photo(draw({.width = 1600, .height = 1200, .noise = true}));
  ASSERT_TRUE(photo.ok()) << photo.error().text;
  EXPECT_LE(photo->picture.size(), Photo::kMaxBytes);
  EXPECT_LE(photo->thumbnail.size(), Photo::kMaxThumbnail);
}

TEST(Photo, GreyProgressiveAndThinOnesAreRead) {
  for (const Drawn& how : {Drawn{.grey = true}, Drawn{.progressive = true}, Drawn{.width = 1, .height = 1},
                           Drawn{.width = 5000, .height = 2}, Drawn{.width = 2, .height = 5000}}) {
    const auto photo = make_photo(draw(how));
    EXPECT_TRUE(photo.ok()) << how.width << " x " << how.height << " " << photo.error().text;
  }
}

TEST(Photo, WhatIsTooLargeIsRefused) {
  EXPECT_EQ(make_photo(store::Bytes(20'000'000, 0xff)).reason(), Reason::out_of_range);
  EXPECT_EQ(make_photo(draw({.width = 20'000, .height = 2})).reason(), Reason::out_of_range);
  store::Bytes bomb = draw({.width = 8, .height = 8});  // Its header says 9999 x 9999.
  for (std::size_t i = 0; i + 8 < bomb.size(); ++i)
    if (bomb[i] == 0xff && bomb[i + 1] == 0xc0) {
      bomb[i + 5] = bomb[i + 7] = 0x27;
      bomb[i + 6] = bomb[i + 8] = 0x0f;
    }
  EXPECT_EQ(make_photo(bomb).reason(), Reason::out_of_range);
}

TEST(Photo, WhatIsNoJpegIsRefused) {
  EXPECT_EQ(make_photo({}).reason(), Reason::malformed);
  EXPECT_EQ(make_photo(store::Bytes{0xff, 0xd8, 0xff, 0xd9}).reason(), Reason::malformed);
  EXPECT_EQ(make_photo(store::Bytes(5000, 'x')).reason(), Reason::malformed);
  EXPECT_EQ(make_photo(draw({.cmyk = true})).reason(), Reason::malformed);
}

TEST(Photo, ATruncatedOneIsRefused) {
  const store::Bytes jpeg = draw({.width = 200, .height = 150});
  for (std::size_t length = 0; length + 2 < jpeg.size(); length += 37)
    EXPECT_FALSE(make_photo(std::span(jpeg).first(length)).ok()) << length;
}

TEST(Photo, ManyScansAreRefused) {
  store::Bytes jpeg = draw({.width = 64, .height = 64, .progressive = true});
  std::size_t last = 0;  // The last scan, again and again.
  for (std::size_t i = 0; i + 1 < jpeg.size(); ++i)
    if (jpeg[i] == 0xff && jpeg[i + 1] == 0xda) last = i;
  const store::Bytes scan(jpeg.begin() + static_cast<std::ptrdiff_t>(last), jpeg.end() - 2);
  jpeg.erase(jpeg.end() - 2, jpeg.end());
  for (int n = 0; n < 1000; ++n) jpeg.insert(jpeg.end(), scan.begin(), scan.end());
  jpeg.push_back(0xff);
  jpeg.push_back(0xd9);
  EXPECT_EQ(make_photo(jpeg).reason(), Reason::out_of_range);
}

TEST(Photo, DamagedBytesNeverDoMoreThanRefuse) {
  const store::Bytes good = draw({.width = 120, .height = 90});
  const store::Bytes progressive = draw({.width = 120, .height = 90, .progressive = true});
  Random random(7);
  const char* more = std::getenv("ADIT_MUTATIONS");
  const int runs = more != nullptr ? std::atoi(more) : 3000;
  for (int n = 0; n < runs; ++n) {
    store::Bytes jpeg = n % 2 == 0 ? good : progressive;
    for (std::uint64_t k = random.next() % 8 + 1; k > 0; --k)
      jpeg[random.next() % jpeg.size()] = static_cast<std::uint8_t>(random.next());
    const auto photo = make_photo(jpeg);
    if (!photo) continue;
    EXPECT_LE(photo->picture.size(), Photo::kMaxBytes);
    EXPECT_LE(photo->thumbnail.size(), Photo::kMaxThumbnail);
  }
}

TEST(Photo, StopsWhenItMust) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(make_photo(draw({}), stop.get_token()).reason(), Reason::cancelled);
}

}  // namespace
}  // namespace adit::findings
