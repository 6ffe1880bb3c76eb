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

/// Who stands behind which address, by what passes the sockets: bytes to and from each participant, and where
/// it is. From any thread; bounded: whoever was silent longest gives way.
class PeerStatistics {
 public:
  static constexpr std::size_t kMaxPeers = 256;

  /// A datagram leaves. Who it is for is told by itself (INFO_DST), or known since an earlier one was.
  void sent(const RtpsPeek& seen, in_addr_t address, std::uint16_t port, std::uint64_t bytes);
  /// A datagram came in from the participant that it names.
  void received(const RtpsPeek& seen, std::uint64_t bytes);
  void set_place(const ParticipantId& who, const Position& at);
  void set_own_place(const Position& at);

  /// What lies between us and whoever that address is; no distance when one of both places is not known.
  Path path(in_addr_t address, std::uint16_t port) const;
  /// All whose bytes were seen, by id, `us` not among them; their signals by that link.
  std::vector<PeerState> all(const ParticipantId& us, const LinkProfile* link) const;

 private:
  struct Peer {
    std::uint64_t bytes_out{}, bytes_in{};
    std::uint64_t used{};  // by the count below
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
