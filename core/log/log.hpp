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
/// The level of that name; false when there is none.
bool level_from_name(std::string_view text, LogLevel& out);

struct LogLine {
  LogLevel level{LogLevel::info};
  bool has_time{false};
  Time time{};  ///< of the machine's clock, when has_time
  std::string_view component{};
  std::string_view text{};
};

/// "[   12.345678] warn  r1/mux: text": one line whatever the text holds.
std::string format(const LogLine& line);

/// Where lines go. May be called from any thread; must not block for long.
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

/// Keeps the newest lines as text, for tests and rehearsals.
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

struct LiveLogParams {
  LogLevel level{LogLevel::info};
  bool console{true};              ///< stderr
  std::string file{};              ///< also into this file, "" for none
  std::size_t file_size{5 << 20};  ///< bytes, then it is rotated; one former file is kept
  std::size_t queue{8192};         ///< lines waiting to be written; older ones are lost when it is full
};
/// spdlog behind a queue: a slow terminal or disk never holds a strand up. Each line begins with the wall
/// clock (UTC), the machine's clock follows. Error cannot_write for the file.
Result<std::shared_ptr<LogSink>> make_live_log(const LiveLogParams& params);

/// What a component logs with: a sink, its name, and its clock. Cheap to copy. A Log made by default is off.
class Log {
 public:
  Log() = default;
  /// `clock` may be null; otherwise it must outlive the Log and its copies.
  Log(std::shared_ptr<LogSink> sink, std::string component, const Executor* clock = nullptr)
      : sink_(std::move(sink)), component_(std::move(component)), clock_(clock) {}
  /// The same sink for another component.
  Log named(std::string component, const Executor* clock = nullptr) const {
    return Log(sink_, std::move(component), clock ? clock : clock_);
  }

  /// Ask first when the text is costly to make.
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
