// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "core/wire/link_state.hpp"

/// Reads RTPS messages field by field. Nothing that is read is trusted: the caller checks sizes before it
/// reads.
namespace adit::wire::rtps_bytes {

using Message = std::span<const std::uint8_t>;

constexpr std::size_t kHeader = 20;
constexpr std::size_t kSubmessageHeader = 4;

// RTPS 2.2, 8.3.7 and 9.4.5.
constexpr std::uint8_t kPad = 0x01, kAcknack = 0x06, kHeartbeat = 0x07, kGap = 0x08, kInfoTimestamp = 0x09,
                       kInfoSource = 0x0c, kInfoReplyIp4 = 0x0d, kInfoDestination = 0x0e, kInfoReply = 0x0f,
                       kNackFrag = 0x12, kHeartbeatFrag = 0x13, kData = 0x15, kDataFrag = 0x16;
constexpr std::uint8_t kWithQos = 2, kWithData = 4, kWithKey = 8;  // Flags of DATA.
constexpr std::size_t kDataFixed = 20;  // Of a DATA's body, before its parameters and its payload.

// Parameters: RTPS 2.2, 9.6.2.2.
constexpr std::uint16_t kSentinel = 1, kLease = 0x02, kTopicName = 0x05, kUnicast = 0x2f, kMulticast = 0x30,
                        kDefaultUnicast = 0x31, kMetatrafficUnicast = 0x32, kMetatrafficMulticast = 0x33,
                        kDefaultMulticast = 0x48, kParticipantGuid = 0x50, kEndpointGuid = 0x5a,
                        kKeyHash = 0x70, kStatusInfo = 0x71;

struct Submessage {
  std::uint8_t kind{}, flags{};
  bool little{};
  Message body{};  ///< Without the submessage header.
};

inline bool has_header(Message message) {
  return message.size() >= kHeader && std::memcmp(message.data(), "RTPS", 4) == 0;
}

inline std::uint16_t half(Message bytes, std::size_t at, bool little) {
  return static_cast<std::uint16_t>(little ? bytes[at] | bytes[at + 1] << 8 : bytes[at + 1] | bytes[at] << 8);
}

inline std::uint32_t word(Message bytes, std::size_t at, bool little) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= static_cast<std::uint32_t>(bytes[at + i]) << 8 * (little ? i : 3 - i);
  return value;
}

inline std::uint64_t word(const Submessage& sub, std::size_t at) { return word(sub.body, at, sub.little); }

/// RTPS sequence numbers are two 32-bit words, the high one first.
inline std::uint64_t sequence(const Submessage& sub, std::size_t at) {
  return word(sub, at) << 32 | word(sub, at + 4);
}

inline std::uint32_t entity(Message body, std::size_t at) { return word(body, at, false); }

inline ParticipantId prefix_at(const std::uint8_t* bytes) {
  ParticipantId id{};
  std::copy_n(bytes, id.size(), id.begin());
  return id;
}

/// Calls `see` for each submessage until it returns false. The body of a truncated one extends to the end of
/// the message.
template <class See>
void each_submessage(Message message, See see) {
  if (!has_header(message)) return;
  std::size_t at = kHeader;
  while (at + kSubmessageHeader <= message.size()) {
    Submessage sub{message[at], message[at + 1], (message[at + 1] & 1) != 0, {}};
    const std::size_t length = half(message, at + 2, sub.little);
    const std::size_t rest = message.size() - at - kSubmessageHeader;
    // Length 0 means that the last submessage extends to the end.
    sub.body = message.subspan(at + kSubmessageHeader, length == 0 ? rest : std::min(length, rest));
    if (!see(sub) || length == 0) return;
    at += kSubmessageHeader + length;
  }
}

/// Calls `see(id, value)` for each parameter of the list at `at` until it returns false. Returns the offset
/// after the list; nothing when the list is truncated or `see` returned false.
template <class See>
std::optional<std::size_t> each_parameter(Message list, std::size_t at, bool little, See see) {
  while (at + 4 <= list.size()) {
    const std::uint16_t id = half(list, at, little);
    const std::size_t length = half(list, at + 2, little);
    at += 4;
    if (id == kSentinel) return at;
    if (at + length > list.size() || !see(id, list.subspan(at, length))) return std::nullopt;
    at += length;
  }
  return std::nullopt;
}

}  // namespace adit::wire::rtps_bytes
