#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/time/time.hpp"
#include "core/wire/link/budget.hpp"

namespace adit::wire {

/// The sender's side of a link: what waits for the air, by priority, each class within its share of the
/// airtime. Frame by frame, so that an urgent message waits for one frame at most. Pure: the caller has the
/// clock and the air. `Item` is what it carries.
template <class Item>
class TransmitQueue {
 public:
  struct Waiting {
    Item item{};
    std::uint16_t frames{1};  ///< of the message
    std::uint16_t sent{};     ///< of them already
    int priority{};
    std::uint64_t supersedes{};  ///< not 0: replaces a waiting one of this number
    bool again{};                ///< it says the same as that one: nothing is lost then
    Duration since{};
    Duration max_queue_age{};  ///< dropped when it waited longer
    Duration airtime{};        ///< of one frame, as it was when it began to wait: for waiting()
  };

  explicit TransmitQueue(Budget budget = {}) : budget_(budget) {}

  /// Returns what it replaced: a waiting message of the same number of which nothing was sent yet.
  std::optional<Item> push(Waiting waiting) {
    waiting.priority = std::clamp(waiting.priority, 0, static_cast<int>(kPriorities) - 1);
    auto& queue = queues_[static_cast<std::size_t>(waiting.priority)];
    if (waiting.supersedes != 0) {
      for (Waiting& old : queue) {
        if (old.supersedes != waiting.supersedes || old.sent > 0) continue;
        std::swap(old, waiting);
        if (!waiting.again) ++dropped_[static_cast<std::size_t>(waiting.priority)];
        return std::move(waiting.item);
      }
    }
    queue.push_back(std::move(waiting));
    return std::nullopt;
  }

  /// The message whose next frame goes now: its frame number and whether it is the last one. Nothing: none
  /// waits, or see ready(). `airtime(item)` is that of one frame of it; what waited too long goes to `drop`.
  struct Next {
    Waiting message{};
    Duration airtime{};
    bool last{};
  };
  template <class Airtime, class Drop>
  std::optional<Next> next(Duration now, Airtime airtime, Drop drop) {
    for (std::size_t p = 0; p < kPriorities; ++p) {
      auto& queue = queues_[p];
      while (!queue.empty() && queue.front().sent == 0 &&
             now - queue.front().since > queue.front().max_queue_age) {
        Waiting stale = std::move(queue.front());
        queue.pop_front();
        ++dropped_[p];
        drop(std::move(stale.item));
      }
      if (queue.empty() || tokens(p, now) < 0.0) continue;
      Waiting& head = queue.front();
      const Duration cost = airtime(head.item);
      if (budget_.share[p] < 1.0) tokens_[p] -= seconds(cost);
      ++head.sent;
      if (head.sent < head.frames) return Next{head, cost, false};
      Next result{std::move(head), cost, true};
      queue.pop_front();
      return result;
    }
    return std::nullopt;
  }

  /// When next() should be asked again although it had nothing: a class that waits for its share. Nothing
  /// when nothing waits.
  std::optional<Duration> ready(Duration now) {
    std::optional<Duration> soonest;
    for (std::size_t p = 0; p < kPriorities; ++p) {
      if (queues_[p].empty()) continue;
      const double debt = std::max(0.0, -tokens(p, now));
      const Duration at = now + from_seconds(debt / budget_.share[p]) + 1us;
      if (!soonest || at < *soonest) soonest = at;
    }
    return soonest;
  }

  std::size_t size() const {
    std::size_t n = 0;
    for (const auto& queue : queues_) n += queue.size();
    return n;
  }
  std::size_t size(int priority) const { return queues_[static_cast<std::size_t>(priority)].size(); }
  /// Airtime that what waits needs, by priority.
  std::array<Duration, kPriorities> waiting() const {
    std::array<Duration, kPriorities> need{};
    for (std::size_t p = 0; p < kPriorities; ++p)
      for (const Waiting& w : queues_[p]) need[p] += w.airtime * (w.frames - w.sent);
    return need;
  }
  /// Messages that never went on the air, by priority.
  const std::array<std::uint64_t, kPriorities>& dropped() const { return dropped_; }
  /// One that was given up elsewhere.
  void note_dropped(int priority) { ++dropped_[static_cast<std::size_t>(priority)]; }
  /// The longest that anything has waited.
  Duration oldest(Duration now) const {
    Duration longest{};
    for (const auto& queue : queues_) {
      if (!queue.empty()) longest = std::max(longest, now - queue.front().since);
    }
    return longest;
  }
  /// The longest that anything of each priority has waited.
  std::array<Duration, kPriorities> ages(Duration now) const {
    std::array<Duration, kPriorities> result{};
    for (std::size_t p = 0; p < kPriorities; ++p)
      if (!queues_[p].empty()) result[p] = now - queues_[p].front().since;
    return result;
  }
  void clear() {
    for (auto& queue : queues_) queue.clear();
  }

 private:
  double tokens(std::size_t p, Duration now) {
    const double share = budget_.share[p];
    tokens_[p] = std::min(share * budget_.memory, tokens_[p] + share * seconds(now - counted_[p]));
    counted_[p] = now;
    return tokens_[p];
  }

  Budget budget_;
  std::array<std::deque<Waiting>, kPriorities> queues_{};
  std::array<double, kPriorities> tokens_{};     // airtime, s; below zero: over its share
  std::array<Duration, kPriorities> counted_{};  // when it was last brought up to date
  std::array<std::uint64_t, kPriorities> dropped_{};
};

}  // namespace adit::wire
