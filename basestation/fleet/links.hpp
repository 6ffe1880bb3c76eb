// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "basestation/model/network.hpp"
#include "core/wire/link_state.hpp"

namespace adit::station {

class Fleet;

/// Traffic of the link to one other participant.
struct PeerRate {
  double out{}, in{};              ///< Bytes/s.
  std::optional<double> signal{};  ///< dBm
};

/// Computes rates from the participant's counters for each peer.
class PeerRates {
 public:
  /// Computes the rates since the last reading; peers that are not in `peers` are dropped.
  void read(const std::vector<wire::PeerState>& peers, Time now);
  /// The rate of a peer; null before its second reading.
  const PeerRate* find(const wire::ParticipantId& peer) const;

 private:
  struct Entry {
    wire::PeerState last{};
    std::optional<PeerRate> rate{};
  };
  std::map<wire::ParticipantId, Entry> peers_{};
  Time at_{};
};

/// The links to all agents whose heartbeats were heard, by name.
std::vector<LinkReport> links(const Fleet& fleet, Time now);
/// What front ends receive of the sender in an agent's report.
SenderReport described(const contract::LinkReport& report);

/// Readable name of a priority's traffic.
const char* priority_name(std::size_t priority);

}  // namespace adit::station
