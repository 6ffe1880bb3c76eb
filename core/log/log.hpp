// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "core/exec/executor.hpp"
#include "core/result/result.hpp"

namespace adit {

enum class LogLevel { trace, debug, info, warn, error, off };
std::string_view name(LogLevel level);
/// Parses the name of a level; returns false when there is none of that name.
bool level_from_name(std::string_view text, LogLevel& out);

/// One line of the log.
struct LogLine {
  LogLevel level{LogLevel::info};
  bool has_time{false};
  Time time{};  ///< Time of the machine's clock, when `has_time`.
  std::string_view component{};
  std::string_view text{};
};

/// Formats a line as "[   12.345678] warn  r1/mux: text"; the result is one line for any text.
std::string format(const LogLine& line);

/// Receiver of log lines. Safe to call from any thread; must not block for long.
class LogSink {
 public:
  explicit LogSink(LogLevel level) : level_(level) {}
  virtual ~LogSink() = default;
  LogSink(const LogSink&) = delete;
  LogSink& operator=(const LogSink&) = delete;
  LogLevel level() const { return level_; }
  virtual void write(const LogLine& line) = 0;

 private:
  LogLevel level_;
};

/// Stores the newest lines as text, for tests and rehearsals.
class MemoryLog final : public LogSink {
 public:
  explicit MemoryLog(LogLevel level = LogLevel::info, std::size_t capacity = 10'000)
      : LogSink(level), capacity_(capacity) {}
  void write(const LogLine& line) override;
  std::vector<std::string> lines() const;

 private:
  std::size_t capacity_;
  mutable std::mutex mutex_{};
  std::deque<std::string> lines_{};
};

/// Parameters of a log that writes to the console and to a file.
struct LiveLogParams {
  LogLevel level{LogLevel::info};
  bool console{true};              ///< Writes to stderr.
  std::string file{};              ///< Also writes to this file; "": none.
  std::size_t file_size{5 << 20};  ///< Size at which the file is rotated, bytes; one previous file remains.
  std::size_t queue{8192};  ///< Length of the queue, lines. The oldest lines are dropped when it is full.
};
/// Creates a log based on spdlog with a queue: a slow terminal or disk never delays a strand. Each line
/// begins with the wall clock (UTC), then the machine's clock. Error cannot_write for the file.
Result<std::shared_ptr<LogSink>> make_live_log(const LiveLogParams& params);

/// Logger of a component: a sink, the component's name, and its clock. Cheap to copy. A default-constructed
/// Log is off.
class Log {
 public:
  Log() = default;
  /// `clock` may be null; otherwise it must outlive the Log and its copies.
  Log(std::shared_ptr<LogSink> sink, std::string component, const Executor* clock = nullptr)
      : sink_(std::move(sink)), component_(std::move(component)), clock_(clock) {}
  /// Returns a Log with the same sink for another component.
  Log named(std::string component, const Executor* clock = nullptr) const {
    return Log(sink_, std::move(component), clock ? clock : clock_);
  }

  /// Whether lines of this level are logged; check it first when the text is expensive to build.
  bool on(LogLevel level) const { return sink_ && level != LogLevel::off && level >= sink_->level(); }
  void write(LogLevel level, std::string_view text) const;
  void trace(std::string_view text) const { write(LogLevel::trace, text); }
  void debug(std::string_view text) const { write(LogLevel::debug, text); }
  void info(std::string_view text) const { write(LogLevel::info, text); }
  void warn(std::string_view text) const { write(LogLevel::warn, text); }
  void error(std::string_view text) const { write(LogLevel::error, text); }

 private:
  std::shared_ptr<LogSink> sink_{};
  std::string component_{};
  const Executor* clock_{nullptr};
};

}  // namespace adit
