// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/discovery/peer_table.hpp"

#include <algorithm>
#include <cstdio>
#include <tuple>

namespace adit::agent {
namespace {

/// All fields except the ages and the beacon.
auto content(const Peer& p) {
  return std::tie(p.name, p.id, p.kind, p.participant, p.has_capabilities, p.protocol, p.software, p.platform,
                  p.length, p.width, p.height, p.max_speed, p.modes, p.place, p.namesake, p.present);
}

bool before(const Peer& a, const Peer& b) {
  return std::tie(a.name, a.namesake, a.participant) < std::tie(b.name, b.namesake, b.participant);
}

}  // namespace

const Peer* PeerTable::find(const std::string& name) const {
  const auto found = std::find_if(peers_.begin(), peers_.end(),
                                  [&](const Peer& peer) { return peer.name == name && !peer.namesake; });
  return found == peers_.end() ? nullptr : &*found;
}

Peer* PeerTable::edit(const std::string& name) {
  const Peer* found = find(name);
  return found ? &peers_[static_cast<std::size_t>(found - peers_.data())] : nullptr;
}

const Peer* PeerTable::holder() const {
  const Peer* known = find(holder_);
  return known && is_holder(*known) ? known : nullptr;
}

const Peer* PeerTable::by_participant(const wire::ParticipantId& participant) const {
  const auto found = std::find_if(peers_.begin(), peers_.end(),
                                  [&](const Peer& peer) { return peer.participant == participant; });
  return found == peers_.end() ? nullptr : &*found;
}

bool PeerTable::is_robot(const std::string& name, const wire::ParticipantId& participant) const {
  const Peer* known = by_participant(participant);
  return known != nullptr && !known->is_station() && !known->namesake && known->name == name;
}

bool PeerTable::carrier_present() const {
  return std::any_of(peers_.begin(), peers_.end(), [](const Peer& peer) {
    return peer.present && !peer.namesake && !peer.is_station() &&
           contract::offers(peer.services, contract::service::kCarryMap);
  });
}

Peer* PeerTable::add(Peer peer, Time now) {
  if (peers_.size() >= kCapacity) {
    auto oldest = peers_.end();
    for (auto at = peers_.begin(); at != peers_.end(); ++at) {
      if (is_holder(*at) || (at->present && !is_holder(peer))) continue;
      if (oldest == peers_.end() ||
          std::tie(at->present, at->last_seen) < std::tie(oldest->present, oldest->last_seen))
        oldest = at;
    }
    if (oldest == peers_.end()) return nullptr;
    peers_.erase(oldest);
  }
  peer.first_seen = peer.last_seen = now;
  peer.present = true;
  const auto place = std::lower_bound(peers_.begin(), peers_.end(), peer, before);
  return &*peers_.insert(place, std::move(peer));
}

void PeerTable::touch(Peer& peer, Time now) {
  peer.last_seen = now;
  if (std::exchange(peer.present, true)) return;
  publish();
}

bool PeerTable::put(Peer peer, Time now) {
  peer.present = true;
  Peer* known = edit(peer.name);
  if (!known) {
    if (!add(std::move(peer), now)) return false;
    publish();
    return true;
  }
  peer.first_seen = known->id == peer.id ? known->first_seen : now;
  peer.last_seen = now;
  const bool changed = content(*known) != content(peer);
  if (known->participant == peer.participant) peer.heard_beacon = std::move(known->heard_beacon);
  *known = std::move(peer);
  if (changed) publish();
  return true;
}

void PeerTable::accept_station(const MessageSender& from, Time now) {
  Peer peer{};
  peer.name = from.name;
  peer.id = from.id;
  peer.kind = contract::AgentKind::station;
  peer.participant = from.participant;
  Peer* known = edit(from.name);
  if (known && known->is_station() && known->id == from.id) return touch(*known, now);
  // A name belongs to its id while that station is heard or holds the robot; only the holder takes
  // precedence.
  if (known && (known->present || is_holder(*known)) && !is_holder(peer)) return;
  put(std::move(peer), now);
}

void PeerTable::hear_namesake(const std::string& name, const Id& id, const wire::ParticipantId& participant,
                              Time now) {
  std::size_t others = 0;
  for (Peer& peer : peers_) {
    if (!peer.namesake) continue;
    if (peer.participant == participant) return touch(peer, now);
    ++others;
  }
  if (others >= kNamesakes) {
    const auto gone = std::find_if(peers_.begin(), peers_.end(),
                                   [](const Peer& peer) { return peer.namesake && !peer.present; });
    if (gone == peers_.end()) return;
    peers_.erase(gone);
  }
  Peer peer{};
  peer.name = name;
  peer.id = id;
  peer.participant = participant;
  peer.namesake = true;
  if (add(std::move(peer), now)) publish();
}

BeaconFault PeerTable::hear_beacon(const TeamBeacon& beacon, const wire::ParticipantId& participant,
                                   Time now) {
  const auto judge = [&](const Peer* peer) {
    if (!peer || peer->is_station() || peer->participant != participant) return BeaconFault::unknown;
    const auto& last = peer->heard_beacon;
    const bool is_old = last && last->beacon.start == beacon.start && beacon.seq <= last->beacon.seq;
    return is_old ? BeaconFault::old : BeaconFault::none;
  };
  Peer* peer = edit(beacon.robot);
  const BeaconFault fault = judge(peer);
  beacon_faults_.count(fault);
  if (fault != BeaconFault::none) return fault;
  Duration period = 1s;
  if (const auto& last = peer->heard_beacon; last && last->beacon.start == beacon.start)
    period = (now - last->at) / static_cast<std::int64_t>(beacon.seq - last->beacon.seq);
  peer->heard_beacon = HeardBeacon{beacon, now, period};
  return fault;
}

std::size_t PeerTable::robots_present() const {
  return static_cast<std::size_t>(std::count_if(peers_.begin(), peers_.end(), [](const Peer& peer) {
    return peer.present && !peer.is_station() && !peer.namesake;
  }));
}

void PeerTable::leave(const wire::ParticipantId& participant) {
  bool changed = false;
  for (Peer& peer : peers_) {
    if (peer.participant != participant || !peer.present) continue;
    peer.present = false;
    changed = true;
  }
  if (changed) publish();
}

void PeerTable::tick(Time now) {
  bool changed = false;
  for (Peer& peer : peers_) {
    if (!peer.present || peer.age(now) < kPresenceTimeout) continue;
    peer.present = false;
    changed = true;
  }
  if (changed) publish();
}

std::string describe(const PeerTable& peers, Time now) {
  std::string text;
  for (const Peer& peer : peers.all()) {
    char line[256];
    const std::string kind = peer.is_station()       ? "station"
                             : peer.platform.empty() ? "robot"
                                                     : command::clean(peer.platform, 32);
    std::snprintf(line, sizeof line, "%-16s %-8s %-8s heard %.1f s ago", peer.name.c_str(), kind.c_str(),
                  peer.namesake  ? "namesake"
                  : peer.present ? "present"
                                 : "silent",
                  seconds(peer.age(now)));
    text += line;
    if (peer.place) {
      std::snprintf(line, sizeof line, ", at %.1f %.1f %.1f", (*peer.place)[0], (*peer.place)[1],
                    (*peer.place)[2]);
      text += line;
    }
    if (peer.heard_beacon) {
      const TeamBeacon& beacon = peer.heard_beacon->beacon;
      std::snprintf(line, sizeof line, ", beacon %.1f s ago at %.1f %.1f in %s",
                    seconds(now - peer.heard_beacon->at), beacon.pose.x, beacon.pose.y, beacon.mode.c_str());
      text += line;
    }
    text += peers.holder() == &peer ? ", the holder\n" : "\n";
  }
  if (const BeaconFaults& refused = peers.beacon_faults(); refused.total() > 0)
    text += "refused beacons: " + std::to_string(refused.malformed) + " malformed, " +
            std::to_string(refused.unknown) + " of unknown robots, " + std::to_string(refused.old) + " old\n";
  return text.empty() ? "no peers\n" : text;
}

}  // namespace adit::agent
