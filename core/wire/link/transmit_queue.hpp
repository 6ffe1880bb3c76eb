// SPDX-License-Identifier: Apache-2.0
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

/// The transmit queue of a link: messages by priority, each class within its share of the airtime. It
/// proceeds frame by frame, so that an urgent message waits for one frame at most. It has no clock and sends
/// nothing itself: the caller does both. `Item` is the queued message type.
template <class Item>
class TransmitQueue {
 public:
  struct Waiting {
    Item item{};
    std::uint16_t frames{1};  ///< Frames of the message.
    std::uint16_t sent{};     ///< Frames already sent.
    int priority{};
    std::uint64_t supersedes{};  ///< Not 0: replaces a queued message with this number.
    bool again{};                ///< It repeats the replaced message, which then does not count as lost.
    Duration since{};
    Duration max_queue_age{};  ///< Dropped when queued for longer.
    Duration airtime{};        ///< Airtime of one frame, computed when the message was queued; for waiting().
  };

  explicit TransmitQueue(Budget budget = {}) : budget_(budget) {}

  /// Adds a message and returns the one it replaced: a queued message of the same number of which nothing was
  /// sent yet.
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

  /// The next frame to send: its message, its frame number and whether it is the last one. Nothing when the
  /// queue is empty or no class may send yet (see ready()). `airtime(item)` is that of one frame of it;
  /// messages that were queued too long are passed to `drop`.
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

  /// When to call next() again although it returned nothing, because a class waits for its share. Nothing
  /// when the queue is empty.
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
  /// Airtime of the queued messages, by priority.
  std::array<Duration, kPriorities> waiting() const {
    std::array<Duration, kPriorities> need{};
    for (std::size_t p = 0; p < kPriorities; ++p)
      for (const Waiting& w : queues_[p]) need[p] += w.airtime * (w.frames - w.sent);
    return need;
  }
  /// Messages that were never sent, by priority.
  const std::array<std::uint64_t, kPriorities>& dropped() const { return dropped_; }
  /// Counts a message that was dropped elsewhere.
  void note_dropped(int priority) { ++dropped_[static_cast<std::size_t>(priority)]; }
  /// Queueing time of the oldest message.
  Duration oldest(Duration now) const {
    Duration longest{};
    for (const auto& queue : queues_) {
      if (!queue.empty()) longest = std::max(longest, now - queue.front().since);
    }
    return longest;
  }
  /// Queueing time of the oldest message of each priority.
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
  std::array<double, kPriorities> tokens_{};     // Airtime, s; below zero: over its share.
  std::array<Duration, kPriorities> counted_{};  // When the tokens were last updated.
  std::array<std::uint64_t, kPriorities> dropped_{};
};

}  // namespace adit::wire
