// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/rtps_peek.hpp"

#include <algorithm>
#include <cstring>

#include "core/wire/cdr_key.hpp"
#include "core/wire/fastdds/rtps_submessage.hpp"

namespace adit::wire {
namespace {

using namespace rtps_bytes;

// DDS Security 1.1, 7.3.6: SEC_BODY, SEC_PREFIX, SEC_POSTFIX, SRTPS_PREFIX, SRTPS_POSTFIX.
constexpr std::uint8_t kFirstSecurity = 0x30, kLastSecurity = 0x34;
constexpr std::uint8_t kStatistics = 0x80;  // Of the vendor: 56 bytes.
constexpr std::size_t kStatisticsSize = 60;
constexpr std::uint8_t kEprosima[2] = {0x01, 0x0f};

void mix(std::uint64_t& hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15ULL;
  hash ^= hash >> 29;
}

void mix(std::uint64_t& hash, Message bytes) {
  for (const std::uint8_t byte : bytes) mix(hash, static_cast<std::uint64_t>(byte));
}

bool is_protected(Message message) {
  bool found = false;
  each_submessage(message, [&](const Submessage& sub) {
    found = sub.kind >= kFirstSecurity && sub.kind <= kLastSecurity;
    return !found;
  });
  return found;
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
  if (!has_header(message)) return result;
  result.source = prefix_at(message.data() + 8);
  int samples = 0;
  bool has_dedup_key = true;
  std::uint64_t hash = 0;
  each_submessage(message, [&](const Submessage& sub) {
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
  std::optional<std::uint64_t> result;
  each_submessage(message, [&](const Submessage& sub) {
    if (sub.kind != kData) return true;
    if (sub.body.size() < kDataFixed) return false;
    std::uint64_t hash = 0;
    std::optional<std::size_t> payload = kDataFixed;
    if ((sub.flags & kWithQos) != 0) {
      payload = each_parameter(sub.body, kDataFixed, sub.little, [&](std::uint16_t id, Message value) {
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
  each_submessage(message, [&](const Submessage& sub) {
    begins = sub.kind == kStatistics && sub.body.data() == tail + 4;
    return !begins;
  });
  return begins ? size - kStatisticsSize : size;
}

std::optional<LoneHeartbeat> lone_heartbeat(Message message) {
  std::optional<LoneHeartbeat> result;
  bool lone = true;
  each_submessage(message, [&](const Submessage& sub) {
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
  constexpr std::uint32_t udp_v4 = 1;
  std::optional<PeerAddress> result;
  each_submessage(message, [&](const Submessage& sub) {
    if (sub.kind != kData || sub.body.size() < kDataFixed || entity(sub.body, 8) != kAnnouncingWriter)
      return true;
    // Only little-endian parameter lists are read, as all known implementations send them.
    if (!sub.little || (sub.flags & kWithData) == 0) return false;
    std::optional<std::size_t> at = kDataFixed;
    if ((sub.flags & kWithQos) != 0)
      at = each_parameter(sub.body, kDataFixed, sub.little, [](auto, auto) { return true; });
    if (!at || *at + 4 > sub.body.size() || sub.body[*at + 1] != 3) return false;  // PL_CDR_LE
    each_parameter(sub.body, *at + 4, sub.little, [&](std::uint16_t id, Message value) {
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
  each_submessage(message, [&](const Submessage& sub) {
    if (sub.kind == kAcknack && sub.body.size() >= 16) result = {entity(sub.body, 4), sequence(sub, 8)};
    return !result;
  });
  return result;
}

void change_heartbeat_counts(std::span<std::uint8_t> message,
                             const std::function<bool(std::uint32_t)>& of_writer, std::uint32_t factor,
                             std::uint32_t more) {
  if (is_protected(message)) return;
  each_submessage(message, [&](const Submessage& sub) {
    if (sub.kind != kHeartbeat || sub.body.size() < 28 || !of_writer(entity(sub.body, 4))) return true;
    const auto count = static_cast<std::uint32_t>(word(sub, 24)) * factor + more;
    const auto at = static_cast<std::size_t>(sub.body.data() - message.data()) + 24;
    for (std::size_t i = 0; i < 4; ++i)
      message[at + i] = static_cast<std::uint8_t>(count >> 8 * (sub.little ? i : 3 - i));
    return true;
  });
}

}  // namespace adit::wire
