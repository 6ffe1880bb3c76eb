#include "core/log/log.hpp"

#include <array>
#include <cstdio>

namespace adit {
namespace {
constexpr std::array<std::string_view, 6> names{"trace", "debug", "info", "warn", "error", "off"};
}

std::string_view name(LogLevel level) { return names[static_cast<std::size_t>(level)]; }

bool level_from_name(std::string_view text, LogLevel& out) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == text) {
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
  for (const char c : line.text) {
    // Text may come from the radio: no line breaks, no terminal control.
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += c == '\n' ? " | " : "?";
    } else {
      out += c;
    }
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
