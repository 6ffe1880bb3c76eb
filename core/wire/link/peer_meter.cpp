// SPDX-License-Identifier: Apache-2.0
#include "core/wire/link/peer_meter.hpp"

#include <algorithm>
#include <bit>

namespace adit::wire {

void PeerMeter::sent(std::uint32_t number, Time now) { sent_[number % kWindow] = {number, now}; }

void PeerMeter::heard(const std::string& name, std::uint32_t number, Time now) {
  if (!heard_.contains(name) && heard_.size() >= kMaxPeers) return;
  const auto [at, is_new] = heard_.try_emplace(name);
  Heard& heard = at->second;
  const std::uint32_t ahead = number - heard.number;
  if (is_new || (number < heard.number && heard.number - number >= kWindow)) {
    heard = {number, now, 1, 1, heard.round_trip};
    return;
  }
  if (number <= heard.number) {  // Late or duplicate.
    const std::uint32_t behind = heard.number - number;
    heard.bits |= 1U << behind;
    heard.at = now;
    return;
  }
  heard.bits = ahead >= kWindow ? 1U : (heard.bits << ahead) | 1U;
  heard.known = std::min(kWindow, heard.known + std::min(ahead, kWindow));
  heard.number = number;
  heard.at = now;
}

void PeerMeter::echoed(const std::string& name, std::uint32_t number, Duration held, Time now) {
  const auto& [own, at] = sent_[number % kWindow];
  const auto peer = heard_.find(name);
  if (peer == heard_.end() || own != number || number == 0) return;
  const double trip = seconds(now - at - held);
  if (trip < 0.0) return;  // No peer can answer before our message was sent.
  auto& mean = peer->second.round_trip;
  mean = mean ? 0.75 * *mean + 0.25 * trip : trip;
}

PeerMeter::Peer PeerMeter::view(const std::string& name, const Heard& heard, Time now) {
  const auto missing = static_cast<int>(heard.known) - std::popcount(heard.bits);
  return {name, heard.number, now - heard.at,
          static_cast<float>(std::max(0, missing)) / static_cast<float>(std::max(1U, heard.known)),
          heard.round_trip};
}

std::optional<PeerMeter::Peer> PeerMeter::peer(const std::string& name, Time now) const {
  const auto found = heard_.find(name);
  if (found == heard_.end()) return std::nullopt;
  return view(name, found->second, now);
}

std::vector<PeerMeter::Peer> PeerMeter::peers(Time now) const {
  std::vector<Peer> result;
  for (const auto& [name, heard] : heard_) result.push_back(view(name, heard, now));
  return result;
}

}  // namespace adit::wire
