// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <netinet/in.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "core/wire/fastdds/rtps_peek.hpp"
#include "core/wire/link/model.hpp"
#include "core/wire/link_state.hpp"

namespace adit::wire {

/// Traffic and positions of the peers, derived from the datagrams that pass the sockets: which participant
/// uses an address, bytes to and from it, and where it is. Safe to call from any thread. Bounded: a new peer
/// replaces the one that was silent longest.
class PeerStatistics {
 public:
  static constexpr std::size_t kMaxPeers = 256;

  /// Counts a sent datagram. Its receiver is in the datagram (INFO_DST), or is known from an earlier one to
  /// the same address.
  void sent(const RtpsPeek& seen, in_addr_t address, std::uint16_t port, std::uint64_t bytes);
  /// Counts a datagram received from the participant that it names.
  void received(const RtpsPeek& seen, std::uint64_t bytes);
  void set_place(const ParticipantId& who, const Position& at);
  void set_own_place(const Position& at);

  /// Returns the path to the participant at that address; it has no distance when one of the two positions is
  /// not known.
  Path path(in_addr_t address, std::uint16_t port) const;
  /// Returns all participants whose bytes were counted, by id, without `us`; signals are computed for `link`.
  std::vector<PeerState> all(const ParticipantId& us, const LinkProfile* link) const;

 private:
  struct Peer {
    std::uint64_t bytes_out{}, bytes_in{};
    std::uint64_t used{};  // Time of last use, by the counter below.
    std::optional<Position> place{};
  };
  Peer& peer(const ParticipantId& id);
  Path path(const Peer& peer) const;
  static std::uint64_t key(in_addr_t address, std::uint16_t port);

  mutable std::mutex mutex_{};
  std::optional<Position> own_place_{};
  std::uint64_t uses_{};
  std::map<ParticipantId, Peer> peers_{};
  std::map<std::uint64_t, ParticipantId> addresses_{};
};

}  // namespace adit::wire
