#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "core/time/time.hpp"
#include "core/wire/link.hpp"

namespace adit::wire {

/// The last class of messages that say what is; behind it come `bulk` and `video`, which take what is left.
inline constexpr std::size_t kStatusPriority = 4;

/// DDS GUID prefix of a participant: who really sent a sample, whatever the sample says.
using ParticipantId = std::array<std::uint8_t, 12>;

/// What waits at a sender for its link now, and what never went on the air.
struct SenderState {
  /// The link profile that limits what is sent, valid as long as the wire lives; null: none, as on a real
  /// radio.
  const LinkProfile* link{};
  /// By priority: airtime that the waiting messages need. Without a profile how fast the link is stays
  /// unknown: then how long the oldest message has waited for a socket with room.
  std::array<Duration, kPriorities> queue{};
  /// By priority: messages since the start that never went on the air. They waited too long, or a newer one
  /// took their place.
  std::array<std::uint64_t, kPriorities> dropped{};

  /// Airtime of all that goes before or with `priority`, in [0, priorities).
  Duration waiting(std::size_t priority) const {
    Duration sum{};
    for (std::size_t p = 0; p <= priority; ++p) sum += queue[p];
    return sum;
  }
  /// Messages dropped of the classes that go before or with `priority`, in [0, priorities).
  std::uint64_t lost(std::size_t priority) const {
    std::uint64_t sum = 0;
    for (std::size_t p = 0; p <= priority; ++p) sum += dropped[p];
    return sum;
  }
};

/// What passed between us and one other participant since the start: all bytes that the network carried,
/// headers included; what was sent by multicast is nobody's.
struct PeerState {
  ParticipantId peer{};
  std::uint64_t bytes_out{}, bytes_in{};
  std::optional<double> signal{};  ///< mean received power, dBm, where the link fades and places are known
};

}  // namespace adit::wire
