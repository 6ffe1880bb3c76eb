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
  explicit HeartbeatFilter(Duration period) : period_(period) {}
  bool passes(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port, Duration now);

 private:
  static constexpr std::size_t most = 4096;
  struct Last {
    std::uint64_t first{}, last{};
    Duration at{};
  };
  Duration period_;
  std::mutex mutex_{};
  std::map<std::tuple<in_addr_t, std::uint16_t, std::uint32_t>, Last> sent_{};  // by receiver and writer
};

}  // namespace adit::wire
