// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/wire/participant.hpp"

namespace adit::wire {

/// A participant that forwards all calls to another one. Decorators derive from it and override what they
/// change.
class ForwardingParticipant : public Participant {
 public:
  /// `inner` must outlive this object.
  explicit ForwardingParticipant(Participant& inner) : inner_(inner) {}

  ParticipantId id() const override { return inner_.id(); }
  Result<std::unique_ptr<RawWriter>> make_writer(const TopicInfo& topic,
                                                 const std::string& partition) override {
    return inner_.make_writer(topic, partition);
  }
  Result<std::unique_ptr<RawReader>> make_reader(const TopicInfo& topic, const std::string& partition,
                                                 Executor& strand, RawHandler handler) override {
    return inner_.make_reader(topic, partition, strand, std::move(handler));
  }
  void on_participant(Executor& strand, std::function<void(const ParticipantEvent&)> handler) override {
    inner_.on_participant(strand, std::move(handler));
  }
  std::vector<RemoteEndpoint> endpoints(const std::string& topic) const override {
    return inner_.endpoints(topic);
  }
  WireCounters counters() const override { return inner_.counters(); }
  SenderState sender() const override { return inner_.sender(); }
  std::vector<PeerState> peers() const override { return inner_.peers(); }
  void set_place(const ParticipantId& who, const Position& at) override { inner_.set_place(who, at); }

 protected:
  Participant& inner_;
};

}  // namespace adit::wire
