#include "core/wire/fastdds/rtps_peek.hpp"

#include <algorithm>
#include <cstring>

namespace adit::wire {
namespace {

constexpr std::size_t header = 20;
constexpr std::uint8_t info_dst = 0x0e, data = 0x15, data_frag = 0x16;  // RTPS 2.2, 8.3.7 and 9.4.5

ParticipantId prefix_at(const std::uint8_t* bytes) {
  ParticipantId id{};
  std::copy_n(bytes, id.size(), id.begin());
  return id;
}

}  // namespace

RtpsPeek peek(std::span<const std::uint8_t> message) {
  RtpsPeek result;
  if (message.size() < header || std::memcmp(message.data(), "RTPS", 4) != 0) return result;
  result.source = prefix_at(message.data() + 8);
  int samples = 0;
  std::size_t at = header;
  while (at + 4 <= message.size()) {
    const std::uint8_t kind = message[at];
    const bool little = (message[at + 1] & 1) != 0;
    const std::size_t length =
        little ? message[at + 2] | message[at + 3] << 8 : message[at + 3] | message[at + 2] << 8;
    if (kind == info_dst && !result.destination && at + 16 <= message.size()) {
      const ParticipantId id = prefix_at(message.data() + at + 4);
      if (id != ParticipantId{}) result.destination = id;
    }
    if (kind == data || kind == data_frag) {
      // extra flags 2, offset of inline QoS 2, reader 4, writer 4
      if (at + 16 > message.size()) return result;
      if (!result.writer) {
        const std::uint8_t* id = message.data() + at + 12;
        result.writer = static_cast<std::uint32_t>(id[0]) << 24 | id[1] << 16 | id[2] << 8 | id[3];
        result.whole = kind == data;
      }
      if (++samples > 1) result.whole = false;
    }
    if (length == 0) break;  // the last one, up to the end
    at += 4 + length;
  }
  return result;
}

}  // namespace adit::wire
