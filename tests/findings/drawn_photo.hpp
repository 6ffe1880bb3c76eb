// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <jpeglib.h>

#include "core/findings/finding.hpp"
#include "core/findings/photo.hpp"
#include "core/time/random.hpp"

namespace adit::findings {

/// A JPEG that a test draws.
struct Drawn {
  std::uint32_t width{640}, height{480};
  int quality{90};
  bool progressive{false}, grey{false}, cmyk{false};
  bool noise{false};  ///< Hardly compressible.
  std::uint64_t seed{1};
};

inline store::Bytes draw(const Drawn& how) {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&encoder, &buffer, &size);
  encoder.image_width = how.width;
  encoder.image_height = how.height;
  encoder.input_components = how.grey ? 1 : how.cmyk ? 4 : 3;
  encoder.in_color_space = how.grey ? JCS_GRAYSCALE : how.cmyk ? JCS_CMYK : JCS_RGB;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, how.quality, TRUE);
  if (how.progressive) jpeg_simple_progression(&encoder);
  jpeg_start_compress(&encoder, TRUE);
  Random random(how.seed);
  std::vector<JSAMPLE> row(std::size_t{how.width} * static_cast<std::size_t>(encoder.input_components));
  while (encoder.next_scanline < encoder.image_height) {
    for (std::size_t i = 0; i < row.size(); ++i)
      row[i] = static_cast<JSAMPLE>(how.noise ? random.next() : i / 8 + encoder.next_scanline);
    JSAMPROW at = row.data();
    jpeg_write_scanlines(&encoder, &at, 1);
  }
  jpeg_finish_compress(&encoder);
  jpeg_destroy_compress(&encoder);
  store::Bytes out(buffer, buffer + size);
  std::free(buffer);
  return out;
}

/// A photo of about `kilobytes` kB, its picture hardly compressible.
inline Photo drawn_photo(std::uint32_t kilobytes = 20, std::uint64_t seed = 1) {
  const std::uint32_t height = std::max<std::uint32_t>(8, kilobytes * 1024 / 160);
  return make_photo(draw({.width = 160, .height = height, .quality = 50, .noise = true, .seed = seed}))
      .value();
}

}  // namespace adit::findings
