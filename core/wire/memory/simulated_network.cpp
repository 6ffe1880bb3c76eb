// SPDX-License-Identifier: Apache-2.0
#include "core/wire/memory/simulated_network.hpp"

#include <algorithm>

#include "core/wire/memory/participant_state.hpp"

namespace adit::wire {
namespace {

class MemoryWriter final : public RawWriter {
 public:
  MemoryWriter(std::shared_ptr<ParticipantState> owner, std::shared_ptr<WriterState> state)
      : owner_(std::move(owner)), state_(std::move(state)) {}
  ~MemoryWriter() override { owner_->remove_writer(state_->entity); }
  Result<void> write(std::span<const std::uint8_t> cdr) override { return state_->write(cdr); }
  std::size_t matched() const override { return state_->readers.size(); }

 private:
  std::shared_ptr<ParticipantState> owner_;
  std::shared_ptr<WriterState> state_;
};

class MemoryReader final : public RawReader {
 public:
  MemoryReader(std::shared_ptr<ParticipantState> owner, int entity)
      : owner_(std::move(owner)), entity_(entity) {}
  ~MemoryReader() override { owner_->remove_reader(entity_); }

 private:
  std::shared_ptr<ParticipantState> owner_;
  int entity_;
};

TopicOf topic_of(const TopicInfo& topic, const std::string& partition, const Qos& qos) {
  return {topic.name,  topic.type,     partition, topic.qos, qos, std::max<std::size_t>(topic.depth, 1),
          topic.keyed, topic.max_bytes};
}

class MemoryParticipant final : public Participant {
 public:
  MemoryParticipant(std::shared_ptr<SimulatedNetwork::State> core,
                    std::shared_ptr<ParticipantState> participant)
      : core_(std::move(core)), participant_(std::move(participant)) {}
  ~MemoryParticipant() override { participant_->stop(true); }

  ParticipantId id() const override { return participant_->id; }

  Result<std::unique_ptr<RawWriter>> make_writer(const TopicInfo& topic,
                                                 const std::string& partition) override {
    if (const auto allowed = participant_->use(topic); !allowed) return allowed.error();
    auto state = std::make_shared<WriterState>();
    state->owner = participant_.get();
    state->entity = participant_->next_entity++;
    state->topic = topic_of(topic, partition, writer_qos(topic));
    participant_->add_writer(state);
    return std::unique_ptr<RawWriter>(std::make_unique<MemoryWriter>(participant_, state));
  }

  Result<std::unique_ptr<RawReader>> make_reader(const TopicInfo& topic, const std::string& partition,
                                                 Executor& strand, RawHandler handler) override {
    if (const auto allowed = participant_->use(topic); !allowed) return allowed.error();
    auto state = std::make_shared<ReaderState>();
    state->owner = participant_.get();
    state->entity = participant_->next_entity++;
    state->topic = topic_of(topic, partition, reader_qos(topic));
    state->strand = &strand;
    state->handler = std::move(handler);
    state->mailbox = ReaderState::Box(mailbox_depth(topic), topic.max_bytes);
    participant_->add_reader(state);
    return std::unique_ptr<RawReader>(std::make_unique<MemoryReader>(participant_, state->entity));
  }

  void on_participant(Executor& strand, std::function<void(const ParticipantEvent&)> handler) override {
    participant_->event_strand = handler ? &strand : nullptr;
    if (!handler) return participant_->event_handler.reset();
    participant_->event_handler =
        std::make_shared<std::function<void(const ParticipantEvent&)>>(std::move(handler));
    for (const auto& [peer, state] : participant_->peers) {
      participant_->notify(peer, true);
      if (!state.incompatible.empty()) participant_->notify(peer, true, state.incompatible);
    }
  }

  std::vector<RemoteEndpoint> endpoints(const std::string& topic) const override {
    return participant_->endpoints(topic);
  }

  WireCounters counters() const override {
    WireCounters result = participant_->totals;
    for (const auto& [key, count] : participant_->counts) result.topics.push_back(count);
    return result;
  }

  SenderState sender() const override { return core_->radio->sender(participant_->node); }

  std::vector<PeerState> peers() const override {
    std::vector<PeerState> result;
    for (const auto& [node, state] : participant_->carried) {
      if (!participant_->peers.contains(node)) continue;
      PeerState& peer = result.emplace_back(state);
      const ParticipantState& other = *participant_->peer_participant(node);
      peer.peer = other.id;
      if (!core_->radio->is_local_domain(node))
        peer.signal = core_->radio->signal(other.machine, participant_->machine);
    }
    std::sort(result.begin(), result.end(),
              [](const PeerState& a, const PeerState& b) { return a.peer < b.peer; });
    return result;
  }

  void set_place(const ParticipantId&, const Position&) override {
  }  // SimulatedNetwork::set_position() sets the true position.

 private:
  std::shared_ptr<SimulatedNetwork::State> core_;
  std::shared_ptr<ParticipantState> participant_;
};

}  // namespace

SimulatedNetwork::State::State(VirtualScheduler& s, SimulatedNetworkParams p)
    : scheduler(s),
      params(std::move(p)),
      radio(std::make_shared<Radio>(s, params.seed, params.link, params.inner_latency)),
      ids(params.seed ^ 0x9d5c1f60a3b7e241ULL) {}

void SimulatedNetwork::State::after(Duration delay, Task task) {
  scheduler.at(scheduler.elapsed() + delay, [weak = weak_from_this(), task = std::move(task)] {
    const auto self = weak.lock();
    if (self && !self->closed) task();
  });
}

ParticipantId SimulatedNetwork::State::new_id() {
  ParticipantId id{};
  const std::uint64_t drawn = ids.next();
  for (std::size_t i = 0; i < 8; ++i) id[i] = static_cast<std::uint8_t>(drawn >> (8 * i));
  const std::uint64_t number = participants.size() + 1;  // Unique even if two draws are equal.
  for (std::size_t i = 0; i < 4; ++i) id[8 + i] = static_cast<std::uint8_t>(number >> (8 * i));
  return id;
}

void SimulatedNetwork::State::show(SampleEvent::Kind kind, const ParticipantState& from,
                                   const ParticipantState* to, const TopicOf& topic, const Payload& bytes) {
  if (!tap) return;
  SampleEvent frame;
  frame.kind = kind;
  frame.at = scheduler.elapsed();
  frame.from = from.id;
  frame.from_name = from.machine;
  if (to != nullptr) frame.to = to->id, frame.to_name = to->machine;
  frame.domain = from.domain;
  frame.topic = topic.name;
  frame.type = topic.type;
  frame.partition = topic.partition;
  frame.bytes = *bytes;
  tap(frame);
}

SimulatedNetwork::SimulatedNetwork(VirtualScheduler& scheduler, SimulatedNetworkParams params)
    : core_(std::make_shared<State>(scheduler, std::move(params))) {}

SimulatedNetwork::~SimulatedNetwork() {
  core_->closed = true;
  core_->radio->close();
  core_->tap = nullptr;
  for (const auto& participant : core_->participants) participant->stop(false);
}

std::unique_ptr<Participant> SimulatedNetwork::join(std::uint32_t domain, const std::string& machine) {
  auto participant = std::make_shared<ParticipantState>();
  participant->core = core_.get();
  participant->id = core_->new_id();
  participant->domain = domain;
  participant->machine = machine;
  participant->node = core_->radio->add(machine, domain != core_->params.radio_domain);
  core_->participants.push_back(participant);
  participant->start();
  return std::make_unique<MemoryParticipant>(core_, std::move(participant));
}

void SimulatedNetwork::crash(const std::string& machine) {
  for (const auto& participant : core_->participants) {
    if (participant->machine == machine) participant->stop(false);
  }
}

void SimulatedNetwork::set_link(const std::string& a, const std::string& b, const LinkProfile& profile) {
  core_->radio->set_link(a, b, profile);
}
DisturbanceId SimulatedNetwork::disturb(Disturbance disturbance) {
  return core_->radio->disturbances().add(std::move(disturbance));
}
void SimulatedNetwork::end_disturbance(DisturbanceId id) { core_->radio->disturbances().end(id); }

void SimulatedNetwork::cut(const std::string& a, const std::string& b, bool is_cut) {
  const auto key = std::minmax(a, b);
  const auto old = cuts_.find(key);
  if (old != cuts_.end()) {
    end_disturbance(old->second);
    cuts_.erase(old);
  }
  if (is_cut) cuts_[key] = disturb({.from = {a}, .to = {b}, .cut = true});
}

void SimulatedNetwork::degrade(const std::string& a, const std::string& b, std::optional<double> loss) {
  const auto key = std::minmax(a, b);
  const auto old = degraded_.find(key);
  if (old != degraded_.end()) {
    end_disturbance(old->second);
    degraded_.erase(old);
  }
  if (loss) degraded_[key] = disturb({.from = {a}, .to = {b}, .loss = loss});
}

void SimulatedNetwork::set_position(const std::string& machine, double x, double y, double z) {
  core_->radio->set_position(machine, {x, y, z});
}
void SimulatedNetwork::set_attenuation(Attenuation walls) { core_->radio->set_attenuation(std::move(walls)); }
std::optional<double> SimulatedNetwork::signal(const std::string& from, const std::string& to) const {
  return core_->radio->signal(from, to);
}
void SimulatedNetwork::set_tap(std::function<void(const SampleEvent&)> tap) { core_->tap = std::move(tap); }

}  // namespace adit::wire
