// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <netinet/in.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <tuple>

#include "core/time/time.hpp"

namespace adit::wire {

/// Limits the rate of heartbeats that repeat the previous one. Until all of ten peers have acknowledged a
/// sample, Fast DDS sends a heartbeat to each of them with every fragment that it sends to any, and each
/// heartbeat is acknowledged. Safe to call from any thread.
class HeartbeatFilter {
 public:
  /// `period`: shortest time between two equal heartbeats of one writer to one receiver, s.
  explicit HeartbeatFilter(Duration period) : period_(period) {}
  /// Whether the message must be sent. Always true for a message that is not a single heartbeat, and for
  /// heartbeats beyond the capacity of the table.
  bool passes(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port, Duration now);

 private:
  static constexpr std::size_t kCapacity = 4096;
  using Key = std::tuple<in_addr_t, std::uint16_t, std::uint32_t>;  // Receiver and writer.
  struct Last {
    std::uint64_t first{}, last{};
    Duration at{};
  };
  Duration period_;
  std::mutex mutex_{};
  std::map<Key, Last> sent_{};
  Duration swept_{};  // When old entries were last erased.
};

}  // namespace adit::wire
