// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/drawn_jpeg.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/time/random.hpp"
#include "sim/driver/jpeg.hpp"

namespace adit::sim {
namespace {

constexpr std::uint32_t kWidth = 160;
constexpr int kQuality = 75;

store::Bytes drawn_rows(std::uint32_t height, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::uint8_t> pixels(std::size_t{kWidth} * height);
  for (std::uint8_t& pixel : pixels) pixel = static_cast<std::uint8_t>(random.next());
  return encode_jpeg({static_cast<int>(kWidth), static_cast<int>(height), 1, pixels}, kQuality);
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
