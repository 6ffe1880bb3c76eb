// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace adit::station::input {

/// A key: its character code, or one of these values.
enum Key : int {
  key_up = 1000,
  key_down,
  key_left,
  key_right,
  key_escape,
  key_enter,
  key_backspace,
  key_interrupt,  ///< Ctrl-C
};

/// Decodes the keys in a chunk of terminal input; unknown escape sequences are omitted.
std::vector<int> decode_keys(const std::string& bytes);

}  // namespace adit::station::input
