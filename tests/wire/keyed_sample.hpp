// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace adit::wire {

/// A serialised sample whose first member, the key, is this string.
inline std::vector<std::uint8_t> keyed(const std::string& key) {
  std::vector<std::uint8_t> bytes(8 + (key.size() / 4 + 1) * 4);
  bytes[1] = 1;
  bytes[4] = static_cast<std::uint8_t>(key.size() + 1);
  std::copy(key.begin(), key.end(), bytes.begin() + 8);
  return bytes;
}

}  // namespace adit::wire
