// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/peer_statistics.hpp"

#include <algorithm>

#include "core/wire/fastdds/ports.hpp"

namespace adit::wire {

std::uint64_t PeerStatistics::key(in_addr_t address, std::uint16_t port) {
  // Participants of one machine differ by port; a participant's discovery and data ports count as one peer.
  return static_cast<std::uint64_t>(address) << 16 | participant_of_port(port);
}

PeerStatistics::Peer& PeerStatistics::peer(const ParticipantId& id) {
  if (!peers_.contains(id) && peers_.size() >= kMaxPeers) {
    const auto oldest = std::min_element(peers_.begin(), peers_.end(), [](const auto& a, const auto& b) {
      return a.second.used < b.second.used;
    });
    std::erase_if(addresses_, [&](const auto& entry) { return entry.second == oldest->first; });
    peers_.erase(oldest);
  }
  Peer& found = peers_[id];
  found.used = ++uses_;
  return found;
}

void PeerStatistics::sent(const RtpsPeek& seen, in_addr_t address, std::uint16_t port, std::uint64_t bytes) {
  if (IN_MULTICAST(ntohl(address))) return;
  const std::lock_guard lock(mutex_);
  const std::uint64_t at = key(address, port);
  if (seen.destination && (addresses_.contains(at) || addresses_.size() < kMaxPeers))
    addresses_[at] = *seen.destination;
  const auto known = addresses_.find(at);
  if (known != addresses_.end()) peer(known->second).bytes_out += bytes;
}

void PeerStatistics::received(const RtpsPeek& seen, std::uint64_t bytes) {
  if (!seen.source) return;
  const std::lock_guard lock(mutex_);
  peer(*seen.source).bytes_in += bytes;
}

void PeerStatistics::set_place(const ParticipantId& who, const Position& at) {
  const std::lock_guard lock(mutex_);
  peer(who).place = at;
}

void PeerStatistics::set_own_place(const Position& at) {
  const std::lock_guard lock(mutex_);
  own_place_ = at;
}

Path PeerStatistics::path(const Peer& peer) const {
  if (!own_place_ || !peer.place) return {};
  return {distance(*own_place_, *peer.place), 0.0};
}

Path PeerStatistics::path(in_addr_t address, std::uint16_t port) const {
  const std::lock_guard lock(mutex_);
  const auto known = addresses_.find(key(address, port));
  if (known == addresses_.end()) return {};
  const auto peer = peers_.find(known->second);
  return peer == peers_.end() ? Path{} : path(peer->second);
}

std::vector<PeerState> PeerStatistics::all(const ParticipantId& us, const LinkProfile* link) const {
  const std::lock_guard lock(mutex_);
  std::vector<PeerState> result;
  for (const auto& [id, peer] : peers_) {
    if (id == us) continue;
    result.push_back({id, peer.bytes_out, peer.bytes_in, {}});
    if (link != nullptr) result.back().signal = received_power(*link, path(peer));
  }
  return result;
}

}  // namespace adit::wire
