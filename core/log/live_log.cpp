// SPDX-License-Identifier: Apache-2.0
#include <spdlog/async.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "core/log/log.hpp"

namespace adit {
namespace {

spdlog::level::level_enum to_spdlog(LogLevel level) {
  switch (level) {
    case LogLevel::trace:
      return spdlog::level::trace;
    case LogLevel::debug:
      return spdlog::level::debug;
    case LogLevel::info:
      return spdlog::level::info;
    case LogLevel::warn:
      return spdlog::level::warn;
    case LogLevel::error:
      return spdlog::level::err;
    case LogLevel::off:
      break;
  }
  return spdlog::level::off;
}

class LiveLog final : public LogSink {
 public:
  LiveLog(LogLevel level, std::size_t queue, std::vector<spdlog::sink_ptr> sinks)
      : LogSink(level),
        pool_(std::make_shared<spdlog::details::thread_pool>(queue, 1)),
        logger_(std::make_shared<spdlog::async_logger>("adit", sinks.begin(), sinks.end(), pool_,
                                                       spdlog::async_overflow_policy::overrun_oldest)) {
    logger_->set_level(spdlog::level::trace);  // Log has already filtered by level.
    logger_->set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %^%v%$", spdlog::pattern_time_type::utc);
    logger_->flush_on(spdlog::level::warn);
  }
  ~LiveLog() override { logger_->flush(); }

  void write(const LogLine& line) override { logger_->log(to_spdlog(line.level), "{}", format(line)); }

 private:
  std::shared_ptr<spdlog::details::thread_pool> pool_;  // Its destructor writes the queued lines.
  std::shared_ptr<spdlog::async_logger> logger_;
};

}  // namespace

Result<std::shared_ptr<LogSink>> make_live_log(const LiveLogParams& params) {
  try {
    std::vector<spdlog::sink_ptr> sinks;
    if (params.console) sinks.push_back(std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    if (!params.file.empty())
      sinks.push_back(
          std::make_shared<spdlog::sinks::rotating_file_sink_mt>(params.file, params.file_size, 1));
    return std::shared_ptr<LogSink>(std::make_shared<LiveLog>(params.level, params.queue, std::move(sinks)));
  } catch (const spdlog::spdlog_ex& e) {
    return Error{Reason::cannot_write, "log " + params.file + ": " + e.what()};
  }
}

}  // namespace adit
