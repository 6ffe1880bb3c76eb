// SPDX-License-Identifier: Apache-2.0
#include "basestation/input/keys.hpp"

namespace adit::station::input {

std::vector<int> decode_keys(const std::string& bytes) {
  std::vector<int> keys;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char c = bytes[i];
    if (c == '\x1b' && i + 1 < bytes.size() && (bytes[i + 1] == '[' || bytes[i + 1] == 'O')) {
      i += 2;
      // Skips the parameters, then one final byte follows.
      while (i < bytes.size() && (bytes[i] < 0x40 || bytes[i] > 0x7e)) ++i;
      if (i == bytes.size()) break;
      if (bytes[i] >= 'A' && bytes[i] <= 'D') {
        static constexpr int arrows[] = {key_up, key_down, key_right, key_left};
        keys.push_back(arrows[bytes[i] - 'A']);
      }
    } else if (c == '\x1b') {
      keys.push_back(key_escape);
    } else if (c == '\r' || c == '\n') {
      keys.push_back(key_enter);
    } else if (c == '\x7f' || c == '\b') {
      keys.push_back(key_backspace);
    } else if (c == '\x03') {
      keys.push_back(key_interrupt);
    } else if (c >= ' ') {
      keys.push_back(c);
    }
  }
  return keys;
}

}  // namespace adit::station::input
