// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/discovery/directory.hpp"

#include <algorithm>
#include <utility>

namespace adit::agent {

Directory::Entry* Directory::find(const std::string& name) {
  for (Entry& entry : entries_)
    if (entry.name == name) return peers_.find(name) ? &entry : nullptr;
  return nullptr;
}

void Directory::wait(Entry& entry, const Peer& said, Time now) {
  entry.waiting = said;
  entry.waiting->heard = now;
}

void Directory::adopt(Entry& entry, Peer said, Time now) {
  const Peer* known = peers_.find(entry.name);
  if (known && known->participant != said.participant) entry.former = *known;
  entry.waiting.reset();
  peers_.put(std::move(said), now);
}

void Directory::add(const Peer& said, Time now) {
  // Drops the entries of names that the table evicted.
  std::erase_if(entries_, [&](const Entry& e) { return !peers_.find(e.name); });
  if (const Peer* known = peers_.find(said.name)) {
    // The station was known only from its commands: the participant that sent them is bound to its name and
    // id.
    entries_.push_back({said.name, Binding(known->participant, known->heard), {}, {}});
    return hear(entries_.back(), said, now);
  }
  if (peers_.put(said, now)) entries_.push_back({said.name, Binding(said.participant, now), {}, {}});
}

void Directory::hear(Entry& entry, const Peer& said, Time now) {
  const Peer& known = *peers_.find(entry.name);
  if (known.id != said.id) {
    const bool taken = known.present || peers_.holder() == &known;
    if (taken || entry.binding.alive(now, PeerTable::kSilence)) return wait(entry, said, now);
    entry.binding = Binding(said.participant, now);
    return adopt(entry, said, now);
  }
  const auto verdict = entry.binding.hear(said.participant, true, now);
  if (verdict.found_out && known.participant == verdict.found_out && entry.former) {
    Peer before = *std::exchange(entry.former, std::nullopt);
    peers_.put(std::move(before), now);
  }
  if (verdict.found_out && entry.waiting && entry.waiting->participant == verdict.found_out)
    entry.waiting.reset();
  if (verdict.bound) return adopt(entry, said, now);
  if (verdict.pending) wait(entry, said, now);
}

void Directory::capabilities(const Peer& said, Time now) {
  if (!valid_name(said.name)) return;
  Peer described = said;
  described.described = true;
  if (Entry* known = find(said.name))
    hear(*known, described, now);
  else
    add(described, now);
}

void Directory::presence(const std::string& name, const Id& id, const wire::ParticipantId& participant,
                         Time now) {
  Entry* known = find(name);
  if (!known) return;  // Its capabilities will follow.
  const Peer& peer = *peers_.find(name);
  const auto said = [&](const Peer& p) { return p.id == id && p.participant == participant; };
  if (known->waiting && said(*known->waiting)) {
    hear(*known, Peer(*known->waiting), now);
  } else if (known->former && said(*known->former)) {
    hear(*known, Peer(*known->former), now);
  } else if (peer.id == id) {
    Peer same = peer;  // Its new capabilities will follow.
    same.participant = participant;
    hear(*known, same, now);
  }
}

void Directory::participant(const wire::ParticipantEvent& event) {
  if (event.present) return;  // Its messages will follow.
  for (Entry& entry : entries_) {
    entry.binding.leave(event.id);
    if (entry.waiting && entry.waiting->participant == event.id) entry.waiting.reset();
  }
  peers_.leave(event.id);
}

void Directory::tick(Time now) {
  peers_.tick(now);
  for (Entry& entry : entries_) {
    const Peer* peer = peers_.find(entry.name);
    if (!peer || !entry.waiting || now - entry.waiting->heard >= PeerTable::kSilence) continue;
    const bool same_id = entry.waiting->id == peer->id;
    if (!entry.binding.alive(now, same_id ? Binding::kQuiet : PeerTable::kSilence))
      hear(entry, Peer(*entry.waiting), now);
  }
}

}  // namespace adit::agent
