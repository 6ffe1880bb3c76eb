#pragma once
#include <memory>

#include "core/log/log.hpp"
#include "core/record/tape.hpp"

namespace adit::record {

/// A log sink whose lines go on a tape, too, as Foxglove's log messages. `tape` outlives it and whoever logs.
class RecordingLog final : public LogSink {
 public:
  RecordingLog(std::shared_ptr<LogSink> inner, Tape& tape);
  void write(const LogLine& line) override;

 private:
  std::shared_ptr<LogSink> inner_;
  Tape& tape_;
  ChannelId channel_;
};

}  // namespace adit::record
