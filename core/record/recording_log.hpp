// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "core/log/log.hpp"
#include "core/record/record_sink.hpp"

namespace adit::record {

/// A log sink that also records its lines on a record sink, as Foxglove's log messages. `sink` must outlive
/// it and its users.
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
