// SPDX-License-Identifier: Apache-2.0
#include "core/transfer/sender.hpp"

#include <algorithm>

namespace adit::transfer {
namespace {

constexpr Duration kTwoAcknowledgements = 2500ms;  // On a thin link, see ReceiverParams; one may be lost.

}  // namespace

bool Sender::make_room(bool for_carrier, Time now) {
  if (peers_.size() < params_.max_peers) return true;
  const auto last = std::min_element(peers_.begin(), peers_.end(), [](const auto& a, const auto& b) {
    return std::pair(!a.second.carrier, a.second.heard) < std::pair(!b.second.carrier, b.second.heard);
  });
  const bool silent = now - last->second.heard >= params_.silence;
  // What a silent station has is worth more than a carrier.
  if (for_carrier ? !last->second.carrier || !silent : !last->second.carrier && !silent) return false;
  forget(last->first);
  return true;
}

void Sender::forget(PeerId peer) {
  for (Source* source : sources_) source->leave(peer);
  for (Flight& flight : flights_) std::erase(flight.awaited, peer);
  peers_.erase(peer);
}

void Sender::join(const Ack& ack) {
  for (Source* source : sources_)
    if (!ack.carrier || source->for_carriers()) source->join(ack.peer);
}

Sender::Peer* Sender::admit(const Ack& ack, Time now) {
  auto found = peers_.find(ack.peer);
  if (found != peers_.end() && found->second.carrier && !ack.carrier) {
    forget(ack.peer);  // A robot says that it is a carrier by a station's id.
    found = peers_.end();
  }
  if (found == peers_.end()) {
    if (!make_room(ack.carrier, now)) return nullptr;
    Peer& peer = peers_[ack.peer];
    peer = {ack.start, {}, now, now, ack.carrier};
    join(ack);
    return &peer;
  }
  Peer& peer = found->second;
  if (peer.carrier != ack.carrier) return nullptr;
  // Acknowledgements of an earlier start come late. A station may also go back to one whose content is on its
  // disk.
  const auto earlier = std::find(peer.earlier.begin(), peer.earlier.end(), ack.start);
  if (earlier != peer.earlier.end()) {
    if (now - peer.heard < params_.silence) return nullptr;
    peer.earlier.erase(earlier);
  }
  if (peer.start != ack.start && now - peer.joined < params_.min_rejoin) return nullptr;
  peer.heard = now;
  if (peer.start == ack.start) return &peer;
  peer.joined = now;
  // The station was started again and has nothing; what is on its way was for the one before.
  peer.earlier.push_back(peer.start);
  if (peer.earlier.size() > kStarts) peer.earlier.pop_front();
  peer.start = ack.start;
  peer.named = false;
  for (Flight& flight : flights_) std::erase(flight.awaited, ack.peer);
  join(ack);
  return &peer;
}

bool Sender::acknowledged(const Ack& ack, Time now) {
  if (admit(ack, now) == nullptr) return false;
  if (!ack.carrier) station_heard_ = now;
  if (ack.receipt.session == params_.session && ack.receipt.newest <= last_id_) {
    peers_.at(ack.peer).named = true;
    settle(ack.peer, ack.receipt, now);
  }
  return true;
}

void Sender::settle(const PeerId& peer, const Receipt& receipt, Time now) {
  for (Flight& flight : flights_) {
    const auto awaited = std::find(flight.awaited.begin(), flight.awaited.end(), peer);
    if (awaited == flight.awaited.end()) continue;
    if (receipt.has(flight.id)) {
      measure(now - flight.sent);
      flight.source->acknowledged(peer, flight.token);
      pacer_.settled(true);
    } else if (now - flight.sent >= due_within()) {
      flight.source->lost(peer, flight.token);
      pacer_.settled(false);
    } else {
      continue;
    }
    flight.awaited.erase(awaited);
  }
  expire(now);
}

void Sender::expire(Time now) {
  const Duration limit = timeout();
  for (Flight& flight : flights_) {
    std::erase_if(flight.awaited, [&](const PeerId& id) {
      const auto peer = peers_.find(id);
      // Acknowledgements of a peer to which nothing came yet do not name this sender.
      const bool named = peer == peers_.end() || peer->second.named;
      if (now - flight.sent < (named ? limit : std::min<Duration>(limit, params_.unnamed))) return false;
      flight.source->lost(id, flight.token);
      // A peer that is not heard at all says nothing about the rate at which it should be sent to.
      if (peer != peers_.end() && peer->second.heard > flight.sent) pacer_.settled(false);
      return true;
    });
    if (flight.awaited.empty()) flight.source->settled(flight.token);
  }
  std::erase_if(flights_, [](const Flight& flight) { return flight.awaited.empty(); });
}

void Sender::measure(Duration delay) {
  // Acknowledgements wait for others at the peer: the shortest delay is the link's.
  const double sample = seconds(delay);
  least_delay_ =
      !least_delay_ || sample < *least_delay_ ? sample : *least_delay_ + (sample - *least_delay_) / 16;
}

Duration Sender::due_within() const {
  if (!least_delay_) return params_.min_timeout / 2;
  return std::clamp(from_seconds(1.5 * *least_delay_), params_.min_timeout / 4, params_.max_timeout);
}

Duration Sender::timeout() const {
  if (!least_delay_) return params_.min_timeout;
  return std::clamp(kTwoAcknowledgements + from_seconds(2 * *least_delay_), params_.min_timeout,
                    params_.max_timeout);
}

std::vector<PeerId> Sender::served(const Source& source, Time now) const {
  std::vector<std::pair<std::size_t, PeerId>> heard;
  if (serves_carriers(now) && !source.for_carriers()) return {};
  for (const auto& [id, peer] : peers_)
    if (is_served(peer, now)) heard.emplace_back(source.missing(id), id);
  std::stable_sort(heard.begin(), heard.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<PeerId> out;
  if (!heard.empty() && heard.front().first > 0)
    for (const auto& [missing, id] : heard) out.push_back(id);
  return out;
}

std::uint32_t Sender::waiting(const std::vector<PeerId>& peers) const {
  std::size_t most = 0;
  for (const PeerId& peer : peers) {
    std::size_t of_peer = 0;
    for (const Source* source : sources_) of_peer += source->missing(peer);
    most = std::max(most, of_peer);
  }
  return static_cast<std::uint32_t>(std::min<std::size_t>(most, UINT32_MAX));
}

std::vector<Piece> Sender::due(Time now, const wire::SenderState& link) {
  expire(now);
  if (!station_heard_) station_heard_ = now;
  std::vector<Piece> out;
  const auto heard = static_cast<std::size_t>(std::count_if(
      peers_.begin(), peers_.end(), [&](const auto& entry) { return is_served(entry.second, now); }));
  if (heard == 0) return out;
  pacer_.observe(now, link, heard);
  for (Source* source : sources_) {
    while (pacer_.allows(source->ahead()) && out.size() < params_.pieces_at_once &&
           flights_.size() < params_.max_in_flight) {
      std::vector<PeerId> peers = served(*source, now);
      if (peers.empty()) break;
      auto content = source->next(peers, pacer_.piece_bytes(), now);
      if (!content) break;
      pacer_.sent(content->data.size());
      out.push_back(
          {source->kind(), ++last_id_, waiting(peers), std::move(content->data), serves_carriers(now)});
      flights_.push_back({last_id_, content->token, source, now, std::move(peers)});
    }
  }
  return out;
}

}  // namespace adit::transfer
