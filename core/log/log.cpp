// SPDX-License-Identifier: Apache-2.0
#include "core/log/log.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace adit {
namespace {
constexpr std::array<std::string_view, 6> kNames{"trace", "debug", "info", "warn", "error", "off"};

/// Returns the number of bytes of the UTF-8 character at the start of `text`; 0 when there is none, or when
/// it is overlong, a surrogate, or a C1 control character, which terminals obey like those below 0x20.
std::size_t printable(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t size = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(i) & 0xc0u) != 0x80) return 0;
  if (first == 0xc2 && byte(1) < 0xa0) return 0;  // A C1 control character.
  // An overlong encoding.
  if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90)) return 0;
  // A surrogate, or beyond the last code point.
  if ((first == 0xed && byte(1) > 0x9f) || (first == 0xf4 && byte(1) > 0x8f)) return 0;
  return size;
}

}  // namespace

std::string_view name(LogLevel level) { return kNames[static_cast<std::size_t>(level)]; }

bool level_from_name(std::string_view text, LogLevel& out) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == text) {
      out = static_cast<LogLevel>(i);
      return true;
    }
  return false;
}

std::string format(const LogLine& line) {
  char head[48];
  if (line.has_time) {
    std::snprintf(head, sizeof head, "[%12.6f] %-5s ", seconds(line.time.time_since_epoch()),
                  name(line.level).data());
  } else {
    std::snprintf(head, sizeof head, "[           -] %-5s ", name(line.level).data());
  }
  std::string out = head;
  out.append(line.component).append(": ");
  // Text may come from the radio: line breaks and terminal control characters are removed.
  for (std::string_view text = line.text; !text.empty();) {
    const std::size_t size = printable(text);
    if (size > 0)
      out += text.substr(0, size);
    else
      out += text.front() == '\n' ? " | " : "?";
    text.remove_prefix(std::max<std::size_t>(1, size));
  }
  return out;
}

void MemoryLog::write(const LogLine& line) {
  const std::lock_guard lock(mutex_);
  if (lines_.size() >= capacity_) lines_.pop_front();
  lines_.push_back(format(line));
}

std::vector<std::string> MemoryLog::lines() const {
  const std::lock_guard lock(mutex_);
  return {lines_.begin(), lines_.end()};
}

void Log::write(LogLevel level, std::string_view text) const {
  if (!on(level)) return;
  sink_->write({level, clock_ != nullptr, clock_ ? clock_->now() : Time{}, component_, text});
}

}  // namespace adit
