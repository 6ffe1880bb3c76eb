// SPDX-License-Identifier: Apache-2.0
#include "core/wire/memory/participant_state.hpp"

#include <algorithm>

#include "core/wire/contract.hpp"

namespace adit::wire {
namespace {

bool fits(const TopicOf& writer, const TopicOf& reader) {
  return writer.name == reader.name && writer.type == reader.type && writer.partition == reader.partition &&
         writer.keyed == reader.keyed && (writer.qos.reliable || !reader.qos.reliable) &&
         (writer.qos.transient_local || !reader.qos.transient_local);
}

constexpr int kDiscoveryWriterEntity = 1;
constexpr int kDiscoveryReaderEntity = 2;

}  // namespace

void ParticipantState::start() {
  discovery_writer = std::make_shared<WriterState>();
  discovery_writer->owner = this;
  discovery_writer->entity = kDiscoveryWriterEntity;
  discovery_writer->discovery = true;
  discovery_writer->topic.qos = {true, true, Discovery::kHeartbeat, WireCost::kDiscoveryPriority, false};
  discovery_reader = std::make_shared<ReaderState>();
  discovery_reader->owner = this;
  discovery_reader->entity = kDiscoveryReaderEntity;
  discovery_reader->discovery = true;
  announce();
  check_leases();
}

void ParticipantState::announce() {
  if (stopped) return;
  std::vector<int> everybody;
  for (const auto& other : core->participants) {
    if (other.get() != this && other->domain == domain && !other->stopped) everybody.push_back(other->node);
  }
  // As Fast DDS: by multicast, and by unicast to each known peer. Peers that know us need that once a period,
  // as DiscoveryAssist does live.
  Datagram to_all;
  to_all.bytes = WireCost::kParticipant;
  to_all.priority = WireCost::kDiscoveryPriority;
  to_all.sent = [self = shared_from_this()] {
    self->totals.discovery_out += WireCost::kParticipant;
    self->totals.total_out += WireCost::kParticipant;
  };
  to_all.arrived = [self = shared_from_this()](int to, std::uint16_t) {
    ParticipantState* there = self->peer_participant(to);
    if (there == nullptr || there->stopped) return;
    there->totals.discovery_in += WireCost::kParticipant;
    there->totals.total_in += WireCost::kParticipant;
    there->on_announcement(self->node);
  };
  core->radio->multicast(node, everybody, std::move(to_all));
  const bool initial = ++announced < Discovery::kInitialAnnouncements;
  for (const auto& [peer, state] : peers) {
    if (!initial || !state.knows_us) announce_to(peer);
  }
  core->after(initial ? Discovery::kInitialPeriod : Discovery::kAnnouncement, [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->announce();
  });
}

void ParticipantState::check_leases() {
  if (stopped) return;
  const Duration now = core->scheduler.elapsed();
  std::vector<int> over;
  for (const auto& [peer, state] : peers) {
    if (now - state.heard > Discovery::kLease) over.push_back(peer);
  }
  constexpr std::size_t kMaxSilent = 64;
  for (const int peer : over) {
    const Peer& state = peers.at(peer);
    if (state.knows_us && silent.size() < kMaxSilent) silent[peer] = {state.machine, now, {}};
    drop(peer);
  }
  search(now);
  core->after(1s, [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->check_leases();
  });
}

void ParticipantState::search(Duration now) {
  std::erase_if(silent, [&](const auto& entry) { return now - entry.second.since > Discovery::kSearch; });
  int left = static_cast<int>(1s / Discovery::kSearchStep);  // This is called once a second.
  for (auto& [peer, state] : silent) {
    if (now - state.announced < Discovery::kSearchPeriod || left-- <= 0) continue;
    state.announced = now;
    announce_to(peer);
  }
}

void ParticipantState::on_announcement(int from) {
  const auto [peer, is_new] = peers.try_emplace(from);
  if (is_new) {
    if (const ParticipantState* there = peer_participant(from)) peer->second.machine = there->machine;
    // A program that was started again has the address of the one before.
    std::erase_if(silent, [&](const auto& entry) {
      return entry.first == from || entry.second.machine == peer->second.machine;
    });
  }
  peer->second.heard = core->scheduler.elapsed();
  if (!peer->second.knows_us) {
    peer->second.announcements_left = Discovery::kAnnounceRetries;
    if (!peer->second.announcing) announce_again(from);
  }
  if (!is_new) return;
  notify(from, true);
  announce_to(from);
  discovery_reader->writers.try_emplace(EndpointId{from, kDiscoveryWriterEntity},
                                        ReaderState::Proxy{true, 0, {}});
  discovery_writer->match({from, kDiscoveryReaderEntity}, discovery_writer->topic.qos);
}

void ParticipantState::announce_to(int peer) {
  Datagram datagram;
  datagram.bytes = WireCost::kParticipant;
  datagram.priority = WireCost::kDiscoveryPriority;
  datagram.supersedes = 1;  // One queued acknowledgement is enough.
  datagram.again = true;
  send(
      peer, std::move(datagram),
      [me = node](ParticipantState& there, std::uint16_t) { there.on_announcement(me); }, true);
}

void ParticipantState::announce_again(int peer) {
  peers.at(peer).announcing = true;
  core->after(Discovery::kAnnounceRetryPeriod, [weak = weak_from_this(), peer] {
    const auto self = weak.lock();
    if (!self || self->stopped) return;
    const auto known = self->peers.find(peer);
    if (known == self->peers.end()) return;
    known->second.announcing = false;
    if (known->second.knows_us || --known->second.announcements_left < 0) return;
    self->announce_to(peer);
    self->announce_again(peer);
  });
}

void ParticipantState::on_endpoint(int from, int entity) {
  const auto peer = peers.find(from);
  const ParticipantState* other = peer_participant(from);
  if (peer == peers.end() || other == nullptr) return;
  const EndpointId endpoint{from, entity};
  const auto writer = other->writers.find(entity);
  const auto reader = other->readers.find(entity);
  const std::string version = writer != other->writers.end()   ? other_release(writer->second->topic.type)
                              : reader != other->readers.end() ? other_release(reader->second->topic.type)
                                                               : std::string{};
  if (!version.empty() && peer->second.incompatible.empty()) {
    peer->second.incompatible = describe_release(other->machine, version);
    notify(from, true, peer->second.incompatible);
  }
  if (writer != other->writers.end()) {
    peer->second.writers[entity] = writer->second->topic;
    for (const auto& [own, state] : readers) {
      if (!fits(writer->second->topic, state->topic)) continue;
      const bool reliable = state->topic.qos.reliable;
      state->writers.try_emplace(endpoint, ReaderState::Proxy{reliable, 0, {}});
    }
  } else if (reader != other->readers.end()) {
    peer->second.readers[entity] = reader->second->topic;
    for (const auto& [own, state] : writers) {
      if (fits(state->topic, reader->second->topic)) state->match(endpoint, reader->second->topic.qos);
    }
  } else {
    peer->second.writers.erase(entity);
    peer->second.readers.erase(entity);
    for (const auto& [own, state] : readers) state->writers.erase(endpoint);
    for (const auto& [own, state] : writers) state->readers.erase(endpoint);
  }
}

void ParticipantState::drop(int peer) {
  if (peers.erase(peer) == 0) return;
  carried.erase(peer);
  const auto of_peer = [peer](const auto& entry) { return entry.first.node == peer; };
  for (const auto& [own, state] : readers) std::erase_if(state->writers, of_peer);
  for (const auto& [own, state] : writers) std::erase_if(state->readers, of_peer);
  std::erase_if(discovery_reader->writers, of_peer);
  std::erase_if(discovery_writer->readers, of_peer);
  notify(peer, false);
}

void ParticipantState::stop(bool goodbye) {
  if (stopped) return;
  if (goodbye && !core->closed) {
    std::vector<int> known;
    for (const auto& [peer, state] : peers) known.push_back(peer);
    Datagram datagram;
    datagram.bytes = WireCost::kGoodbye;
    datagram.priority = 6;  // After samples that were written before.
    datagram.arrived = [self = shared_from_this()](int to, std::uint16_t) {
      ParticipantState* there = self->peer_participant(to);
      if (there != nullptr && !there->stopped) there->drop(self->node);
    };
    core->radio->multicast(node, std::move(known), std::move(datagram));
    core->after(1s, [keep = core->shared_from_this(), at = node] { keep->radio->remove(at); });
  } else {
    core->radio->remove(node);
  }
  stopped = true;
  for (const auto& [entity, reader] : readers) reader->strand = nullptr;
}

Result<void> ParticipantState::use(const TopicInfo& topic) {
  const auto is_of = [&](const auto& endpoint) { return endpoint.second->topic.name == topic.name; };
  if (std::none_of(writers.begin(), writers.end(), is_of) &&
      std::none_of(readers.begin(), readers.end(), is_of))
    known_topics.forget(topic.name);
  return known_topics.add(topic);
}

std::vector<RemoteEndpoint> ParticipantState::endpoints(const std::string& topic) const {
  std::vector<RemoteEndpoint> result;
  for (const auto& [peer, known] : peers)
    for (const auto* of : {&known.writers, &known.readers})
      for (const auto& [entity, endpoint] : *of)
        if (endpoint.name == topic)
          result.push_back({peer_participant(peer)->id, endpoint.type, of == &known.writers});
  return result;
}

void ParticipantState::add_writer(const std::shared_ptr<WriterState>& writer) {
  writers[writer->entity] = writer;
  for (const auto& [peer_node, peer] : peers) {
    for (const auto& [entity, topic] : peer.readers) {
      if (fits(writer->topic, topic)) writer->match({peer_node, entity}, topic.qos);
    }
  }
  publish_endpoint(writer->entity);
}

void ParticipantState::add_reader(const std::shared_ptr<ReaderState>& reader) {
  readers[reader->entity] = reader;
  for (const auto& [peer_node, peer] : peers) {
    for (const auto& [entity, topic] : peer.writers) {
      if (!fits(topic, reader->topic)) continue;
      reader->writers.try_emplace(EndpointId{peer_node, entity},
                                  ReaderState::Proxy{reader->topic.qos.reliable, 0, {}});
    }
  }
  publish_endpoint(reader->entity);
}

void ParticipantState::remove_writer(int entity) {
  if (writers.erase(entity) > 0) publish_endpoint(entity);
}

void ParticipantState::remove_reader(int entity) {
  const auto found = readers.find(entity);
  if (found == readers.end()) return;
  found->second->strand = nullptr;
  readers.erase(found);
  publish_endpoint(entity);
}

void ParticipantState::publish_endpoint(int entity) {
  if (stopped || core->closed) return;
  Sample sample;
  sample.key = std::to_string(entity);
  sample.endpoint = entity;
  sample.wire_bytes = WireCost::kEndpoint;
  discovery_writer->add(std::move(sample));
}

void ParticipantState::send(int to, Datagram datagram,
                            std::function<void(ParticipantState&, std::uint16_t)> arrive, bool discovery) {
  if (core->closed) return;
  const std::uint32_t bytes = datagram.bytes;
  datagram.sent = [self = shared_from_this(), to, bytes, discovery, also = std::move(datagram.sent)] {
    self->totals.total_out += bytes;
    self->carried[to].bytes_out += bytes;
    if (discovery) self->totals.discovery_out += bytes;
    if (also) also();
  };
  datagram.arrived = [self = shared_from_this(), bytes, frames = datagram.frames, discovery,
                      arrive = std::move(arrive)](int there_node, std::uint16_t through) {
    ParticipantState* there = self->peer_participant(there_node);
    if (there == nullptr || there->stopped) return;
    const std::uint32_t in = bytes * through / frames;
    there->totals.total_in += in;
    there->carried[self->node].bytes_in += in;
    if (discovery) there->totals.discovery_in += in;
    const auto peer = there->peers.find(self->node);
    if (peer != there->peers.end()) {
      peer->second.heard = there->core->scheduler.elapsed();
      peer->second.knows_us = true;  // The peer sends to us, so it knows us.
    }
    arrive(*there, through);
  };
  core->radio->send(node, to, std::move(datagram));
}

ParticipantState* ParticipantState::peer_participant(int peer_node) const {
  return core->participants[static_cast<std::size_t>(peer_node)].get();
}

void ParticipantState::notify(int peer, bool present, const std::string& incompatible) {
  if (!event_handler || stopped) return;
  event_strand->post([handler = std::weak_ptr(event_handler),
                      event = ParticipantEvent{peer_participant(peer)->id, present, incompatible}] {
    if (const auto call = handler.lock()) (*call)(event);
  });
}

TopicCount& ParticipantState::count(const std::string& topic, const ParticipantId& peer) {
  TopicCount& entry = counts[{topic, peer}];
  if (entry.topic.empty()) entry.topic = topic, entry.peer = peer;
  return entry;
}

}  // namespace adit::wire
