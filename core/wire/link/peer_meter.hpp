// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/time/time.hpp"

namespace adit::wire {

/// Measures the link to each peer from the periodic presence messages that all stations and robots send: loss
/// from gaps in a peer's sequence numbers, round trip from the numbers that a peer echoes. It uses only the
/// own clock and is bounded.
class PeerMeter {
 public:
  static constexpr std::size_t kMaxPeers = 64;
  /// Number of presence messages over which the loss is computed.
  static constexpr std::uint32_t kWindow = 32;

  struct Peer {
    std::string name{};
    std::uint32_t number{};              ///< Sequence number of the newest presence received.
    Duration held{};                     ///< Time since then.
    float lost{};                        ///< Lost share of its presence messages, [0, 1].
    std::optional<double> round_trip{};  ///< Round trip, s.
  };

  /// Records that an own presence with this number was sent.
  void sent(std::uint32_t number, Time now);
  /// Records a presence of a peer. A lower number than before means that the peer restarted.
  void heard(const std::string& name, std::uint32_t number, Time now);
  /// Records a peer's report: the newest own presence it received was `number`, `held` ago.
  void echoed(const std::string& name, std::uint32_t number, Duration held, Time now);
  /// Statistics of one peer, or of all, by name.
  std::optional<Peer> peer(const std::string& name, Time now) const;
  std::vector<Peer> peers(Time now) const;
  void forget(const std::string& name) { heard_.erase(name); }

 private:
  struct Heard {
    std::uint32_t number{};
    Time at{};
    std::uint32_t bits{};  // Which of the last `kWindow` numbers were received; the newest is the lowest bit.
    std::uint32_t known{};  // Number of valid bits in `bits`, at most `kWindow`.
    std::optional<double> round_trip{};
  };
  static Peer view(const std::string& name, const Heard& heard, Time now);

  std::map<std::string, Heard> heard_{};
  std::array<std::pair<std::uint32_t, Time>, kWindow> sent_{};  // By number.
};

}  // namespace adit::wire
