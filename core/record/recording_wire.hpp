#pragma once
#include <memory>

#include "core/record/tape.hpp"
#include "core/wire/wire.hpp"

namespace adit::record {

/// Another wire with everything that passes it on a tape, too. What was sent stands under "out/TOPIC"; what
/// was received under "in/TOPIC", one channel per sender; what its reader could not decode under
/// "in/TOPIC/malformed". `net` ("radio", "robot") goes into the channels' metadata. Both outlive it.
class RecordingWire final : public wire::Wire {
 public:
  RecordingWire(wire::Wire& inner, Tape& tape, std::string net);

  wire::ParticipantId id() const override { return inner_.id(); }
  Result<std::unique_ptr<wire::RawWriter>> make_writer(const wire::TopicInfo& topic,
                                                       const std::string& partition) override;
  Result<std::unique_ptr<wire::RawReader>> make_reader(const wire::TopicInfo& topic,
                                                       const std::string& partition, Executor& strand,
                                                       wire::RawHandler handler) override;
  void on_participant(Executor& strand, std::function<void(const wire::ParticipantEvent&)> handler) override {
    inner_.on_participant(strand, std::move(handler));
  }
  wire::WireCounters counters() const override { return inner_.counters(); }
  wire::SenderState sender() const override { return inner_.sender(); }
  std::vector<wire::PeerState> peers() const override { return inner_.peers(); }
  void set_place(const wire::ParticipantId& who, const wire::Position& at) override {
    inner_.set_place(who, at);
  }

 private:
  wire::Wire& inner_;
  Tape& tape_;
  std::string net_;
};

}  // namespace adit::record
