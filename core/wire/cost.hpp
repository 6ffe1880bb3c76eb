// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/time/time.hpp"

namespace adit::wire {

/// Bytes that a message costs on the network as Fast DDS sends it, RTPS, UDP and IP headers included
/// (docs/wire.md has the measurement).
struct WireCost {
  static constexpr std::uint32_t kFrame = 1400;       ///< Largest frame, bytes, unless the link sets another.
  static constexpr std::uint32_t kUdpAndIp = 20 + 8;  ///< IP and UDP headers of a datagram.
  static constexpr std::uint32_t kHeaders = 20 + kUdpAndIp;  ///< RTPS, UDP and IP headers, once per frame.
  /// Headers with INFO_DST, INFO_TS and DATA.
  static constexpr std::uint32_t kData = kHeaders + 16 + 12 + 24;
  static constexpr std::uint32_t kHeartbeat = kHeaders + 16 + 32;
  static constexpr std::uint32_t kPiggyback = 32;  ///< A heartbeat in the same datagram as a sample.
  static constexpr std::uint32_t kAcknack = kHeaders + 16 + 32;
  static constexpr std::uint32_t kGap = kHeaders + 16 + 36;
  static constexpr std::uint32_t kParticipant = 290;  ///< A participant announcement.
  static constexpr std::uint32_t kEndpoint = 480;     ///< One endpoint announced to one peer.
  static constexpr std::uint32_t kGoodbye = 150;
  static constexpr int kDiscoveryPriority = 1;  ///< After urgent samples.
  static constexpr Duration kResponse = 5ms;    ///< Response delay to heartbeats and acknacks.

  /// Number of frames of a sample of `payload` serialised bytes, each of at most `largest` bytes.
  static constexpr std::uint16_t frames(std::size_t payload, std::uint32_t largest = kFrame) {
    const std::size_t room = std::max(largest, kData + 64) - kData;
    return static_cast<std::uint16_t>(std::clamp<std::size_t>((payload + room - 1) / room, 1, 65535));
  }
  /// Bytes that such a sample costs per reader.
  static constexpr std::uint32_t sample(std::size_t payload, std::uint32_t largest = kFrame) {
    return static_cast<std::uint32_t>(payload) + frames(payload, largest) * kData;
  }
};

}  // namespace adit::wire
