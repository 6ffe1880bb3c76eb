// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/wire/cdr_key.hpp"
#include "core/wire/memory/participant_state.hpp"

namespace adit::wire {

void ReaderState::on_data(EndpointId writer, std::uint64_t start, const Sample& sample,
                          std::uint16_t frames) {
  const auto found = writers.find(writer);
  if (found == writers.end()) return;  // Not matched yet: a reliable writer repeats it.
  Proxy& proxy = found->second;
  if (proxy.next == 0) proxy.next = start;
  if (sample.sequence < proxy.next) return;  // Duplicate.
  if (!proxy.reliable) {
    if (frames < sample.frames) return;
    if (!discovery)
      owner->count(topic.name, owner->peer_participant(writer.node)->id).lost += sample.sequence - proxy.next;
    proxy.next = sample.sequence + 1;
    deliver(writer, sample);
    return;
  }
  const auto held = proxy.held.try_emplace(sample.sequence, Held{sample, sample.frames}).first;
  held->second.missing =
      static_cast<std::uint16_t>(held->second.missing - std::min(frames, held->second.missing));
  drain(writer, proxy);
}

void ReaderState::on_heartbeat(EndpointId writer, std::uint64_t start, std::uint64_t first,
                               std::uint64_t last) {
  constexpr std::size_t at_once = 32;  // Number of missing samples requested at once.
  const auto found = writers.find(writer);
  if (found == writers.end()) return;
  Proxy& proxy = found->second;
  if (proxy.next == 0) proxy.next = start;
  // Samples older than the writer's history will never arrive.
  while (proxy.next < first) {
    const auto held = proxy.held.begin();
    if (held == proxy.held.end() || held->first >= first) {
      if (!discovery)
        owner->count(topic.name, owner->peer_participant(writer.node)->id).lost += first - proxy.next;
      proxy.next = first;
    } else if (held->first == proxy.next && held->second.missing == 0) {
      drain(writer, proxy);
    } else {
      const bool complete = held->second.missing == 0;
      if (!discovery) {
        owner->count(topic.name, owner->peer_participant(writer.node)->id).lost +=
            held->first - proxy.next + (complete ? 0 : 1);
      }
      proxy.next = held->first + (complete ? 0 : 1);
      if (!complete) proxy.held.erase(held);
    }
  }
  drain(writer, proxy);
  std::vector<Missing> missing;
  for (std::uint64_t s = proxy.next; s <= last && missing.size() < at_once; ++s) {
    const auto held = proxy.held.find(s);
    if (held == proxy.held.end()) {
      missing.push_back({s, 0});
    } else if (held->second.missing > 0) {
      missing.push_back({s, held->second.missing});
    }
  }
  owner->core->after(WireCost::kResponse,
                     [keep = owner->shared_from_this(), writer, entity_id = entity, base = proxy.next,
                      missing = std::move(missing), is_discovery = discovery] {
                       if (keep->stopped) return;
                       Datagram datagram;
                       datagram.bytes = WireCost::kAcknack;
                       datagram.priority = WireCost::kDiscoveryPriority;
                       keep->send(
                           writer.node, std::move(datagram),
                           [reader = EndpointId{keep->node, entity_id}, writer, base, missing, is_discovery](
                               ParticipantState& there, std::uint16_t) {
                             if (is_discovery)
                               return there.discovery_writer->on_acknack(reader, base, missing);
                             const auto target = there.writers.find(writer.entity);
                             if (target != there.writers.end())
                               target->second->on_acknack(reader, base, missing);
                           },
                           is_discovery);
                     });
}

void ReaderState::on_gap(EndpointId writer, const std::vector<std::uint64_t>& sequences) {
  const auto found = writers.find(writer);
  if (found == writers.end()) return;
  for (const std::uint64_t sequence : sequences) {
    if (sequence < found->second.next) continue;
    Sample nothing;
    nothing.sequence = sequence;
    if (found->second.held.try_emplace(sequence, Held{nothing, 0}).second && !discovery) {
      ++owner->count(topic.name, owner->peer_participant(writer.node)->id).lost;
    }
  }
  drain(writer, found->second);
}

void ReaderState::drain(EndpointId writer, Proxy& proxy) {
  while (!proxy.held.empty() && proxy.held.begin()->first == proxy.next &&
         proxy.held.begin()->second.missing == 0) {
    const Sample sample = std::move(proxy.held.begin()->second.sample);
    proxy.held.erase(proxy.held.begin());
    ++proxy.next;
    if (sample.bytes || sample.endpoint >= 0) deliver(writer, sample);
  }
}

void ReaderState::deliver(EndpointId writer, const Sample& sample) {
  if (discovery) {
    owner->on_endpoint(writer.node, sample.endpoint);
    return;
  }
  const ParticipantState* sender = owner->peer_participant(writer.node);
  TopicCount& in = owner->count(topic.name, sender->id);
  ++in.samples_in;
  if (sample.bytes->size() > topic.max_bytes) {
    ++in.malformed;
    return;
  }
  owner->core->show(SampleEvent::Kind::delivered, *sender, owner, topic, sample.bytes);
  if (strand == nullptr) return;
  if (topic.keyed && !take_key(writer, sample.key)) {
    ++in.lost;
    return;
  }
  const std::uint64_t key = topic.keyed ? key_number(sample.key) : 0;
  mailbox.put({sender->id, key, strand->now(), sample.bytes->size(), sample.bytes},
              [this](const Box::Entry& old) { ++owner->count(topic.name, old.sender).overwritten; });
  if (!posted) post();
}

bool ReaderState::take_key(EndpointId writer, const std::string& key) {
  const auto known = keys.find(key);
  if (known != keys.end()) {
    known->second.insert(writer);
    return true;
  }
  if (keys.size() >= kMaxKeys) {
    std::erase_if(keys, [this](const auto& entry) {
      return std::none_of(entry.second.begin(), entry.second.end(),
                          [this](EndpointId id) { return writers.contains(id); });
    });
  }
  if (keys.size() >= kMaxKeys) return false;
  keys[key].insert(writer);
  return true;
}

void ReaderState::post() {
  posted = strand->post_control([weak = weak_from_this(), keep = std::weak_ptr(owner->shared_from_this())] {
    const auto participant = keep.lock();
    if (const auto self = weak.lock(); self && participant) self->handle();
  });
}

void ReaderState::handle() {
  for (int i = 0; i < kBurstSamples; ++i) {
    if (strand == nullptr || owner->stopped || mailbox.empty()) {
      posted = false;
      return;
    }
    const Box::Entry entry = mailbox.take();
    bool good = true;
    try {
      good = handler(*entry.payload, SampleInfo{entry.sender, entry.received});
    } catch (...) {
      if (strand != nullptr) post();  // The samples after it are still handled.
      throw;
    }
    if (!good) ++owner->count(topic.name, entry.sender).malformed;
  }
  if (strand != nullptr) post();
}

}  // namespace adit::wire
