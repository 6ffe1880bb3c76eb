// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/drawn_jpeg.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <jpeglib.h>

#include "core/time/random.hpp"

namespace adit::sim {
namespace {

constexpr std::uint32_t kWidth = 160;

store::Bytes drawn_rows(std::uint32_t height, std::uint64_t seed) {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&encoder, &buffer, &size);
  encoder.image_width = kWidth;
  encoder.image_height = height;
  encoder.input_components = 1;
  encoder.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&encoder);
  jpeg_start_compress(&encoder, TRUE);
  Random random(seed);
  std::vector<JSAMPLE> row(kWidth);
  while (encoder.next_scanline < height) {
    for (JSAMPLE& pixel : row) pixel = static_cast<JSAMPLE>(random.next());
    JSAMPROW at = row.data();
    jpeg_write_scanlines(&encoder, &at, 1);
  }
  jpeg_finish_compress(&encoder);
  jpeg_destroy_compress(&encoder);
  store::Bytes out(buffer, buffer + size);
  std::free(buffer);
  return out;
}

}  // namespace

store::Bytes drawn_jpeg(std::size_t bytes, std::uint64_t seed) {
  // Every row of blocks adds about the same number of bytes to those of the header.
  constexpr std::uint32_t kBlock = 8, kMany = 33;
  const auto least = static_cast<double>(drawn_rows(kBlock, seed).size());
  const double more = (static_cast<double>(drawn_rows(kBlock * kMany, seed).size()) - least) / (kMany - 1);
  const double blocks = std::clamp(1.0 + (static_cast<double>(bytes) - least) / more, 1.0, 1200.0);
  return drawn_rows(kBlock * static_cast<std::uint32_t>(std::lround(blocks)), seed);
}

}  // namespace adit::sim
