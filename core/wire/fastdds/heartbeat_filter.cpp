// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/heartbeat_filter.hpp"

#include "core/wire/fastdds/rtps_peek.hpp"

namespace adit::wire {

bool HeartbeatFilter::passes(std::span<const std::uint8_t> message, in_addr_t address, std::uint16_t port,
                             Duration now) {
  const auto beat = lone_heartbeat(message);
  if (!beat) return true;
  const std::lock_guard lock(mutex_);
  const Key key{address, port, beat->writer};
  if (sent_.size() >= kCapacity && !sent_.contains(key)) {
    if (now - swept_ > period_) {
      std::erase_if(sent_, [&](const auto& entry) { return now - entry.second.at > period_; });
      swept_ = now;
    }
    if (sent_.size() >= kCapacity) return true;
  }
  const auto [known, is_new] = sent_.try_emplace(key, Last{});
  Last& last = known->second;
  if (!is_new && last.first == beat->first && last.last == beat->last && now - last.at < period_)
    return false;
  last = {beat->first, beat->last, now};
  return true;
}

}  // namespace adit::wire
