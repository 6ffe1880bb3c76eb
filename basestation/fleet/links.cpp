// SPDX-License-Identifier: Apache-2.0
#include "basestation/fleet/links.hpp"

#include "basestation/fleet/fleet.hpp"

namespace adit::station {

void PeerRates::read(const std::vector<wire::PeerState>& peers, Time now) {
  std::map<wire::ParticipantId, Entry> fresh;
  const double span = seconds(now - at_);
  for (const wire::PeerState& peer : peers) {
    Entry& entry = fresh[peer.peer];
    entry.last = peer;
    const auto before = peers_.find(peer.peer);
    if (before == peers_.end() || span <= 0.0) continue;
    const auto rate = [span](std::uint64_t is, std::uint64_t was) {
      return is >= was ? static_cast<double>(is - was) / span : 0.0;
    };
    entry.rate = PeerRate{rate(peer.bytes_out, before->second.last.bytes_out),
                          rate(peer.bytes_in, before->second.last.bytes_in), peer.signal};
  }
  peers_ = std::move(fresh);
  at_ = now;
}

const PeerRate* PeerRates::find(const wire::ParticipantId& peer) const {
  const auto found = peers_.find(peer);
  return found == peers_.end() || !found->second.rate ? nullptr : &*found->second.rate;
}

SenderReport described(const contract::LinkReport& report) {
  SenderReport out{.link = report.link,
                   .bandwidth = report.bandwidth,
                   .queue = report.queue,
                   .state_rate = report.state_rate};
  for (std::size_t p = 0; p < wire::kPriorities; ++p) out.dropped[priority_name(p)] = report.dropped[p];
  return out;
}

std::vector<LinkReport> links(const Fleet& fleet, Time now) {
  std::vector<LinkReport> result;
  for (const wire::PeerMeter::Peer& peer : fleet.links().peers(now)) {
    LinkReport& link = result.emplace_back(LinkReport{.agent = peer.name,
                                                      .age = seconds(peer.held),
                                                      .lost_from = peer.lost,
                                                      .round_trip = peer.round_trip});
    const RobotView* robot = fleet.robot(peer.name);
    const auto station = fleet.stations().find(peer.name);
    const PeerRate* rate = robot != nullptr ? fleet.peer_rates().find(robot->participant)
                           : station != fleet.stations().end()
                               ? fleet.peer_rates().find(station->second.participant)
                               : nullptr;
    if (rate != nullptr) {
      link.bytes_from = rate->in;
      link.bytes_to = rate->out;
      link.signal = rate->signal;
    }
    const auto report = fleet.traffic().find(peer.name);
    if (report == fleet.traffic().end()) continue;
    for (const contract::PeerLink& heard : report->second.peers)
      if (heard.peer == fleet.own_name()) link.lost_to = heard.lost;
    link.sender = described(report->second);
  }
  return result;
}

const char* priority_name(std::size_t priority) {
  static constexpr std::array<const char*, wire::kPriorities> names{"urgent", "discovery", "stream", "state",
                                                                    "status", "bulk",      "video"};
  return names.at(priority);
}

}  // namespace adit::station
