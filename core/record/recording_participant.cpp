// SPDX-License-Identifier: Apache-2.0
#include "core/record/recording_participant.hpp"

#include <algorithm>
#include <exception>
#include <map>

namespace adit::record {
namespace {

// Channels of one reader; beyond it the sender that was silent longest is removed.
constexpr std::size_t kMaxSenders = 32;
// Limits the recorded undecodable samples of one reader: a peer that sends nothing else must not displace the
// last minutes from the ring. The wire's counters count all of them.
constexpr double kMalformedBurst = 32.0;
constexpr double kMalformedRate = 4.0;  // In 1/s.

class RecordingWriter final : public wire::RawWriter {
 public:
  RecordingWriter(std::unique_ptr<wire::RawWriter> inner, RecordSink& sink, ChannelId channel)
      : inner_(std::move(inner)), sink_(sink), channel_(channel) {}
  Result<void> write(std::span<const std::uint8_t> cdr) override {
    auto sent = inner_->write(cdr);
    if (sent) sink_.record(channel_, cdr);
    return sent;
  }
  std::size_t matched() const override { return inner_->matched(); }

 private:
  std::unique_ptr<wire::RawWriter> inner_;
  RecordSink& sink_;
  ChannelId channel_;
};

/// Records the samples that a reader received; runs on the reader's strand.
class RecordingReader {
 public:
  RecordingReader(RecordSink& sink, ChannelInfo info) : sink_(sink), info_(std::move(info)) {}
  ~RecordingReader() {
    for (const auto* channels : {&channels_, &malformed_})
      for (const auto& [sender, own] : *channels) sink_.release(own.id);
  }
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;

  void record(std::span<const std::uint8_t> cdr, const wire::ParticipantId& sender) {
    sink_.record(channel(channels_, sender, info_), cdr);
  }
  void record_malformed(std::span<const std::uint8_t> cdr, const wire::SampleInfo& about) {
    tokens_ = std::min(kMalformedBurst, tokens_ + kMalformedRate * seconds(about.received - refilled_));
    refilled_ = about.received;
    if (tokens_ < 1.0) return;
    tokens_ -= 1.0;
    ChannelInfo info{info_.topic + "/malformed", info_.dds_type, info_.metadata};
    info.metadata[kMalformedKey] = "could not be decoded";
    sink_.record(channel(malformed_, about.sender, std::move(info)), cdr);
  }

 private:
  struct Own {
    ChannelId id{};
    std::uint64_t last{};  ///< Number of the last sample received.
  };
  using Senders = std::map<wire::ParticipantId, Own>;

  ChannelId channel(Senders& senders, const wire::ParticipantId& sender, ChannelInfo info) {
    auto it = senders.find(sender);
    if (it == senders.end()) {
      if (senders.size() >= kMaxSenders) give_one_up(senders);
      info.metadata["from"] = wire::to_string(sender);
      it = senders.try_emplace(sender, Own{sink_.channel(info), 0}).first;
    }
    it->second.last = ++count_;
    return it->second.id;
  }
  void give_one_up(Senders& senders) {
    const auto oldest = std::min_element(senders.begin(), senders.end(), [](const auto& a, const auto& b) {
      return a.second.last < b.second.last;
    });
    sink_.release(oldest->second.id);
    senders.erase(oldest);
  }

  RecordSink& sink_;
  ChannelInfo info_;
  Senders channels_{}, malformed_{};
  std::uint64_t count_{};
  double tokens_{kMalformedBurst};
  Time refilled_{};  ///< Time by the receiver's clock.
};

}  // namespace

RecordingParticipant::RecordingParticipant(wire::Participant& inner, RecordSink& sink, std::string net)
    : ForwardingParticipant(inner), sink_(sink), net_(std::move(net)) {}

Result<std::unique_ptr<wire::RawWriter>> RecordingParticipant::make_writer(const wire::TopicInfo& topic,
                                                                           const std::string& partition) {
  auto made = inner_.make_writer(topic, partition);
  if (!made) return made;
  ChannelInfo info{std::string("out/") + topic.name,
                   topic.type,
                   {{"net", net_}, {"from", wire::to_string(inner_.id())}, {"direction", "out"}}};
  if (!partition.empty()) info.metadata["partition"] = partition;
  return std::unique_ptr<wire::RawWriter>(
      std::make_unique<RecordingWriter>(std::move(*made), sink_, sink_.channel(info)));
}

Result<std::unique_ptr<wire::RawReader>> RecordingParticipant::make_reader(const wire::TopicInfo& topic,
                                                                           const std::string& partition,
                                                                           Executor& strand,
                                                                           wire::RawHandler handler) {
  ChannelInfo info{std::string("in/") + topic.name,
                   topic.type,
                   {{"net", net_}, {"to", wire::to_string(inner_.id())}, {"direction", "in"}}};
  if (!partition.empty()) info.metadata["partition"] = partition;
  const auto heard = std::make_shared<RecordingReader>(sink_, std::move(info));
  return inner_.make_reader(topic, partition, strand,
                            [heard, handler = std::move(handler)](std::span<const std::uint8_t> cdr,
                                                                  const wire::SampleInfo& about) {
                              try {
                                const bool decoded = handler(cdr, about);
                                decoded ? heard->record(cdr, about.sender)
                                        : heard->record_malformed(cdr, about);
                                return decoded;
                              } catch (...) {
                                // Recorded before it is handled, so that a sample that crashes its receiver
                                // is on record.
                                heard->record(cdr, about.sender);
                                throw;
                              }
                            });
}

}  // namespace adit::record
