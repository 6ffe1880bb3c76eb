// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "core/time/time.hpp"

namespace adit::bt {

/// The timers of one tree's Delay, Timeout and Sleep nodes. In BehaviorTree.CPP they run on a separate thread
/// and thus between two ticks; here they run on the tree's strand at the start of the next tick, earliest
/// first. Each node has at most one, so there are never more timers than nodes.
class Timers {
 public:
  using Id = std::uint64_t;
  /// Calls `expired` in the first tick after this one that starts at `deadline` or later.
  Id add(Time deadline, std::function<void()> expired);
  /// Removes the timer; ids that have expired or are 0 are ignored.
  void cancel(Id id);
  /// Runs the timers that are due.
  void expire(Time now);

 private:
  struct Entry {
    Time deadline{};
    Id id{0};
    std::function<void()> expired{};
  };
  std::vector<Entry> entries_{};
  Id last_{0};
};

}  // namespace adit::bt
