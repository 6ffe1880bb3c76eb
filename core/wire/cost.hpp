#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/time/time.hpp"

namespace adit::wire {

/// Bytes that a message costs on the network, RTPS, UDP and IP headers included; as Fast DDS sends them
/// (docs/wire.md has the measurement).
struct WireCost {
  static constexpr std::uint32_t kFrame = 1400;              ///< largest one, where no link says otherwise
  static constexpr std::uint32_t kUdpAndIp = 20 + 8;         ///< headers of a datagram
  static constexpr std::uint32_t kHeaders = 20 + kUdpAndIp;  ///< RTPS, UDP and IP: once per frame
  static constexpr std::uint32_t kData = kHeaders + 16 + 12 + 24;  ///< + INFO_DST, INFO_TS, DATA
  static constexpr std::uint32_t kHeartbeat = kHeaders + 16 + 32;
  static constexpr std::uint32_t kPiggyback = 32;  ///< a heartbeat that goes with a sample
  static constexpr std::uint32_t kAcknack = kHeaders + 16 + 32;
  static constexpr std::uint32_t kGap = kHeaders + 16 + 36;
  static constexpr std::uint32_t kParticipant = 290;  ///< announcement
  static constexpr std::uint32_t kEndpoint = 480;     ///< one endpoint announced to one peer
  static constexpr std::uint32_t kGoodbye = 150;
  static constexpr int kDiscoveryPriority = 1;  ///< after urgent samples
  static constexpr Duration kResponse = 5ms;    ///< to heartbeats and to acknacks

  /// Frames of a sample of that many serialised bytes, each of at most `largest` bytes.
  static constexpr std::uint16_t frames(std::size_t payload, std::uint32_t largest = kFrame) {
    const std::size_t room = std::max(largest, kData + 64) - kData;
    return static_cast<std::uint16_t>(std::clamp<std::size_t>((payload + room - 1) / room, 1, 65535));
  }
  /// Bytes of that sample to one reader.
  static constexpr std::uint32_t sample(std::size_t payload, std::uint32_t largest = kFrame) {
    return static_cast<std::uint32_t>(payload) + frames(payload, largest) * kData;
  }
};

}  // namespace adit::wire
