#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/wire/link/peer_meter.hpp"
#include "core/wire/link_state.hpp"

namespace adit::station {

class Fleet;

/// What the link to one other participant carries now.
struct PeerRate {
  double out{}, in{};              ///< bytes a second
  std::optional<double> signal{};  ///< dBm
};

/// Turns what the wire counted for each peer into rates.
class PeerRates {
 public:
  /// Over the time since the last reading; all that is not in `peers` is forgotten.
  void read(const std::vector<wire::PeerState>& peers, Time now);
  /// Null before it was read twice.
  const PeerRate* find(const wire::ParticipantId& peer) const;

 private:
  struct Entry {
    wire::PeerState last{};
    std::optional<PeerRate> rate{};
  };
  std::map<wire::ParticipantId, Entry> peers_{};
  Time at_{};
};

/// What an agent's own sender says of its link.
struct SenderView {
  std::string link{};                                      ///< profile; empty: nothing limits what it sends
  double bandwidth{};                                      ///< bit/s; 0: not known
  double queue{};                                          ///< airtime that waits, bulk and video apart, s
  std::array<std::uint32_t, wire::kPriorities> dropped{};  ///< since its start, by priority
  double state_rate{};                                     ///< RobotStates a second
};

/// All that is known of the link to one agent. What is measured here and what it reported.
struct LinkView {
  wire::PeerMeter::Peer peer{};        ///< loss from it, round trip
  std::optional<double> lost_to{};     ///< share of ours that it missed, [0, 1]
  std::optional<PeerRate> rate{};      ///< to it and from it
  std::optional<SenderView> sender{};  ///< nothing before its first report
};

/// One for each agent whose signs of life were heard, by name.
std::vector<LinkView> links(const Fleet& fleet, Time now);

/// What each priority carries, for people.
const char* priority_name(std::size_t priority);

}  // namespace adit::station
