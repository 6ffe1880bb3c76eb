// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <random>

#include "perception/camera/picture.hpp"

namespace adit::perception::pictures {

/// A picture with smooth shades, edges and fine texture.
inline Picture textured(std::uint32_t width, std::uint32_t height, std::uint8_t channels, unsigned seed = 1) {
  Picture out{width, height, channels, {}};
  out.bytes.resize(std::size_t{width} * height * channels);
  std::minstd_rand random(seed);
  std::size_t i = 0;
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const bool tile = (x / 23 + y / 17 + seed) % 3 == 0;
      const int shade = static_cast<int>(40 + 100 * x / width + 60 * y / height + (tile ? 40 : 0));
      const int grain = static_cast<int>(random() >> 10 & 7);
      for (int c = 0; c < channels; ++c)
        out.bytes[i++] = static_cast<std::uint8_t>(shade + grain - (tile ? 20 * c : 0));
    }
  return out;
}

/// A picture of one colour.
inline Picture flat(std::uint32_t width, std::uint32_t height, std::uint8_t channels, std::uint8_t value) {
  return {width, height, channels, std::vector<std::uint8_t>(std::size_t{width} * height * channels, value)};
}

/// Peak signal-to-noise ratio, dB; 0: the sizes differ.
inline double psnr(const Picture& a, const Picture& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.bytes.size(); ++i) {
    const int d = a.bytes[i] - b.bytes[i];
    sum += d * d;
  }
  return sum == 0.0 ? 99.0 : 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(a.bytes.size()) / sum);
}

}  // namespace adit::perception::pictures
