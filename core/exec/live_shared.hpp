#pragma once
// What the strands of one LiveRuntime share. Private to core/exec.
#include <memory>

#include "core/exec/compute_pool.hpp"
#include "core/exec/live_runtime.hpp"

namespace adit {

/// A futex word with an absolute deadline on the steady clock: cheaper to wake than a condition variable.
class WakeWord {
 public:
  /// Owner's thread. Returns when woken since the last prepare(), or at the deadline (ns of steady_clock).
  void wait(std::int64_t deadline_ns);
  /// Owner's thread, before it looks for work a last time.
  void prepare() { word_.store(1, std::memory_order_seq_cst); }
  void clear() { word_.store(0, std::memory_order_relaxed); }
  /// Any thread; a system call only when the owner sleeps.
  void wake();

 private:
  std::atomic<std::uint32_t> word_{0};  // 1: sleeping or about to
};

struct LiveRuntime::Shared {
  explicit Shared(LiveParams p) : params(std::move(p)), pool(params) {}
  void fail(const std::string& strand, const std::string& what) {
    if (params.on_failure) params.on_failure(strand, what);
    failures.fetch_add(1, std::memory_order_release);  // whoever sees the count finds the report made
  }
  void drop(const std::string& strand, const std::string& what) {
    // The first, then each thousandth: a full queue must not flood the log as well.
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
