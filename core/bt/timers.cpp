// SPDX-License-Identifier: Apache-2.0
#include "core/bt/timers.hpp"

#include <algorithm>
#include <utility>

namespace adit::bt {

Timers::Id Timers::add(Time deadline, std::function<void()> expired) {
  entries_.push_back({deadline, ++last_, std::move(expired)});
  return last_;
}

void Timers::cancel(Id id) {
  std::erase_if(entries_, [id](const Entry& entry) { return entry.id == id; });
}

void Timers::expire(Time now) {
  // Timers run one at a time, because halting a child from one timer may cancel others.
  while (!entries_.empty()) {
    const auto next = std::min_element(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return std::pair(a.deadline, a.id) < std::pair(b.deadline, b.id);
    });
    if (next->deadline > now) return;
    const auto expired = std::move(next->expired);
    entries_.erase(next);
    expired();
  }
}

}  // namespace adit::bt
