// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "core/time/time.hpp"
#include "core/wire/link.hpp"

namespace adit::wire {

/// Priority of `status`, the last class of state messages; `bulk` and `video` follow and take the remaining
/// airtime.
inline constexpr std::size_t kStatusPriority = 4;

/// DDS GUID prefix of a participant; it identifies the actual sender of a sample, whatever the sample
/// contains.
using ParticipantId = std::array<std::uint8_t, 12>;

/// State of a sender's queue, and the messages that were never sent.
struct SenderState {
  /// The link profile that limits the sender, valid as long as the participant lives; null: none, as on a
  /// real radio.
  const LinkProfile* link{};
  /// By priority: airtime of the queued messages. Without a profile the link's rate is not known; the value
  /// is then how long the oldest message has waited for a socket with room.
  std::array<Duration, kPriorities> queue{};
  /// By priority: messages since the start that were never sent, because they were queued too long or a newer
  /// one replaced them.
  std::array<std::uint64_t, kPriorities> dropped{};

  /// Airtime of all messages up to and including `priority`, in [0, priorities).
  Duration waiting(std::size_t priority) const {
    Duration sum{};
    for (std::size_t p = 0; p <= priority; ++p) sum += queue[p];
    return sum;
  }
  /// Messages dropped in the classes up to and including `priority`, in [0, priorities).
  std::uint64_t lost(std::size_t priority) const {
    std::uint64_t sum = 0;
    for (std::size_t p = 0; p <= priority; ++p) sum += dropped[p];
    return sum;
  }
};

/// Traffic between us and one other participant since the start: all bytes on the network, headers included.
/// Multicast is counted for no peer.
struct PeerState {
  ParticipantId peer{};
  std::uint64_t bytes_out{}, bytes_in{};
  std::optional<double> signal{};  ///< Mean received power, dBm, when the link fades and positions are known.
};

}  // namespace adit::wire
