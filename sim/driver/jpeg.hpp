// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace adit::sim {

/// Pixels row by row from the top left, one byte (grey) or three bytes (red, green, blue) a pixel.
struct JpegInput {
  int width{}, height{};
  int bytes_per_pixel{3};
  std::span<const std::uint8_t> pixels{};
};

/// Encodes a picture as JPEG (baseline, libjpeg's usual tables). `quality`: [1, 100].
std::vector<std::uint8_t> encode_jpeg(const JpegInput& picture, int quality);

}  // namespace adit::sim
