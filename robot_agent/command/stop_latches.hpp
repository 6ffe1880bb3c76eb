// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <vector>

#include "robot_agent/command/authority.hpp"

namespace adit::agent {

/// The software stop: one latch for each stopping station, independent of the mode (rule 4). Bounded: when
/// all latches are in use, the last one stands for all further stations, and only an override clears it.
class StopLatches {
 public:
  static constexpr std::size_t kCapacity = 16;
  static constexpr const char* kOthers = "others";

  void set(const Party& stopper) {
    if (has(stopper)) return;
    if (latches_.size() < kCapacity)
      latches_.push_back(stopper);
    else
      latches_.back() = {kOthers, Id{}};
  }
  bool has(const Party& stopper) const {
    return std::find(latches_.begin(), latches_.end(), stopper) != latches_.end();
  }
  void clear(const Party& stopper) { std::erase(latches_, stopper); }
  void clear_all() { latches_.clear(); }
  bool any() const { return !latches_.empty(); }
  const std::vector<Party>& all() const { return latches_; }

 private:
  std::vector<Party> latches_{};
};

}  // namespace adit::agent
