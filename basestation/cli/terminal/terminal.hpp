// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <termios.h>

#include <string>

namespace adit::station::cli {

/// The terminal in raw mode: keys arrive immediately and without echo. The destructor restores the terminal,
/// also after SIGINT, which arrives as a key (signals are off) or as a flag (interrupt.hpp).
class Terminal {
 public:
  /// `full_screen`: uses the alternate screen, without a cursor.
  explicit Terminal(bool full_screen);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// False if stdin or stdout is no terminal; nothing was changed then.
  bool usable() const { return usable_; }
  int rows() const;
  int columns() const;
  /// All bytes typed since the last call.
  std::string read() const;
  void write(const std::string& text) const;

 private:
  bool full_screen_;
  bool usable_{false};
  termios before_{};
};

}  // namespace adit::station::cli
