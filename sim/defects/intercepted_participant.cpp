// SPDX-License-Identifier: Apache-2.0
#include "sim/defects/intercepted_participant.hpp"

#include <algorithm>
#include <list>
#include <string_view>

namespace adit::sim {

std::vector<Arrival> Interceptor::received(Arrival arrival) {
  std::vector<Arrival> out;
  out.push_back(std::move(arrival));
  return out;
}

std::vector<Cdr> Interceptor::sent(const wire::TopicInfo&, Cdr cdr) {
  std::vector<Cdr> out;
  out.push_back(std::move(cdr));
  return out;
}

namespace {

class Writer final : public wire::RawWriter {
 public:
  Writer(std::unique_ptr<wire::RawWriter> inner, const wire::TopicInfo& topic, Interceptor& interceptor)
      : inner_(std::move(inner)), topic_(topic), interceptor_(interceptor) {}

  Result<void> write(std::span<const std::uint8_t> cdr) override {
    Result<void> result{};
    for (const Cdr& sample : interceptor_.sent(topic_, Cdr(cdr.begin(), cdr.end())))
      if (auto written = inner_->write(sample); !written) result = written;
    return result;
  }
  std::size_t matched() const override { return inner_->matched(); }

 private:
  std::unique_ptr<wire::RawWriter> inner_;
  wire::TopicInfo topic_;
  Interceptor& interceptor_;
};

/// What an agent's reader is made of.
struct Entry {
  wire::TopicInfo topic;
  Executor& strand;
  wire::RawHandler handler;
  std::vector<Timer> late{};  ///< Samples that wait for their delay.
};

}  // namespace

struct InterceptedParticipant::Readers {
  std::list<std::shared_ptr<Entry>> entries{};

  bool hand_over(const Arrival& arrival) const {
    const auto to = std::find_if(entries.begin(), entries.end(), [&](const auto& entry) {
      return std::string_view(entry->topic.name) == arrival.topic->name &&
             std::string_view(entry->topic.type) == arrival.topic->type;
    });
    if (to == entries.end()) return true;
    if (arrival.delay <= Duration{0}) return (*to)->handler(arrival.cdr, arrival.info);
    std::erase_if((*to)->late, [](const Timer& timer) { return !timer.active(); });
    (*to)->late.push_back((*to)->strand.after(
        arrival.delay, [entry = std::weak_ptr<Entry>(*to), cdr = arrival.cdr, info = arrival.info] {
          if (const auto alive = entry.lock()) (void)alive->handler(cdr, info);
        }));
    return true;
  }
};

namespace {

/// Takes its entry out of the list when the agent drops it.
template <class List>
class Reader final : public wire::RawReader {
 public:
  Reader(std::shared_ptr<List> readers, std::shared_ptr<Entry> entry)
      : readers_(std::move(readers)), entry_(std::move(entry)) {}
  ~Reader() override {
    inner.reset();
    readers_->entries.remove(entry_);
  }
  std::unique_ptr<wire::RawReader> inner{};

 private:
  std::shared_ptr<List> readers_;
  std::shared_ptr<Entry> entry_;
};

}  // namespace

InterceptedParticipant::InterceptedParticipant(wire::Participant& inner, Interceptor& interceptor)
    : ForwardingParticipant(inner), interceptor_(interceptor), readers_(std::make_shared<Readers>()) {}

InterceptedParticipant::~InterceptedParticipant() = default;

Result<std::unique_ptr<wire::RawWriter>> InterceptedParticipant::make_writer(const wire::TopicInfo& topic,
                                                                             const std::string& partition) {
  auto made = inner_.make_writer(topic, partition);
  if (!made) return made.error();
  return std::unique_ptr<wire::RawWriter>(std::make_unique<Writer>(std::move(*made), topic, interceptor_));
}

Result<std::unique_ptr<wire::RawReader>> InterceptedParticipant::make_reader(const wire::TopicInfo& topic,
                                                                             const std::string& partition,
                                                                             Executor& strand,
                                                                             wire::RawHandler handler) {
  const auto entry = std::make_shared<Entry>(Entry{topic, strand, std::move(handler)});
  readers_->entries.push_back(entry);
  auto reader = std::make_unique<Reader<Readers>>(readers_, entry);
  auto made = inner_.make_reader(
      topic, partition, strand,
      [this, topic, readers = readers_](std::span<const std::uint8_t> cdr, const wire::SampleInfo& info) {
        bool good = true;
        for (const Arrival& arrival : interceptor_.received({&topic, Cdr(cdr.begin(), cdr.end()), info, {}}))
          good = readers->hand_over(arrival) && good;
        return good;
      });
  if (!made) return made.error();
  reader->inner = std::move(*made);
  return std::unique_ptr<wire::RawReader>(std::move(reader));
}

}  // namespace adit::sim
