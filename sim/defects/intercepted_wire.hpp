#pragma once
#include <memory>

#include "sim/defects/interceptor.hpp"

namespace adit::sim {

/// A wire whose samples pass an interceptor in both directions.
class InterceptedWire final : public wire::Wire {
 public:
  /// Both must outlive this, its readers and its writers.
  InterceptedWire(wire::Wire& inner, Interceptor& interceptor);
  ~InterceptedWire() override;

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
  struct Readers;
  wire::Wire& inner_;
  Interceptor& interceptor_;
  std::shared_ptr<Readers> readers_;
};

}  // namespace adit::sim
