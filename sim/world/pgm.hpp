// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/result/result.hpp"

namespace adit::sim {

/// A grey image, rows from top to bottom, values scaled to 0 (black) .. 255 (white).
struct GreyImage {
  int width{};
  int height{};
  std::vector<std::uint8_t> pixels{};
};

/// Reads a PGM image, plain (P2) or raw (P5), up to 64 million pixels and 8 bits. `name` begins the error
/// text. Reason::syntax, not_supported.
Result<GreyImage> parse_pgm(std::string_view content, const std::string& name);

}  // namespace adit::sim
