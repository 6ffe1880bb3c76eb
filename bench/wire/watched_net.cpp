// SPDX-License-Identifier: Apache-2.0
#include "bench/wire/watched_net.hpp"

#include "core/wire/cdr_key.hpp"
#include "core/wire/forwarding_participant.hpp"

namespace adit::bench {
namespace {

std::uint64_t content(std::span<const std::uint8_t> bytes) {
  return wire::key_number({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

class WatchedWire final : public wire::ForwardingParticipant {
 public:
  WatchedWire(std::unique_ptr<wire::Participant> inner, live::Net& net, Passages& passages)
      : ForwardingParticipant(*inner), owned_(std::move(inner)), net_(net), passages_(passages) {}

  Result<std::unique_ptr<wire::RawWriter>> make_writer(const wire::TopicInfo& topic,
                                                       const std::string& partition) override {
    auto made = inner_.make_writer(topic, partition);
    if (!made) return made;
    return std::unique_ptr<wire::RawWriter>(
        std::make_unique<Writer>(std::move(*made), topic.name, net_, passages_));
  }
  Result<std::unique_ptr<wire::RawReader>> make_reader(const wire::TopicInfo& topic,
                                                       const std::string& partition, Executor& strand,
                                                       wire::RawHandler handler) override {
    return inner_.make_reader(topic, partition, strand,
                              [this, name = std::string(topic.name), handler = std::move(handler)](
                                  auto cdr, const wire::SampleInfo& info) {
                                passages_.arrived(name, cdr, net_.clock());
                                return handler(cdr, info);
                              });
  }

 private:
  class Writer final : public wire::RawWriter {
   public:
    Writer(std::unique_ptr<wire::RawWriter> inner, std::string topic, live::Net& net, Passages& passages)
        : inner_(std::move(inner)), topic_(std::move(topic)), net_(net), passages_(passages) {}
    Result<void> write(std::span<const std::uint8_t> cdr) override {
      passages_.written(topic_, cdr, net_.clock());
      return inner_->write(cdr);
    }
    std::size_t matched() const override { return inner_->matched(); }

   private:
    std::unique_ptr<wire::RawWriter> inner_;
    std::string topic_;
    live::Net& net_;
    Passages& passages_;
  };

  std::unique_ptr<wire::Participant> owned_;
  live::Net& net_;
  Passages& passages_;
};

}  // namespace

void Passages::written(const std::string& topic, std::span<const std::uint8_t> cdr, Duration at) {
  const std::lock_guard lock(mutex_);
  if (!counting_) return;
  const auto [sample, is_new] = samples_.try_emplace({topic, content(cdr)}, Sample{naming_(topic, cdr), at});
  if (is_new) ++rows_[sample->second.name].written;
}

void Passages::arrived(const std::string& topic, std::span<const std::uint8_t> cdr, Duration at) {
  const std::lock_guard lock(mutex_);
  const auto sample = samples_.find({topic, content(cdr)});
  if (sample == samples_.end() || sample->second.arrived) return;
  sample->second.arrived = true;
  Row& row = rows_[sample->second.name];
  ++row.arrived;
  row.took.push_back(seconds(at - sample->second.at));
}

std::map<std::string, Passages::Row> Passages::rows() const {
  const std::lock_guard lock(mutex_);
  return rows_;
}

void Passages::count(bool counting) {
  const std::lock_guard lock(mutex_);
  counting_ = counting;
}

std::unique_ptr<wire::Participant> WatchedNet::join_radio(const std::string& machine) {
  return std::make_unique<WatchedWire>(inner_->join_radio(machine), *inner_, passages_);
}

}  // namespace adit::bench
