#pragma once
#include <netinet/in.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <tuple>

#include "core/time/time.hpp"

namespace adit::wire {

/// Lets a heartbeat that says nothing new pass only so often. Until all of ten peers have acknowledged
/// something, Fast DDS sends one to each with every fragment that it sends to any, and each is acknowledged.
/// Any thread.
class HeartbeatFilter {
 public:
  /// `period`: between two heartbeats of one writer to one receiver that say the same, s.
  explicit HeartbeatFilter(Duration period) : period_(period) {}
  /// Whether the message is to be sent. Always true for what is no lone heartbeat, and for heartbeats beyond
  /// the bound of what it remembers.
  bool passes(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port, Duration now);

 private:
  static constexpr std::size_t kCapacity = 4096;
  using Key = std::tuple<in_addr_t, std::uint16_t, std::uint32_t>;  // receiver and writer
  struct Last {
    std::uint64_t first{}, last{};
    Duration at{};
  };
  Duration period_;
  std::mutex mutex_{};
  std::map<Key, Last> sent_{};
  Duration swept_{};  // when old entries were last erased
};

}  // namespace adit::wire
