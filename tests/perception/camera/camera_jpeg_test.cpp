// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <cstdlib>
#include <random>

#include "perception/camera/jpeg_errors.hpp"
#include "perception/camera/picture.hpp"
#include "tests/perception/camera/pictures.hpp"

namespace adit::perception {
namespace {

/// A JPEG with libjpeg's own settings of a kind: CMYK, or progressive with many scans.
std::vector<std::uint8_t> unusual_jpeg(bool cmyk, int scans) {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&encoder, &buffer, &size);
  encoder.image_width = encoder.image_height = 16;
  encoder.input_components = cmyk ? 4 : 1;
  encoder.in_color_space = cmyk ? JCS_CMYK : JCS_GRAYSCALE;
  jpeg_set_defaults(&encoder);
  // The DC first, then each AC coefficient refined bit by bit.
  std::vector<jpeg_scan_info> script;
  const auto scan = [&](int begin, int end, int high, int low) {
    jpeg_scan_info info{};
    info.comps_in_scan = 1;
    info.Ss = begin;
    info.Se = end;
    info.Ah = high;
    info.Al = low;
    script.push_back(info);
  };
  if (scans > 0) {
    scan(0, 0, 0, 0);
    for (int k = 1; static_cast<int>(script.size()) < scans; ++k) scan(k, k, 0, 0);
    encoder.scan_info = script.data();
    encoder.num_scans = static_cast<int>(script.size());
  }
  jpeg_start_compress(&encoder, TRUE);
  std::vector<std::uint8_t> row(std::size_t{16} * (cmyk ? 4 : 1), 100);
  while (encoder.next_scanline < encoder.image_height) {
    JSAMPROW rows[] = {row.data()};
    jpeg_write_scanlines(&encoder, rows, 1);
  }
  jpeg_finish_compress(&encoder);
  jpeg_destroy_compress(&encoder);
  std::vector<std::uint8_t> out(buffer, buffer + size);
  std::free(buffer);
  return out;
}

std::vector<std::uint8_t> text_bytes(std::string_view text) { return {text.begin(), text.end()}; }

TEST(CameraJpeg, DecodesWhatItEncodes) {
  for (const std::uint8_t channels : {std::uint8_t{1}, std::uint8_t{3}}) {
    const Picture picture = pictures::textured(161, 121, channels);
    const auto back = decode_jpeg(encode_jpeg(picture, 90), 1000, 1000);
    ASSERT_TRUE(back) << back.error().text;
    EXPECT_EQ(back->channels, channels);
    EXPECT_GT(pictures::psnr(picture, *back), 30.0);
  }
  EXPECT_TRUE(encode_jpeg(Picture{8, 8, 3, std::vector<std::uint8_t>(10)}, 50).empty());
  EXPECT_TRUE(encode_jpeg(Picture{}, 50).empty());
}

TEST(CameraJpeg, ScalesAsConvertDoes) {
  const Picture picture = pictures::textured(800, 600, 3);
  const auto jpeg = encode_jpeg(picture, 95);
  for (const std::uint32_t width : {640u, 320u, 131u, 80u}) {
    const auto decoded = decode_jpeg(jpeg, width, 1000);
    const auto converted = convert({800, 600, 2400, "rgb8", false, picture.bytes}, width, 1000);
    ASSERT_TRUE(decoded && converted);
    EXPECT_GT(pictures::psnr(*decoded, *converted), 30.0) << width;
  }
}

TEST(CameraJpeg, RefusesDamage) {
  const auto jpeg = encode_jpeg(pictures::textured(160, 120, 3), 80);
  for (const std::size_t size : {jpeg.size() - 2, jpeg.size() / 2, std::size_t{300}, std::size_t{3}})
    EXPECT_EQ(decode_jpeg(std::span(jpeg).first(size), 99, 99).reason(), Reason::malformed) << size;
  EXPECT_EQ(decode_jpeg({}, 99, 99).reason(), Reason::malformed);
  EXPECT_EQ(decode_jpeg(text_bytes("nothing of the kind"), 99, 99).reason(), Reason::malformed);
  EXPECT_EQ(decode_jpeg(jpeg, 0, 99).reason(), Reason::out_of_range);
  std::minstd_rand random(5);
  for (int i = 0; i < 200; ++i) {
    auto damaged = jpeg;
    for (int n = 0; n < 4; ++n) damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random() >> 8);
    const auto picture = decode_jpeg(damaged, 99, 99);
    EXPECT_TRUE(!picture || picture->width <= 99u);
  }
}

TEST(CameraJpeg, NamesOtherFormats) {
  const auto png = decode_jpeg(text_bytes("\x89PNG\r\n\x1a\n and more"), 99, 99);
  EXPECT_EQ(png.reason(), Reason::not_supported);
  EXPECT_NE(png.error().text.find("PNG"), std::string::npos);
  const auto cmyk = decode_jpeg(unusual_jpeg(true, 0), 99, 99);
  EXPECT_EQ(cmyk.reason(), Reason::not_supported);
  EXPECT_NE(cmyk.error().text.find("CMYK"), std::string::npos);
}

TEST(CameraJpeg, RefusesTooLargeAndTooManyScans) {
  auto large = encode_jpeg(pictures::flat(64, 64, 1, 5), 50);
  // The size is in the start of the frame.
  for (std::size_t i = 0; i + 8 < large.size(); ++i)
    if (large[i] == 0xff && large[i + 1] == 0xc0) large[i + 5] = large[i + 7] = 0xf0;
  EXPECT_EQ(decode_jpeg(large, 99, 99).reason(), Reason::out_of_range);
  EXPECT_TRUE(decode_jpeg(unusual_jpeg(false, 10), 99, 99));
  EXPECT_EQ(decode_jpeg(unusual_jpeg(false, kMaxJpegScans + 8), 99, 99).reason(), Reason::out_of_range);
}

}  // namespace
}  // namespace adit::perception
