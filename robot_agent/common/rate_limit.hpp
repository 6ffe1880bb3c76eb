// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>

#include "core/time/time.hpp"

namespace adit::agent {

/// Limits events to one per key and period. Bounded: beyond `capacity` keys the oldest is dropped.
template <class Key>
class RateLimit {
 public:
  explicit RateLimit(Duration period, std::size_t capacity = 64) : period_(period), capacity_(capacity) {}

  bool pass(const Key& key, Time now) {
    const auto found = last_.find(key);
    if (found != last_.end()) {
      if (now - found->second < period_) return false;
      found->second = now;
      return true;
    }
    if (last_.size() >= capacity_) {
      auto oldest = last_.begin();
      for (auto it = last_.begin(); it != last_.end(); ++it)
        if (it->second < oldest->second) oldest = it;
      last_.erase(oldest);
    }
    last_.emplace(key, now);
    return true;
  }

 private:
  Duration period_;
  std::size_t capacity_;
  std::map<Key, Time> last_{};
};

}  // namespace adit::agent
