// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/terminal/terminal.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace adit::station::cli {
namespace {

winsize size_of_window() {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) size.ws_col = 80;
  if (size.ws_row == 0) size.ws_row = 24;
  return size;
}

}  // namespace

Terminal::Terminal(bool full_screen) : full_screen_(full_screen) {
  if (::isatty(STDIN_FILENO) == 0 || ::isatty(STDOUT_FILENO) == 0 || ::tcgetattr(STDIN_FILENO, &before_) != 0)
    return;
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO | ISIG | IEXTEN);
  raw.c_iflag &= ~static_cast<tcflag_t>(IXON | ICRNL);
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  if (::tcsetattr(STDIN_FILENO, TCSAFLUSH, &raw) != 0) return;
  usable_ = true;
  if (full_screen_) write("\x1b[?1049h\x1b[?25l");
}

Terminal::~Terminal() {
  if (!usable_) return;
  if (full_screen_) write("\x1b[?25h\x1b[?1049l");
  ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
}

int Terminal::rows() const { return std::clamp<int>(size_of_window().ws_row, 4, 500); }
int Terminal::columns() const { return std::clamp<int>(size_of_window().ws_col, 20, 1000); }

std::string Terminal::read() const {
  char buffer[256];
  const ssize_t size = ::read(STDIN_FILENO, buffer, sizeof buffer);
  return size > 0 ? std::string(buffer, static_cast<std::size_t>(size)) : std::string();
}

void Terminal::write(const std::string& text) const {
  std::size_t at = 0;
  while (at < text.size()) {
    const ssize_t size = ::write(STDOUT_FILENO, text.data() + at, text.size() - at);
    if (size > 0) {
      at += static_cast<std::size_t>(size);
    } else if (size < 0 && errno == EAGAIN) {
      pollfd writable{STDOUT_FILENO, POLLOUT, 0};
      if (::poll(&writable, 1, 1000) <= 0) return;
    } else if (errno != EINTR) {
      return;  // The terminal is closed; the loop ends when its input ends.
    }
  }
}

}  // namespace adit::station::cli
