// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "core/record/bytes.hpp"

namespace adit::record {
namespace {

using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

// Eight tables process eight bytes at a time ("slicing by 8", Kounavis and Berry 2005).
constexpr Tables make_tables() {
  Tables t{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c >> 1) ^ ((c & 1U) != 0 ? 0xEDB88320U : 0U);
    t[0][i] = c;
  }
  for (std::uint32_t i = 0; i < 256; ++i)
    for (std::size_t k = 1; k < 8; ++k) t[k][i] = (t[k - 1][i] >> 8) ^ t[0][t[k - 1][i] & 0xFFU];
  return t;
}

constexpr Tables kTables = make_tables();

}  // namespace

std::uint32_t crc32(ByteSpan data, std::uint32_t before) {
  std::uint32_t c = ~before;
  std::size_t i = 0;
  for (; i + 8 <= data.size(); i += 8) {
    c ^= static_cast<std::uint32_t>(data[i]) | static_cast<std::uint32_t>(data[i + 1]) << 8 |
         static_cast<std::uint32_t>(data[i + 2]) << 16 | static_cast<std::uint32_t>(data[i + 3]) << 24;
    c = kTables[7][c & 0xFFU] ^ kTables[6][(c >> 8) & 0xFFU] ^ kTables[5][(c >> 16) & 0xFFU] ^
        kTables[4][c >> 24] ^ kTables[3][data[i + 4]] ^ kTables[2][data[i + 5]] ^ kTables[1][data[i + 6]] ^
        kTables[0][data[i + 7]];
  }
  for (; i < data.size(); ++i) c = (c >> 8) ^ kTables[0][(c ^ data[i]) & 0xFFU];
  return ~c;
}

}  // namespace adit::record
