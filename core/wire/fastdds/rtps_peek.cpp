#include "core/wire/fastdds/rtps_peek.hpp"

#include <algorithm>
#include <cstring>

#include "core/wire/cdr_key.hpp"

namespace adit::wire {
namespace {

using Message = std::span<const std::uint8_t>;

constexpr std::size_t header = 20;
// RTPS 2.2, 8.3.7 and 9.4.5.
constexpr std::uint8_t acknack = 0x06, heartbeat = 0x07, gap = 0x08, info_timestamp = 0x09,
                       info_source = 0x0c, info_destination = 0x0e, nack_frag = 0x12, data = 0x15,
                       data_frag = 0x16;
// DDS Security 1.1, 7.3.6: SEC_BODY, SEC_PREFIX, SEC_POSTFIX, SRTPS_PREFIX, SRTPS_POSTFIX.
constexpr std::uint8_t first_security = 0x30, last_security = 0x34;
constexpr std::uint8_t with_qos = 2, with_data = 4;  // flags of DATA
constexpr std::uint16_t sentinel = 1, key_hash = 0x70, metatraffic_unicast = 0x32;
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

void mix(std::uint64_t& hash, Message bytes) {
  for (const std::uint8_t byte : bytes) mix(hash, static_cast<std::uint64_t>(byte));
}

bool is_protected(Message message) {
  bool found = false;
  each(message, [&](const Submessage& sub) {
    found = sub.kind >= first_security && sub.kind <= last_security;
    return !found;
  });
  return found;
}

/// Calls `see(id, value)` for each parameter of the list at `at` until it returns false. Returns the offset
/// behind the list; nothing where the list is cut short or `see` returned false.
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
    if (id == sentinel) return at;
    if (at + length > sub.body.size() || !see(id, sub.body.subspan(at, length))) return std::nullopt;
    at += length;
  }
  return std::nullopt;
}

/// Mixes in what the submessage says. Returns false for a kind that it cannot read.
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
    case info_source:
    case info_destination:
      mix(hash, body);
      return true;
    default:
      return false;
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

std::optional<std::uint64_t> sample_key(Message message) {
  constexpr std::size_t fixed = 20;  // in front of the parameters and the payload
  std::optional<std::uint64_t> result;
  each(message, [&](const Submessage& sub) {
    if (sub.kind != data) return true;
    if (sub.body.size() < fixed) return false;
    std::uint64_t hash = 0;
    std::optional<std::size_t> payload = fixed;
    if ((sub.flags & with_qos) != 0) {
      payload = each_parameter(sub, fixed, [&](std::uint16_t id, Message value) {
        if (id != key_hash) return true;
        mix(hash, value);
        result = hash;
        return false;
      });
    }
    if (result || !payload || (sub.flags & with_data) == 0) return false;
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
  if (size < header + statistics_size || std::memcmp(message.data() + 6, eprosima, 2) != 0) return size;
  const std::uint8_t* const tail = message.data() + size - statistics_size;
  if (tail[0] != statistics || tail[2] + (tail[3] << 8) != statistics_size - 4) return size;
  // A payload can end with the same bytes: the tail counts where a submessage begins there.
  bool begins = false;
  each(message, [&](const Submessage& sub) {
    begins = sub.kind == statistics && sub.body.data() == tail + 4;
    return !begins;
  });
  return begins ? size - statistics_size : size;
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
  constexpr std::size_t fixed = 20;  // in front of the parameters
  constexpr std::uint32_t udp_v4 = 1;
  std::optional<PeerAddress> result;
  each(message, [&](const Submessage& sub) {
    if (sub.kind != data || sub.body.size() < fixed || entity(sub.body, 8) != announcing_writer) return true;
    // Little-endian parameter lists alone, as every machine that we know of sends them.
    if (!sub.little || (sub.flags & with_data) == 0) return false;
    std::optional<std::size_t> at = fixed;
    if ((sub.flags & with_qos) != 0) at = each_parameter(sub, fixed, [](auto, auto) { return true; });
    if (!at || *at + 4 > sub.body.size() || sub.body[*at + 1] != 3) return false;  // PL_CDR_LE
    each_parameter(sub, *at + 4, [&](std::uint16_t id, Message value) {
      const auto offset = static_cast<std::size_t>(value.data() - sub.body.data());
      if (id != metatraffic_unicast || value.size() < 24 || word(sub, offset) != udp_v4) return true;
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
    if (sub.kind == acknack && sub.body.size() >= 16) result = {entity(sub.body, 4), sequence(sub, 8)};
    return !result;
  });
  return result;
}

void change_heartbeat_counts(std::span<std::uint8_t> message,
                             const std::function<bool(std::uint32_t)>& of_writer, std::uint32_t factor,
                             std::uint32_t more) {
  if (is_protected(message)) return;
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
