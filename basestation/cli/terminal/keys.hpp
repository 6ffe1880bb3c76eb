#pragma once
#include <string>
#include <vector>

namespace adit::station::cli {

/// A key: its character, or one of these.
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

/// The keys in what a terminal sent at once; escape sequences that mean nothing here are left out.
std::vector<int> decode_keys(const std::string& bytes);

}  // namespace adit::station::cli
