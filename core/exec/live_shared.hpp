// SPDX-License-Identifier: Apache-2.0
#pragma once
// State that the strands of one LiveRuntime share. Private to core/exec.
#include <memory>

#include "core/exec/compute_pool.hpp"
#include "core/exec/live_runtime.hpp"

namespace adit {

/// A futex word with an absolute deadline on the steady clock: cheaper to wake than a condition variable.
class WakeWord {
 public:
  /// Blocks until woken since the last prepare(), or until the deadline (ns of steady_clock). Owner's thread
  /// only.
  void wait(std::int64_t deadline_ns);
  /// Announces that the owner is about to sleep. The owner's thread calls it before it looks for work a last
  /// time.
  void prepare() { word_.store(1, std::memory_order_seq_cst); }
  void clear() { word_.store(0, std::memory_order_relaxed); }
  /// Wakes the owner, from any thread; makes a system call only when the owner sleeps.
  void wake();

 private:
  std::atomic<std::uint32_t> word_{0};  // 1: sleeping or about to sleep.
};

struct LiveRuntime::Shared {
  explicit Shared(LiveParams p) : params(std::move(p)), pool(params) {}
  void fail(const std::string& strand, const std::string& what) {
    if (params.on_failure) params.on_failure(strand, what);
    // Release order: a thread that reads the count finds the report complete.
    failures.fetch_add(1, std::memory_order_release);
  }
  void drop(const std::string& strand, const std::string& what) {
    // Reports the first loss, then each thousandth: a full queue must not flood the log as well.
    if (dropped.fetch_add(1, std::memory_order_relaxed) % 1000 == 0 && params.on_failure)
      params.on_failure(strand, what);
  }
  LiveParams params;
  std::atomic<std::uint64_t> failures{0};
  std::atomic<std::uint64_t> dropped{0};
  std::atomic<std::uint64_t> left_behind{0};
  ComputePool pool;
};

std::shared_ptr<Strand> make_live_strand(std::shared_ptr<LiveRuntime::Shared> shared, const std::string& name,
                                         bool dedicated);

}  // namespace adit
