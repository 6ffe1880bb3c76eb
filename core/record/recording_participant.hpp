#pragma once
#include <memory>

#include "core/record/record_sink.hpp"
#include "core/wire/forwarding_participant.hpp"

namespace adit::record {

/// Another wire with everything that passes it on a record sink, too. What was sent stands under "out/TOPIC";
/// what was received under "in/TOPIC", one channel per sender; what its reader could not decode under
/// "in/TOPIC/malformed". `net` ("radio", "robot") goes into the channels' metadata. Both outlive it.
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
