// SPDX-License-Identifier: Apache-2.0
#include "sim/driver/jpeg.hpp"

#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

namespace adit::sim {

std::vector<std::uint8_t> encode_jpeg(const JpegInput& picture, int quality) {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&encoder, &buffer, &size);
  encoder.image_width = static_cast<JDIMENSION>(picture.width);
  encoder.image_height = static_cast<JDIMENSION>(picture.height);
  encoder.input_components = picture.bytes_per_pixel;
  encoder.in_color_space = picture.bytes_per_pixel == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, quality, TRUE);
  jpeg_start_compress(&encoder, TRUE);
  const std::size_t bytes_per_row = static_cast<std::size_t>(picture.width) * picture.bytes_per_pixel;
  while (encoder.next_scanline < encoder.image_height) {
    // libjpeg only reads the row.
    auto* row = const_cast<JSAMPROW>(picture.pixels.data() + encoder.next_scanline * bytes_per_row);
    jpeg_write_scanlines(&encoder, &row, 1);
  }
  jpeg_finish_compress(&encoder);
  jpeg_destroy_compress(&encoder);
  std::vector<std::uint8_t> out(buffer, buffer + size);
  std::free(buffer);
  return out;
}

}  // namespace adit::sim
