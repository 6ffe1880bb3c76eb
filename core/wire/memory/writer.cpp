// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/wire/cdr_key.hpp"
#include "core/wire/memory/participant_state.hpp"

namespace adit::wire {
namespace {

std::uint64_t number_of(const std::string& key, int writer, int reader) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  const auto mix = [&hash](std::uint64_t byte) { hash = (hash ^ byte) * 0x100000001b3ULL; };
  for (const char c : key) mix(static_cast<unsigned char>(c));
  mix(static_cast<std::uint64_t>(writer));
  mix(static_cast<std::uint64_t>(reader));
  return hash | 1;
}

}  // namespace

Result<void> WriterState::write(std::span<const std::uint8_t> cdr) {
  if (cdr.size() > topic.max_bytes) {
    return refused(Reason::out_of_range, "sample of " + std::to_string(cdr.size()) + " bytes, at most " +
                                             std::to_string(topic.max_bytes) + " are allowed");
  }
  Sample sample;
  if (topic.keyed) {
    const auto key = first_string(cdr);
    if (!key) return refused(Reason::malformed, "the sample has no key");
    sample.key = *key;
    if (!keys.contains(sample.key)) {
      if (keys.size() >= kMaxKeys) return refused(Reason::queue_full, "too many keys");
      keys.insert(sample.key);
    }
  }
  ++owner->count(topic.name, {}).samples_out;
  sample.bytes = std::make_shared<const std::vector<std::uint8_t>>(cdr.begin(), cdr.end());
  const std::uint32_t largest = owner->core->radio->frame_bytes(owner->node);
  sample.frames = WireCost::frames(cdr.size(), largest);
  sample.wire_bytes = WireCost::sample(cdr.size(), largest);
  if (!owner->stopped) owner->core->show(SampleEvent::Kind::sent, *owner, nullptr, topic, sample.bytes);
  add(std::move(sample));
  return {};
}

Error WriterState::refused(Reason reason, const std::string& why) {
  ++owner->count(topic.name, {}).failed_writes;
  return Error{reason, topic.name + ": " + why};
}

void WriterState::add(Sample sample) {
  if (owner->stopped) return;
  sample.sequence = next++;
  if (topic.qos.reliable) {
    const auto same_key = [&sample](const Sample& old) { return old.key == sample.key; };
    const auto stored = static_cast<std::size_t>(std::count_if(history.begin(), history.end(), same_key));
    if (stored >= topic.depth) {
      history.erase(std::find_if(history.begin(), history.end(), same_key));
    } else if (history.size() >= kMaxSamples) {
      history.pop_front();
    }
    history.push_back(sample);
  }
  if (topic.qos.paced && !owner->core->radio->is_local_domain(owner->node)) {
    pending.push_back({sample.sequence});
    pump();
  } else {
    for (const auto& [reader, proxy] : readers) send(reader, sample, sample.frames);
  }
  arm_heartbeat();
}

void WriterState::pump() {
  constexpr std::size_t ahead = 2;  // Messages per reader passed to the radio before it has sent them.
  if (pump_armed) return;
  while (!pending.empty() && owner->core->radio->backlog(owner->node, topic.qos.priority) <
                                 ahead * std::max<std::size_t>(1, readers.size())) {
    const Pending entry = pending.front();
    pending.pop_front();
    const auto sample = std::find_if(history.begin(), history.end(),
                                     [&](const Sample& s) { return s.sequence == entry.sequence; });
    if (sample == history.end()) continue;  // Replaced meanwhile by a newer sample.
    const std::uint16_t frames = entry.frames == 0 ? sample->frames : entry.frames;
    sent = std::max(sent, entry.sequence);
    for (const auto& [reader, proxy] : readers) {
      if (entry.reader.node < 0 || entry.reader == reader) send(reader, *sample, frames);
    }
  }
  if (pending.empty()) return;
  pump_armed = true;
  owner->core->after(10ms, [weak = weak_from_this(), keep = std::weak_ptr(owner->shared_from_this())] {
    const auto participant = keep.lock();
    const auto self = weak.lock();
    if (!self || !participant || participant->stopped) return;
    self->pump_armed = false;
    self->pump();
  });
}

void WriterState::repair(Pending entry) {
  const auto known = std::find_if(pending.begin(), pending.end(), [&entry](const Pending& p) {
    return p.sequence == entry.sequence && (p.reader.node < 0 || p.reader == entry.reader);
  });
  if (known != pending.end()) return;
  // Repairs go before samples that were never sent, in order among themselves.
  const auto at = std::find_if(pending.begin(), pending.end(),
                               [&entry](const Pending& p) { return p.sequence > entry.sequence; });
  pending.insert(at, entry);
}

void WriterState::match(EndpointId reader, const Qos& reader_qos) {
  Proxy proxy;
  proxy.reliable = topic.qos.reliable && reader_qos.reliable;
  // As in RTPS: a best-effort reader gets no history, whatever its durability, nor does a volatile one.
  const bool latched = topic.qos.transient_local && reader_qos.transient_local && proxy.reliable;
  const bool late = latched && !history.empty();
  proxy.start = late ? history.front().sequence : next;
  proxy.acknowledged = proxy.start - 1;
  if (!readers.emplace(reader, proxy).second) return;
  if (late) {
    if (discovery) {
      send_endpoints(reader, {history.begin(), history.end()});
    } else {
      for (const Sample& sample : history) send(reader, sample, sample.frames);
    }
    arm_heartbeat();
  }
}

void WriterState::send(EndpointId reader, const Sample& sample, std::uint16_t frames) {
  Datagram datagram;
  datagram.frames = frames;
  datagram.bytes = sample.wire_bytes * frames / sample.frames;
  const auto proxy = readers.find(reader);
  const std::uint64_t start = proxy == readers.end() ? next : proxy->second.start;
  // A full history announces with each sample the first one that is still available, as in Fast DDS: no
  // reader then waits for samples that are gone.
  const bool piggyback = topic.qos.reliable && !topic.qos.paced && !discovery && proxy != readers.end() &&
                         proxy->second.reliable && !history.empty() && !topic.keyed &&
                         proxy->second.acknowledged + topic.depth < next &&
                         !owner->core->radio->is_local_domain(owner->node);
  const std::uint64_t first = piggyback ? history.front().sequence : 0;
  if (piggyback) datagram.bytes += WireCost::kPiggyback;
  datagram.priority = discovery ? WireCost::kDiscoveryPriority : topic.qos.priority;
  if (topic.qos.newest_wins && !topic.qos.reliable) {
    datagram.supersedes = number_of(sample.key, entity, reader.entity);
  } else if (topic.qos.reliable) {
    // A repair requested again while it is queued is sent once, as in the link shaper. Other frames of it are
    // a separate repair.
    datagram.supersedes =
        number_of(std::to_string(sample.sequence) + '/' + std::to_string(frames), entity, reader.entity);
    datagram.again = true;
  }
  if (!discovery) {
    datagram.sent = [self = shared_from_this(), bytes = datagram.bytes] {
      self->owner->count(self->topic.name, {}).bytes_out += bytes;
    };
    if (!topic.qos.reliable) {
      datagram.lost = [self = shared_from_this(), sample](int to) {
        const ParticipantState* receiver = self->owner->peer_participant(to);
        if (receiver != nullptr) {
          self->owner->core->show(SampleEvent::Kind::lost, *self->owner, receiver, self->topic, sample.bytes);
        }
      };
    }
  }
  const auto arrive = [self = shared_from_this(), from = EndpointId{owner->node, entity}, reader, start,
                       first, sample, bytes = datagram.bytes,
                       frames](ParticipantState& there, std::uint16_t through) {
    if (self->discovery) {
      there.discovery_reader->on_data(from, start, sample, through);
      return;
    }
    there.count(self->topic.name, self->owner->id).bytes_in += bytes * through / frames;
    const auto found = there.readers.find(reader.entity);
    if (found == there.readers.end()) return;
    found->second->on_data(from, start, sample, through);
    if (first > 0) found->second->on_heartbeat(from, start, first, sample.sequence);
  };
  owner->send(reader.node, std::move(datagram), arrive, discovery);
}

void WriterState::send_endpoints(EndpointId reader, const std::vector<Sample>& samples) {
  const auto fit =
      std::max<std::size_t>(1, owner->core->radio->frame_bytes(owner->node) / WireCost::kEndpoint);
  const auto proxy = readers.find(reader);
  if (proxy == readers.end()) return;
  for (std::size_t at = 0; at < samples.size(); at += fit) {
    std::vector<Sample> some(
        samples.begin() + static_cast<std::ptrdiff_t>(at),
        samples.begin() + static_cast<std::ptrdiff_t>(std::min(at + fit, samples.size())));
    Datagram datagram;
    datagram.bytes = static_cast<std::uint32_t>(some.size()) * WireCost::kEndpoint;
    datagram.priority = WireCost::kDiscoveryPriority;
    std::string which;
    for (const Sample& sample : some) which += std::to_string(sample.sequence) + ',';
    datagram.supersedes = number_of(which, entity, reader.entity);
    datagram.again = true;
    owner->send(
        reader.node, std::move(datagram),
        [from = EndpointId{owner->node, entity}, start = proxy->second.start, some = std::move(some)](
            ParticipantState& there, std::uint16_t) {
          for (const Sample& sample : some)
            there.discovery_reader->on_data(from, start, sample, sample.frames);
        },
        true);
  }
}

void WriterState::arm_heartbeat() {
  // Inner networks lose nothing, so there is nothing to repair.
  if (heartbeat_armed || !topic.qos.reliable || owner->core->radio->is_local_domain(owner->node)) return;
  const bool wanted = std::any_of(readers.begin(), readers.end(), [this](const auto& entry) {
    return entry.second.reliable && entry.second.acknowledged + 1 < next;
  });
  if (!wanted) return;
  heartbeat_armed = true;
  owner->core->after(topic.qos.heartbeat,
                     [weak = weak_from_this(), keep = std::weak_ptr(owner->shared_from_this())] {
                       const auto participant = keep.lock();
                       const auto self = weak.lock();
                       if (self && participant && !participant->stopped) self->heartbeat();
                     });
}

void WriterState::heartbeat() {
  heartbeat_armed = false;
  const std::uint64_t first = history.empty() ? next : history.front().sequence;
  const std::uint64_t last = topic.qos.paced ? sent : next - 1;
  for (const auto& [reader, proxy] : readers) {
    if (!proxy.reliable || proxy.acknowledged >= last) continue;
    Datagram datagram;
    datagram.bytes = WireCost::kHeartbeat;
    datagram.priority = WireCost::kDiscoveryPriority;
    datagram.supersedes = number_of("heartbeat", entity, reader.entity);
    datagram.again = true;
    owner->send(
        reader.node, std::move(datagram),
        [from = EndpointId{owner->node, entity}, reader_id = reader.entity, start = proxy.start, first, last,
         is_discovery = discovery](ParticipantState& there, std::uint16_t) {
          if (is_discovery) return there.discovery_reader->on_heartbeat(from, start, first, last);
          const auto found = there.readers.find(reader_id);
          if (found != there.readers.end()) found->second->on_heartbeat(from, start, first, last);
        },
        discovery);
  }
  arm_heartbeat();
}

void WriterState::on_acknack(EndpointId reader, std::uint64_t base, const std::vector<Missing>& missing) {
  const auto proxy = readers.find(reader);
  if (proxy == readers.end()) return;
  proxy->second.acknowledged = std::max(proxy->second.acknowledged, base - 1);
  if (missing.empty()) return;
  owner->core->after(
      WireCost::kResponse, [self = shared_from_this(), keep = owner->shared_from_this(), reader, missing] {
        if (keep->stopped || !self->readers.contains(reader)) return;
        std::vector<std::uint64_t> gone;
        std::vector<Sample> endpoints;
        for (const Missing& wanted : missing) {
          const auto sample = std::find_if(self->history.begin(), self->history.end(),
                                           [&](const Sample& s) { return s.sequence == wanted.sequence; });
          if (sample == self->history.end()) {
            gone.push_back(wanted.sequence);
          } else if (self->discovery) {
            endpoints.push_back(*sample);
          } else if (self->topic.qos.paced) {
            self->repair({wanted.sequence, wanted.frames, reader});
          } else {
            self->send(reader, *sample, wanted.frames == 0 ? sample->frames : wanted.frames);
          }
        }
        self->send_endpoints(reader, endpoints);
        if (self->topic.qos.paced) self->pump();
        if (gone.empty()) return;
        Datagram datagram;
        datagram.bytes = WireCost::kGap;
        datagram.priority = WireCost::kDiscoveryPriority;
        keep->send(
            reader.node, std::move(datagram),
            [from = EndpointId{keep->node, self->entity}, reader, gone, is_discovery = self->discovery](
                ParticipantState& there, std::uint16_t) {
              if (is_discovery) return there.discovery_reader->on_gap(from, gone);
              const auto found = there.readers.find(reader.entity);
              if (found != there.readers.end()) found->second->on_gap(from, gone);
            },
            self->discovery);
      });
}

}  // namespace adit::wire
