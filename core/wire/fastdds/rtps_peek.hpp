#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "core/wire/link_state.hpp"

namespace adit::wire {

/// What the outside of an RTPS message tells, without trusting it.
struct RtpsPeek {
  std::optional<std::uint32_t> writer{};       ///< entity id of the first sample's writer, if it carries one
  bool whole{};                                ///< that sample is alone and no fragment
  std::optional<ParticipantId> source{};       ///< who sent the message
  std::optional<ParticipantId> destination{};  ///< whom its first part is for, if it is for one alone
  /// What it says, without how often it was said: two messages with the same number to the same receiver, the
  /// newer one stands for both. 0: none. Samples by writer and sequence number, heartbeats and
  /// acknowledgements by writer and reader.
  std::uint64_t meaning{};
};

/// Reads the submessage headers of an RTPS 2 message. Nothing in it when it is none or is cut short.
RtpsPeek peek(std::span<const std::uint8_t> message);

/// Bytes of the message without what only the library's own statistics use: 60 at the end of each that Fast
/// DDS sends where it was built with them, as Debian's is. Its own sockets write into the last 60 bytes of
/// whatever they send: what was cut must leave by other ones.
std::size_t without_statistics(std::span<const std::uint8_t> message);

/// A heartbeat that stands alone in its message.
struct LoneHeartbeat {
  std::uint32_t writer{};
  std::uint64_t first{}, last{};
};
std::optional<LoneHeartbeat> lone_heartbeat(std::span<const std::uint8_t> message);

}  // namespace adit::wire
