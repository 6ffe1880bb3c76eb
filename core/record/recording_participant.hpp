// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "core/record/record_sink.hpp"
#include "core/wire/forwarding_participant.hpp"

namespace adit::record {

/// A participant that forwards to another one and also records its samples on a record sink. Sent samples are
/// in the channel "out/TOPIC"; received ones in "in/TOPIC", one channel per sender; those that the reader
/// could not decode in "in/TOPIC/malformed". `net` ("radio", "robot") is metadata of the channels. The inner
/// participant and the sink must outlive it.
class RecordingParticipant final : public wire::ForwardingParticipant {
 public:
  RecordingParticipant(wire::Participant& inner, RecordSink& sink, std::string net);

  Result<std::unique_ptr<wire::RawWriter>> make_writer(const wire::TopicInfo& topic,
                                                       const std::string& partition) override;
  Result<std::unique_ptr<wire::RawReader>> make_reader(const wire::TopicInfo& topic,
                                                       const std::string& partition, Executor& strand,
                                                       wire::RawHandler handler) override;

 private:
  RecordSink& sink_;
  std::string net_;
};

}  // namespace adit::record
