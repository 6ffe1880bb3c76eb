#pragma once
#include <memory>

#include "core/log/log.hpp"
#include "core/record/record_sink.hpp"

namespace adit::record {

/// A log sink whose lines go on a record sink, too, as Foxglove's log messages. `sink` outlives it and
/// whoever logs.
class RecordingLog final : public LogSink {
 public:
  RecordingLog(std::shared_ptr<LogSink> inner, RecordSink& sink);
  void write(const LogLine& line) override;

 private:
  std::shared_ptr<LogSink> inner_;
  RecordSink& sink_;
  ChannelId channel_;
};

}  // namespace adit::record
