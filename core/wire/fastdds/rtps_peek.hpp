#pragma once
#include <netinet/in.h>

#include <cstdint>
#include <functional>
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
  /// A number for what the message says, without how often it was said: of two messages with the same number
  /// to the same receiver the newer one stands for both. Samples by writer and sequence number, heartbeats
  /// and acknowledgements by writer and reader. 0: a submessage is of a kind that cannot be read, as under
  /// DDS security; then the message stands for itself alone.
  std::uint64_t dedup_key{};
};

/// Reads the submessage headers of an RTPS 2 message. Nothing in it when it is none or is cut short.
RtpsPeek peek(std::span<const std::uint8_t> message);

/// A number for the key of the first sample: of its key hash, where the library sends one, else of the first
/// string of its payload, which is the key of every keyed topic. Nothing where there is no such sample.
std::optional<std::uint64_t> sample_key(std::span<const std::uint8_t> message);

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

/// Entity id of the writer of participant announcements: RTPS 2.2, 9.3.1.3.
inline constexpr std::uint32_t kAnnouncingWriter = 0x000100c2;

/// Where the participant that announces itself wants to hear of others; nothing where the message is no
/// announcement or a goodbye.
struct PeerAddress {
  in_addr_t address{};  ///< IPv4, network order
  std::uint16_t port{};
};
std::optional<PeerAddress> announced_address(std::span<const std::uint8_t> message);

/// What a reader acknowledges: all before `base`, of that writer.
struct Acknowledged {
  std::uint32_t writer{};
  std::uint64_t base{};
};
std::optional<Acknowledged> acknowledgement(std::span<const std::uint8_t> message);

/// Sets the count of each heartbeat of those writers to `factor` * count + `more`. Readers ignore all but a
/// higher count than before. Leaves messages under DDS security as they are: a code covers their bytes.
void change_heartbeat_counts(std::span<std::uint8_t> message,
                             const std::function<bool(std::uint32_t)>& of_writer, std::uint32_t factor,
                             std::uint32_t more);

}  // namespace adit::wire
