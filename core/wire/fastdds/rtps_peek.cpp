#include "core/wire/fastdds/rtps_peek.hpp"

#include <algorithm>
#include <cstring>

namespace adit::wire {
namespace {

using Message = std::span<const std::uint8_t>;

constexpr std::size_t header = 20;
// RTPS 2.2, 8.3.7 and 9.4.5.
constexpr std::uint8_t acknack = 0x06, heartbeat = 0x07, gap = 0x08, info_timestamp = 0x09,
                       info_destination = 0x0e, nack_frag = 0x12, data = 0x15, data_frag = 0x16;
constexpr std::uint8_t statistics = 0x80;  // of the vendor: 56 bytes
constexpr std::size_t statistics_size = 60;
constexpr std::uint8_t eprosima[2] = {0x01, 0x0f};

struct Submessage {
  std::uint8_t kind{}, flags{};
  bool little{};
  Message body{};  // without its header
};

/// Calls `see` for each whole submessage until it returns false.
template <class See>
void each(Message message, See see) {
  if (message.size() < header || std::memcmp(message.data(), "RTPS", 4) != 0) return;
  std::size_t at = header;
  while (at + 4 <= message.size()) {
    Submessage sub{message[at], message[at + 1], (message[at + 1] & 1) != 0, {}};
    const std::size_t length =
        sub.little ? message[at + 2] | message[at + 3] << 8 : message[at + 3] | message[at + 2] << 8;
    const std::size_t rest = message.size() - at - 4;
    // A length of 0 is that of the last one, up to the end. One that is cut short is seen up to there.
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

/// RTPS sequence numbers are two words, the high one first.
std::uint64_t sequence(const Submessage& sub, std::size_t at) {
  return word(sub, at) << 32 | word(sub, at + 4);
}

void mix(std::uint64_t& hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15ULL;
  hash ^= hash >> 29;
}

/// Mixes in what it says; false: it is of no kind that has a meaning of its own.
bool mean(const Submessage& sub, std::uint64_t& hash) {
  const Message body = sub.body;
  mix(hash, sub.kind);
  switch (sub.kind) {
    case acknack:
    case heartbeat:
      if (body.size() < 8) return false;
      mix(hash, entity(body, 0)), mix(hash, entity(body, 4));
      return true;
    case gap:
    case nack_frag:
      if (body.size() < 16) return false;
      mix(hash, entity(body, 0)), mix(hash, entity(body, 4)), mix(hash, sequence(sub, 8));
      return true;
    case data:
    case data_frag:
      if (body.size() < (sub.kind == data ? 20U : 24U)) return false;
      mix(hash, entity(body, 4)), mix(hash, entity(body, 8)), mix(hash, sequence(sub, 12));
      if (sub.kind == data_frag) mix(hash, word(sub, 20));
      return true;
    default:
      return true;
  }
}

}  // namespace

RtpsPeek peek(Message message) {
  RtpsPeek result;
  if (message.size() < header || std::memcmp(message.data(), "RTPS", 4) != 0) return result;
  result.source = prefix_at(message.data() + 8);
  int samples = 0;
  bool meant = true;
  std::uint64_t hash = 0;
  each(message, [&](const Submessage& sub) {
    if (sub.kind == info_destination && !result.destination && sub.body.size() >= 12) {
      const ParticipantId id = prefix_at(sub.body.data());
      if (id != ParticipantId{}) result.destination = id;
    }
    if (sub.kind == data || sub.kind == data_frag) {
      if (sub.body.size() < 12) return meant = false;
      if (!result.writer) {
        result.writer = entity(sub.body, 8);  // extra flags 2, offset of inline QoS 2, reader 4, writer 4
        result.whole = sub.kind == data;
      }
      if (++samples > 1) result.whole = false;
    }
    if (sub.kind != info_timestamp && sub.kind != statistics) meant = meant && mean(sub, hash);
    return true;
  });
  if (meant && hash != 0) result.meaning = hash | 1;
  return result;
}

std::size_t without_statistics(Message message) {
  const std::size_t size = message.size();
  if (size < header + statistics_size || std::memcmp(message.data() + 6, eprosima, 2) != 0) return size;
  const std::uint8_t* const tail = message.data() + size - statistics_size;
  if (tail[0] != statistics || tail[2] + (tail[3] << 8) != statistics_size - 4) return size;
  return size - statistics_size;
}

std::optional<LoneHeartbeat> lone_heartbeat(Message message) {
  std::optional<LoneHeartbeat> result;
  bool lone = true;
  each(message, [&](const Submessage& sub) {
    if (sub.kind == heartbeat && !result && sub.body.size() >= 24) {
      result = {entity(sub.body, 4), sequence(sub, 8), sequence(sub, 16)};
    } else if (sub.kind != info_destination && sub.kind != info_timestamp && sub.kind != statistics) {
      lone = false;
    }
    return lone;
  });
  return lone ? result : std::nullopt;
}

std::optional<PeerAddress> announced_address(Message message) {
  constexpr std::uint8_t with_qos = 2, with_data = 4;
  constexpr std::size_t fixed = 20;  // in front of the parameters
  constexpr std::uint32_t sentinel = 1, metatraffic_unicast = 0x32, udp_v4 = 1;
  std::optional<PeerAddress> result;
  each(message, [&](const Submessage& sub) {
    if (sub.kind != data || sub.body.size() < fixed || entity(sub.body, 8) != announcing_writer) return true;
    // Little-endian parameter lists alone, as every machine that we know of sends them.
    if (!sub.little || (sub.flags & with_data) == 0) return false;
    std::size_t at = fixed;
    for (int lists = (sub.flags & with_qos) != 0 ? 2 : 1; lists > 0; --lists) {
      if (lists == 1) {
        if (at + 4 > sub.body.size() || sub.body[at + 1] != 3) return false;  // PL_CDR_LE
        at += 4;
      }
      while (at + 4 <= sub.body.size()) {
        const std::uint32_t id = sub.body[at] | sub.body[at + 1] << 8;
        const std::size_t length = sub.body[at + 2] | sub.body[at + 3] << 8;
        at += 4;
        if (id == sentinel || at + length > sub.body.size()) break;
        if (lists == 1 && id == metatraffic_unicast && length >= 24 && word(sub, at) == udp_v4) {
          PeerAddress found;
          found.port = static_cast<std::uint16_t>(word(sub, at + 4));
          std::memcpy(&found.address, sub.body.data() + at + 20, 4);
          result = found;
          return false;
        }
        at += length;
      }
    }
    return false;
  });
  return result;
}

std::optional<Acknowledged> acknowledgement(Message message) {
  std::optional<Acknowledged> result;
  each(message, [&](const Submessage& sub) {
    if (sub.kind == acknack && sub.body.size() >= 16) result = {entity(sub.body, 4), sequence(sub, 8)};
    return !result;
  });
  return result;
}

void change_heartbeat_counts(std::span<std::uint8_t> message,
                             const std::function<bool(std::uint32_t)>& of_writer, std::uint32_t factor,
                             std::uint32_t more) {
  each(message, [&](const Submessage& sub) {
    if (sub.kind != heartbeat || sub.body.size() < 28 || !of_writer(entity(sub.body, 4))) return true;
    const auto count = static_cast<std::uint32_t>(word(sub, 24)) * factor + more;
    const auto at = static_cast<std::size_t>(sub.body.data() - message.data()) + 24;
    for (std::size_t i = 0; i < 4; ++i)
      message[at + i] = static_cast<std::uint8_t>(count >> 8 * (sub.little ? i : 3 - i));
    return true;
  });
}

}  // namespace adit::wire
