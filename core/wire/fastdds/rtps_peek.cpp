// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/rtps_peek.hpp"

#include <algorithm>
#include <cstring>

#include "core/wire/cdr_key.hpp"

namespace adit::wire {
namespace {

using Message = std::span<const std::uint8_t>;

constexpr std::size_t kHeader = 20;
// RTPS 2.2, 8.3.7 and 9.4.5.
constexpr std::uint8_t kAcknack = 0x06, kHeartbeat = 0x07, kGap = 0x08, kInfoTimestamp = 0x09,
                       kInfoSource = 0x0c, kInfoDestination = 0x0e, kNackFrag = 0x12, kData = 0x15,
                       kDataFrag = 0x16;
// DDS Security 1.1, 7.3.6: SEC_BODY, SEC_PREFIX, SEC_POSTFIX, SRTPS_PREFIX, SRTPS_POSTFIX.
constexpr std::uint8_t kFirstSecurity = 0x30, kLastSecurity = 0x34;
constexpr std::uint8_t kWithQos = 2, kWithData = 4;  // Flags of DATA.
constexpr std::uint16_t kSentinel = 1, kKeyHash = 0x70, kMetatrafficUnicast = 0x32;
constexpr std::uint8_t kStatistics = 0x80;  // Of the vendor: 56 bytes.
constexpr std::size_t kStatisticsSize = 60;
constexpr std::uint8_t kEprosima[2] = {0x01, 0x0f};

struct Submessage {
  std::uint8_t kind{}, flags{};
  bool little{};
  Message body{};  // Without the submessage header.
};

/// Calls `see` for each complete submessage until it returns false.
template <class See>
void each(Message message, See see) {
  if (message.size() < kHeader || std::memcmp(message.data(), "RTPS", 4) != 0) return;
  std::size_t at = kHeader;
  while (at + 4 <= message.size()) {
    Submessage sub{message[at], message[at + 1], (message[at + 1] & 1) != 0, {}};
    const std::size_t length =
        sub.little ? message[at + 2] | message[at + 3] << 8 : message[at + 3] | message[at + 2] << 8;
    const std::size_t rest = message.size() - at - 4;
    // Length 0 means that the last submessage extends to the end. A truncated one is visible up to the end.
    sub.body = message.subspan(at + 4, length == 0 ? rest : std::min(length, rest));
    if (!see(sub) || length == 0) return;
    at += 4 + length;
  }
}

ParticipantId prefix_at(const std::uint8_t* bytes) {
  ParticipantId id{};
  std::copy_n(bytes, id.size(), id.begin());
  return id;
}

std::uint32_t entity(Message body, std::size_t at) {
  return static_cast<std::uint32_t>(body[at]) << 24 | body[at + 1] << 16 | body[at + 2] << 8 | body[at + 3];
}

std::uint64_t word(const Submessage& sub, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= static_cast<std::uint64_t>(sub.body[at + i]) << 8 * (sub.little ? i : 3 - i);
  }
  return value;
}

/// RTPS sequence numbers are two 32-bit words, the high one first.
std::uint64_t sequence(const Submessage& sub, std::size_t at) {
  return word(sub, at) << 32 | word(sub, at + 4);
}

void mix(std::uint64_t& hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15ULL;
  hash ^= hash >> 29;
}

void mix(std::uint64_t& hash, Message bytes) {
  for (const std::uint8_t byte : bytes) mix(hash, static_cast<std::uint64_t>(byte));
}

bool is_protected(Message message) {
  bool found = false;
  each(message, [&](const Submessage& sub) {
    found = sub.kind >= kFirstSecurity && sub.kind <= kLastSecurity;
    return !found;
  });
  return found;
}

/// Calls `see(id, value)` for each parameter of the list at `at` until it returns false. Returns the offset
/// after the list; nothing when the list is truncated or `see` returned false.
template <class See>
std::optional<std::size_t> each_parameter(const Submessage& sub, std::size_t at, See see) {
  const auto half = [&](std::size_t i) {
    return static_cast<std::uint16_t>(sub.little ? sub.body[i] | sub.body[i + 1] << 8
                                                 : sub.body[i + 1] | sub.body[i] << 8);
  };
  while (at + 4 <= sub.body.size()) {
    const std::uint16_t id = half(at);
    const std::size_t length = half(at + 2);
    at += 4;
    if (id == kSentinel) return at;
    if (at + length > sub.body.size() || !see(id, sub.body.subspan(at, length))) return std::nullopt;
    at += length;
  }
  return std::nullopt;
}

/// Adds the submessage to the hash. Returns false for a kind that it cannot read.
bool add_to_dedup_key(const Submessage& sub, std::uint64_t& hash) {
  const Message body = sub.body;
  mix(hash, sub.kind);
  switch (sub.kind) {
    case kAcknack:
    case kHeartbeat:
      if (body.size() < 8) return false;
      mix(hash, entity(body, 0)), mix(hash, entity(body, 4));
      return true;
    case kGap:
    case kNackFrag:
      if (body.size() < 16) return false;
      mix(hash, entity(body, 0)), mix(hash, entity(body, 4)), mix(hash, sequence(sub, 8));
      return true;
    case kData:
    case kDataFrag:
      if (body.size() < (sub.kind == kData ? 20U : 24U)) return false;
      mix(hash, entity(body, 4)), mix(hash, entity(body, 8)), mix(hash, sequence(sub, 12));
      if (sub.kind == kDataFrag) mix(hash, word(sub, 20));
      return true;
    case kInfoSource:
    case kInfoDestination:
      mix(hash, body);
      return true;
    default:
      return false;
  }
}

}  // namespace

RtpsPeek peek(Message message) {
  RtpsPeek result;
  if (message.size() < kHeader || std::memcmp(message.data(), "RTPS", 4) != 0) return result;
  result.source = prefix_at(message.data() + 8);
  int samples = 0;
  bool has_dedup_key = true;
  std::uint64_t hash = 0;
  each(message, [&](const Submessage& sub) {
    if (sub.kind == kInfoDestination && !result.destination && sub.body.size() >= 12) {
      const ParticipantId id = prefix_at(sub.body.data());
      if (id != ParticipantId{}) result.destination = id;
    }
    if (sub.kind == kData || sub.kind == kDataFrag) {
      if (sub.body.size() < 12) return has_dedup_key = false;
      if (!result.writer) {
        result.writer = entity(sub.body, 8);  // Extra flags 2, offset of inline QoS 2, reader 4, writer 4.
        result.complete = sub.kind == kData;
      }
      if (++samples > 1) result.complete = false;
    }
    if (sub.kind != kInfoTimestamp && sub.kind != kStatistics)
      has_dedup_key = has_dedup_key && add_to_dedup_key(sub, hash);
    return true;
  });
  if (has_dedup_key && hash != 0) result.dedup_key = hash | 1;
  return result;
}

std::optional<std::uint64_t> sample_key(Message message) {
  constexpr std::size_t fixed = 20;  // Before the parameters and the payload.
  std::optional<std::uint64_t> result;
  each(message, [&](const Submessage& sub) {
    if (sub.kind != kData) return true;
    if (sub.body.size() < fixed) return false;
    std::uint64_t hash = 0;
    std::optional<std::size_t> payload = fixed;
    if ((sub.flags & kWithQos) != 0) {
      payload = each_parameter(sub, fixed, [&](std::uint16_t id, Message value) {
        if (id != kKeyHash) return true;
        mix(hash, value);
        result = hash;
        return false;
      });
    }
    if (result || !payload || (sub.flags & kWithData) == 0) return false;
    if (const auto key = first_string(sub.body.subspan(*payload))) {
      mix(hash, {reinterpret_cast<const std::uint8_t*>(key->data()), key->size()});
      result = hash;
    }
    return false;
  });
  return result;
}

std::size_t without_statistics(Message message) {
  const std::size_t size = message.size();
  if (size < kHeader + kStatisticsSize || std::memcmp(message.data() + 6, kEprosima, 2) != 0) return size;
  const std::uint8_t* const tail = message.data() + size - kStatisticsSize;
  if (tail[0] != kStatistics || tail[2] + (tail[3] << 8) != kStatisticsSize - 4) return size;
  // A payload can end with the same bytes: the tail is removed only when a submessage begins there.
  bool begins = false;
  each(message, [&](const Submessage& sub) {
    begins = sub.kind == kStatistics && sub.body.data() == tail + 4;
    return !begins;
  });
  return begins ? size - kStatisticsSize : size;
}

std::optional<LoneHeartbeat> lone_heartbeat(Message message) {
  std::optional<LoneHeartbeat> result;
  bool lone = true;
  each(message, [&](const Submessage& sub) {
    if (sub.kind == kHeartbeat && !result && sub.body.size() >= 24) {
      result = {entity(sub.body, 4), sequence(sub, 8), sequence(sub, 16)};
    } else if (sub.kind != kInfoDestination && sub.kind != kInfoTimestamp && sub.kind != kStatistics) {
      lone = false;
    }
    return lone;
  });
  return lone ? result : std::nullopt;
}

std::optional<PeerAddress> announced_address(Message message) {
  constexpr std::size_t fixed = 20;  // Before the parameters.
  constexpr std::uint32_t udp_v4 = 1;
  std::optional<PeerAddress> result;
  each(message, [&](const Submessage& sub) {
    if (sub.kind != kData || sub.body.size() < fixed || entity(sub.body, 8) != kAnnouncingWriter) return true;
    // Only little-endian parameter lists are read, as all known implementations send them.
    if (!sub.little || (sub.flags & kWithData) == 0) return false;
    std::optional<std::size_t> at = fixed;
    if ((sub.flags & kWithQos) != 0) at = each_parameter(sub, fixed, [](auto, auto) { return true; });
    if (!at || *at + 4 > sub.body.size() || sub.body[*at + 1] != 3) return false;  // PL_CDR_LE
    each_parameter(sub, *at + 4, [&](std::uint16_t id, Message value) {
      const auto offset = static_cast<std::size_t>(value.data() - sub.body.data());
      if (id != kMetatrafficUnicast || value.size() < 24 || word(sub, offset) != udp_v4) return true;
      PeerAddress found;
      found.port = static_cast<std::uint16_t>(word(sub, offset + 4));
      std::memcpy(&found.address, value.data() + 20, 4);
      result = found;
      return false;
    });
    return false;
  });
  return result;
}

std::optional<Acknowledged> acknowledgement(Message message) {
  std::optional<Acknowledged> result;
  each(message, [&](const Submessage& sub) {
    if (sub.kind == kAcknack && sub.body.size() >= 16) result = {entity(sub.body, 4), sequence(sub, 8)};
    return !result;
  });
  return result;
}

void change_heartbeat_counts(std::span<std::uint8_t> message,
                             const std::function<bool(std::uint32_t)>& of_writer, std::uint32_t factor,
                             std::uint32_t more) {
  if (is_protected(message)) return;
  each(message, [&](const Submessage& sub) {
    if (sub.kind != kHeartbeat || sub.body.size() < 28 || !of_writer(entity(sub.body, 4))) return true;
    const auto count = static_cast<std::uint32_t>(word(sub, 24)) * factor + more;
    const auto at = static_cast<std::size_t>(sub.body.data() - message.data()) + 24;
    for (std::size_t i = 0; i < 4; ++i)
      message[at + i] = static_cast<std::uint8_t>(count >> 8 * (sub.little ? i : 3 - i));
    return true;
  });
}

}  // namespace adit::wire
