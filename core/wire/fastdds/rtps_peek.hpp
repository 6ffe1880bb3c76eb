// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <netinet/in.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "core/wire/link_state.hpp"

namespace adit::wire {

/// What the headers of an RTPS message show; none of it is trusted.
struct RtpsPeek {
  std::optional<std::uint32_t> writer{};  ///< Entity id of the writer of the first sample, if there is one.
  bool complete{};                        ///< The sample is the only one and not a fragment.
  std::optional<ParticipantId> source{};  ///< The participant that sent the message.
  /// The participant that the first submessages address, if it is a single one.
  std::optional<ParticipantId> destination{};
  /// Hash of the message's meaning without its repetition counts: of two messages with the same hash to the
  /// same receiver, the newer one replaces both. Samples count by writer and sequence number, heartbeats and
  /// acknowledgements by writer and reader. 0: a submessage is of a kind that cannot be read, as under DDS
  /// security; the message then replaces no other.
  std::uint64_t dedup_key{};
};

/// Reads the submessage headers of an RTPS 2 message. The result is empty when it is no such message or is
/// truncated.
RtpsPeek peek(std::span<const std::uint8_t> message);

/// Hash of the key of the first sample: of its key hash, where the library sends one, else of the first
/// string of its payload, which is the key of every keyed topic. Nothing when there is no such sample.
std::optional<std::uint64_t> sample_key(std::span<const std::uint8_t> message);

/// Size of the message without the part that only the library's statistics use: the last 60 bytes of each
/// message that Fast DDS sends when built with statistics, as Debian's is. The library's own sockets write
/// into the last 60 bytes of every message, so a shortened message must leave through other sockets.
std::size_t without_statistics(std::span<const std::uint8_t> message);

/// A heartbeat that is the only content of its message.
struct LoneHeartbeat {
  std::uint32_t writer{};
  std::uint64_t first{}, last{};
};
std::optional<LoneHeartbeat> lone_heartbeat(std::span<const std::uint8_t> message);

/// Entity ids of the writers of participant announcements, and of those of writers and readers: RTPS 2.2,
/// 9.3.1.3.
inline constexpr std::uint32_t kAnnouncingWriter = 0x000100c2, kPublicationsWriter = 0x000003c2,
                               kSubscriptionsWriter = 0x000004c2;

/// Unicast address at which the announcing participant receives discovery data; nothing when the message is
/// no announcement, or a goodbye.
struct PeerAddress {
  in_addr_t address{};  ///< IPv4, network order.
  std::uint16_t port{};
};
std::optional<PeerAddress> announced_address(std::span<const std::uint8_t> message);

/// Acknowledgement of a reader: it has all samples of that writer before `base`.
struct Acknowledged {
  std::uint32_t writer{};
  std::uint64_t base{};
};
std::optional<Acknowledged> acknowledgement(std::span<const std::uint8_t> message);

/// Sets the count of each heartbeat of those writers to `factor` * count + `more`. Readers ignore a heartbeat
/// unless its count is higher than before. Messages under DDS security stay unchanged, because a code
/// protects their bytes.
void change_heartbeat_counts(std::span<std::uint8_t> message,
                             const std::function<bool(std::uint32_t)>& of_writer, std::uint32_t factor,
                             std::uint32_t more);

}  // namespace adit::wire
