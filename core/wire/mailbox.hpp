// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/wire/qos.hpp"

namespace adit::wire {

/// Samples that one reader has received and its strand has not handled yet. Of each sender and key it holds
/// the newest mailbox_depth() samples, and in total a bounded number of samples and bytes: a slow or hung
/// reader loses its oldest samples and needs no more memory. Not thread safe.
template <class Payload>
class Mailbox {
 public:
  struct Entry {
    ParticipantId sender{};
    std::uint64_t key{};  ///< Equal for equal keys.
    Time received{};
    std::size_t bytes{};
    Payload payload{};
  };

  /// `depth`: samples per sender and key; `max_bytes`: largest size of one sample.
  Mailbox(std::size_t depth, std::size_t max_bytes)
      : depth_(depth), max_samples_(kMaxKeys * depth), max_bytes_(std::max(kMinBytes, depth * max_bytes)) {}

  bool empty() const { return waiting_.empty(); }
  /// Adds the newest sample. Calls `overwritten(Entry)` for each sample that is removed for it.
  template <class Overwritten>
  void put(Entry entry, Overwritten overwritten) {
    std::size_t same = 0;
    auto oldest = waiting_.end();
    for (auto at = waiting_.end(); at != waiting_.begin();) {
      --at;
      if (at->key == entry.key && at->sender == entry.sender) ++same, oldest = at;
    }
    if (same >= depth_) drop(oldest, overwritten);
    while (!waiting_.empty() && (waiting_.size() >= max_samples_ || bytes_ + entry.bytes > max_bytes_))
      drop(waiting_.begin(), overwritten);
    bytes_ += entry.bytes;
    waiting_.push_back(std::move(entry));
  }
  /// Removes and returns the oldest sample; the mailbox must not be empty.
  Entry take() {
    Entry entry = std::move(waiting_.front());
    waiting_.erase(waiting_.begin());
    bytes_ -= entry.bytes;
    return entry;
  }
  void clear() {
    waiting_.clear();
    bytes_ = 0;
  }

 private:
  static constexpr std::size_t kMinBytes = 1 << 20;

  template <class Overwritten>
  void drop(typename std::vector<Entry>::iterator at, Overwritten& overwritten) {
    Entry gone = std::move(*at);
    waiting_.erase(at);
    bytes_ -= gone.bytes;
    overwritten(std::move(gone));
  }

  std::size_t depth_, max_samples_, max_bytes_;
  std::vector<Entry> waiting_{};  // Oldest first; usually one entry.
  std::size_t bytes_{};
};

}  // namespace adit::wire
