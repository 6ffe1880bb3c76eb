// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/discovery/directory.hpp"

#include <algorithm>
#include <utility>

namespace adit::agent {

Directory::NamedEntry* Directory::find(const std::string& name) {
  for (NamedEntry& entry : entries_)
    if (entry.name == name) return peers_.find(name) ? &entry : nullptr;
  return nullptr;
}

void Directory::set_pending(NamedEntry& entry, const Peer& announcement, Time now) {
  entry.pending_peer = announcement;
  entry.pending_peer->last_seen = now;
}

void Directory::bind(NamedEntry& entry, Peer announcement, Time now) {
  const Peer* known = peers_.find(entry.name);
  if (known && known->participant != announcement.participant) entry.previous_peer = *known;
  entry.pending_peer.reset();
  peers_.put(std::move(announcement), now);
}

void Directory::add(const Peer& announcement, Time now) {
  // Drops the entries of names that the table evicted.
  std::erase_if(entries_, [&](const NamedEntry& e) { return !peers_.find(e.name); });
  if (const Peer* known = peers_.find(announcement.name)) {
    // The station was known only from its commands: the participant that sent them is bound to its name and
    // id.
    entries_.push_back({announcement.name, Binding(known->participant, known->last_seen), {}, {}});
    return on_announcement(entries_.back(), announcement, now);
  }
  if (peers_.put(announcement, now))
    entries_.push_back({announcement.name, Binding(announcement.participant, now), {}, {}});
}

// The name is announced with another id. It changes its owner only once the known peer is gone.
void Directory::on_other_id(NamedEntry& entry, const Peer& announcement, Time now) {
  const Peer& known = *peers_.find(entry.name);
  const bool name_in_use =
      known.present || peers_.holder() == &known || entry.binding.alive(now, PeerTable::kPresenceTimeout);
  if (name_in_use) return set_pending(entry, announcement, now);
  entry.binding = Binding(announcement.participant, now);
  bind(entry, announcement, now);
}

void Directory::on_announcement(NamedEntry& entry, const Peer& announcement, Time now) {
  const Peer& known = *peers_.find(entry.name);
  if (known.id != announcement.id) return on_other_id(entry, announcement, now);
  const auto verdict = entry.binding.on_heartbeat(announcement.participant, Binding::MayClaim::yes, now);
  if (verdict.rejected) {
    // The participant that claimed the name is no restart, because the original one still sends.
    if (known.participant == verdict.rejected && entry.previous_peer) {
      Peer original = *std::exchange(entry.previous_peer, std::nullopt);
      peers_.put(std::move(original), now);
    }
    if (entry.pending_peer && entry.pending_peer->participant == verdict.rejected) entry.pending_peer.reset();
  }
  if (verdict.bound) return bind(entry, announcement, now);
  if (verdict.pending) set_pending(entry, announcement, now);
}

void Directory::on_capabilities(const Peer& announcement, Time now) {
  if (!valid_name(announcement.name)) return;
  Peer peer = announcement;
  peer.has_capabilities = true;
  if (NamedEntry* known = find(peer.name))
    on_announcement(*known, peer, now);
  else
    add(peer, now);
}

void Directory::on_presence(const std::string& name, const Id& id, const wire::ParticipantId& participant,
                            Time now) {
  NamedEntry* known = find(name);
  if (!known) return;  // Its capabilities will follow.
  const auto is_sender = [&](const Peer& p) { return p.id == id && p.participant == participant; };
  // Copies, because on_announcement() changes the stored peers.
  if (known->pending_peer && is_sender(*known->pending_peer))
    return on_announcement(*known, Peer(*known->pending_peer), now);
  if (known->previous_peer && is_sender(*known->previous_peer))
    return on_announcement(*known, Peer(*known->previous_peer), now);
  Peer peer = *peers_.find(name);
  if (peer.id != id) return;
  peer.participant = participant;  // If it is another one, its new capabilities will follow.
  on_announcement(*known, peer, now);
}

void Directory::on_participant(const wire::ParticipantEvent& event) {
  if (event.present) return;  // Its messages will follow.
  for (NamedEntry& entry : entries_) {
    entry.binding.on_leave(event.id);
    if (entry.pending_peer && entry.pending_peer->participant == event.id) entry.pending_peer.reset();
  }
  peers_.leave(event.id);
}

void Directory::tick(Time now) {
  peers_.tick(now);
  for (NamedEntry& entry : entries_) {
    const Peer* peer = peers_.find(entry.name);
    if (!peer || !entry.pending_peer) continue;
    if (now - entry.pending_peer->last_seen >= PeerTable::kPresenceTimeout) continue;
    // A restart of the same agent is bound sooner than a peer with another id.
    const bool same_id = entry.pending_peer->id == peer->id;
    const Duration timeout = same_id ? Binding::kHeartbeatTimeout : PeerTable::kPresenceTimeout;
    if (!entry.binding.alive(now, timeout)) on_announcement(entry, Peer(*entry.pending_peer), now);
  }
}

}  // namespace adit::agent
