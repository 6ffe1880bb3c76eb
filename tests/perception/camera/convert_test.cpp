// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <algorithm>
#include <array>

#include "perception/camera/area_scaler.hpp"
#include "perception/camera/picture.hpp"
#include "tests/perception/camera/pictures.hpp"

namespace adit::perception {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Rgb = std::array<int, 3>;

RawPicture raw_picture(std::uint32_t width, std::uint32_t height, std::uint32_t step, std::string encoding,
                       const Bytes& data) {
  return {width, height, step, std::move(encoding), false, data};
}

/// The only colour of a picture of 4 x 2 pixels that repeats `cell`.
Rgb colour_of(const std::string& encoding, const Bytes& cell, std::uint32_t pixel_bytes) {
  Bytes data;
  const std::uint32_t step = 4 * pixel_bytes;
  while (data.size() < std::size_t{2} * step) data.insert(data.end(), cell.begin(), cell.end());
  const auto picture = convert(raw_picture(4, 2, step, encoding, data), 100, 100);
  if (!picture || picture->channels != 3) return {-1, -1, -1};
  for (std::size_t i = 3; i < picture->bytes.size(); ++i)
    if (picture->bytes[i] != picture->bytes[i % 3]) return {-2, -2, -2};
  return {picture->bytes[0], picture->bytes[1], picture->bytes[2]};
}

TEST(CameraConvert, ReadsThePackedEncodings) {
  const Rgb expected{10, 20, 30};
  EXPECT_EQ(colour_of("rgb8", {10, 20, 30}, 3), expected);
  EXPECT_EQ(colour_of("bgr8", {30, 20, 10}, 3), expected);
  EXPECT_EQ(colour_of("8UC3", {30, 20, 10}, 3), expected);
  EXPECT_EQ(colour_of("rgba8", {10, 20, 30, 99}, 4), expected);
  EXPECT_EQ(colour_of("bgra8", {30, 20, 10, 99}, 4), expected);
}

TEST(CameraConvert, ReadsYuvAsVideo) {
  // Pure red of BT.601: y 81, u 90, v 240.
  const Rgb expected{255, 0, 0};
  for (const auto& [encoding, cell] :
       std::initializer_list<std::pair<const char*, Bytes>>{{"yuv422", {90, 81, 240, 81}},
                                                            {"uyvy", {90, 81, 240, 81}},
                                                            {"yuyv", {81, 90, 81, 240}},
                                                            {"yuv422_yuy2", {81, 90, 81, 240}}}) {
    const Rgb colour = colour_of(encoding, cell, 2);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(colour[c], expected[c], 2) << encoding;
  }
  EXPECT_EQ(colour_of("uyvy", {128, 16, 128, 16}, 2), (Rgb{0, 0, 0}));
  EXPECT_EQ(colour_of("uyvy", {128, 235, 128, 235}, 2), (Rgb{255, 255, 255}));
}

TEST(CameraConvert, ReadsPlanesOfYuv) {
  const Bytes nv12{81, 81, 81, 81, 90, 240}, nv21{81, 81, 81, 81, 240, 90};
  for (const auto& [encoding, data] : {std::pair{"nv12", nv12}, std::pair{"nv21", nv21}}) {
    const auto picture = convert(raw_picture(2, 2, 2, encoding, data), 2, 2);
    ASSERT_TRUE(picture) << picture.error().text;
    EXPECT_NEAR(picture->bytes[0], 255, 2);
    EXPECT_NEAR(picture->bytes[11], 0, 2);
  }
  EXPECT_EQ(convert(raw_picture(2, 2, 2, "nv12", {81, 81, 81, 81, 90}), 2, 2).reason(), Reason::malformed);
}

TEST(CameraConvert, ReadsCellsOfBayerPatterns) {
  const std::array<std::pair<const char*, Bytes>, 4> cells{{{"bayer_rggb8", {200, 90, 110, 50}},
                                                            {"bayer_bggr8", {50, 90, 110, 200}},
                                                            {"bayer_gbrg8", {90, 50, 200, 110}},
                                                            {"bayer_grbg8", {90, 200, 50, 110}}}};
  for (const auto& [encoding, cell] : cells) {
    const Bytes data{cell[0], cell[1], cell[0], cell[1], cell[2], cell[3], cell[2], cell[3]};
    const auto picture = convert(raw_picture(4, 2, 4, encoding, data), 100, 100);
    ASSERT_TRUE(picture) << picture.error().text;
    EXPECT_EQ(picture->width, 2u);
    EXPECT_EQ(picture->height, 1u);
    EXPECT_EQ(picture->bytes, (Bytes{200, 100, 50, 200, 100, 50})) << encoding;
  }
}

TEST(CameraConvert, ReadsGrey) {
  const auto grey = convert(raw_picture(2, 1, 2, "mono8", {7, 9}), 9, 9);
  ASSERT_TRUE(grey);
  EXPECT_EQ(grey->channels, 1);
  EXPECT_EQ(grey->bytes, (Bytes{7, 9}));
  const Bytes data{0x34, 0x12, 0x78, 0x56};
  RawPicture wide = raw_picture(2, 1, 4, "mono16", data);
  EXPECT_EQ(convert(wide, 9, 9)->bytes, (Bytes{0x12, 0x56}));
  wide.big_endian = true;
  EXPECT_EQ(convert(wide, 9, 9)->bytes, (Bytes{0x34, 0x78}));
}

TEST(CameraConvert, LeavesOutWhatFillsUpTheStep) {
  const auto grey = convert(raw_picture(2, 2, 4, "8UC1", {1, 2, 99, 99, 3, 4}), 9, 9);
  ASSERT_TRUE(grey) << grey.error().text;
  EXPECT_EQ(grey->bytes, (Bytes{1, 2, 3, 4}));
}

TEST(CameraConvert, ScalesByTheMeanOfAreas) {
  const auto half = convert(raw_picture(4, 2, 4, "mono8", {0, 10, 100, 200, 20, 30, 100, 200}), 2, 9);
  ASSERT_TRUE(half);
  EXPECT_EQ(half->height, 1u);
  EXPECT_EQ(half->bytes, (Bytes{15, 150}));
  // Three pixels into two: the middle one is shared.
  const auto shared = convert(raw_picture(3, 3, 3, "mono8", {0, 90, 180, 0, 90, 180, 0, 90, 180}), 2, 2);
  ASSERT_TRUE(shared);
  EXPECT_EQ(shared->bytes, (Bytes{30, 150, 30, 150}));
  // The mean of all stays.
  const Picture texture = pictures::textured(161, 121, 3);
  const auto one = convert(raw_picture(161, 121, 483, "rgb8", texture.bytes), 1, 1);
  double sum = 0.0;
  for (std::size_t i = 0; i < texture.bytes.size(); i += 3) sum += texture.bytes[i];
  EXPECT_NEAR(one->bytes[0], sum / (161 * 121), 0.6);
}

TEST(CameraConvert, KeepsTheRatioOfTheSides) {
  EXPECT_EQ(fitted({1920, 1080}, {640, 480}), (PictureSize{640, 360}));
  EXPECT_EQ(fitted({1280, 1024}, {640, 480}), (PictureSize{600, 480}));
  EXPECT_EQ(fitted({100, 50}, {640, 480}), (PictureSize{100, 50}));
  EXPECT_EQ(fitted({10'000, 1}, {100, 100}), (PictureSize{100, 1}));
}

TEST(CameraConvert, ReadsTwentyMegapixels) {
  const Bytes data(std::size_t{5472} * 3648, 77);
  const auto picture = convert(raw_picture(5472, 3648, 5472, "bayer_rggb8", data), 640, 480);
  ASSERT_TRUE(picture) << picture.error().text;
  EXPECT_EQ(picture->width, 640u);
  EXPECT_EQ(picture->height, 427u);
  EXPECT_EQ(std::ranges::count(picture->bytes, 77), std::ptrdiff_t{640} * 427 * 3);
}

TEST(CameraConvert, RefusesWhatDoesNotFit) {
  const Bytes data(64);
  const auto reason = [&](std::uint32_t width, std::uint32_t height, std::uint32_t step,
                          const char* encoding) {
    return convert(raw_picture(width, height, step, encoding, data), 100, 100).reason();
  };
  EXPECT_EQ(reason(8, 8, 8, "mono8"), Reason::none);
  EXPECT_EQ(reason(8, 9, 8, "mono8"), Reason::malformed);
  EXPECT_EQ(reason(8, 8, 7, "mono8"), Reason::malformed);
  EXPECT_EQ(reason(8, 8, 0xffffffff, "mono8"), Reason::malformed);
  EXPECT_EQ(reason(8, 8, 8, "rgb8"), Reason::malformed);
  EXPECT_EQ(reason(0, 8, 8, "mono8"), Reason::malformed);
  EXPECT_EQ(reason(8, 0, 8, "mono8"), Reason::malformed);
  EXPECT_EQ(reason(3, 2, 8, "yuyv"), Reason::malformed);
  EXPECT_EQ(reason(1, 2, 8, "bayer_rggb8"), Reason::malformed);
  EXPECT_EQ(reason(20'000, 1, 20'000, "mono8"), Reason::out_of_range);
  EXPECT_EQ(reason(9'000, 9'000, 9'000, "mono8"), Reason::out_of_range);
  EXPECT_EQ(convert(raw_picture(8, 8, 8, "mono8", data), 0, 9).reason(), Reason::out_of_range);
  const auto unknown = convert(raw_picture(8, 8, 8, "32FC1", data), 100, 100);
  EXPECT_EQ(unknown.reason(), Reason::not_supported);
  EXPECT_NE(unknown.error().text.find("32FC1"), std::string::npos);
  EXPECT_NE(unknown.error().text.find("bayer_rggb8"), std::string::npos);
}

}  // namespace
}  // namespace adit::perception
