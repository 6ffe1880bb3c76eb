// SPDX-License-Identifier: Apache-2.0
#include "core/exec/live_runtime.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <ctime>

#include "core/exec/live_shared.hpp"

namespace adit {
namespace {
LiveParams within_bounds(LiveParams p) {
  p.queue = std::clamp<std::size_t>(p.queue, 1, 1'000'000);
  p.compute_threads = std::clamp(p.compute_threads, 1, 16);
  p.compute_queue = std::clamp<std::size_t>(p.compute_queue, 1, 1'000'000);
  p.compute_nice = std::clamp(p.compute_nice, 0, 19);
  p.shutdown = std::clamp<Duration>(p.shutdown, 0ns, 1min);
  return p;
}
}  // namespace

void WakeWord::wait(std::int64_t deadline_ns) {
  timespec deadline{};
  deadline.tv_sec = static_cast<std::time_t>(deadline_ns / 1'000'000'000);
  deadline.tv_nsec = static_cast<long>(deadline_ns % 1'000'000'000);
  // FUTEX_WAIT_BITSET takes an absolute time on CLOCK_MONOTONIC, which is the clock of steady_clock. After
  // any return (woken, timed out, interrupted, word changed) the caller checks again.
  syscall(SYS_futex, &word_, FUTEX_WAIT_BITSET_PRIVATE, 1U, &deadline, nullptr, FUTEX_BITSET_MATCH_ANY);
  clear();
}

void WakeWord::wake() {
  if (word_.exchange(0, std::memory_order_seq_cst) == 1)
    syscall(SYS_futex, &word_, FUTEX_WAKE_PRIVATE, INT_MAX, nullptr, nullptr, 0);
}

LiveRuntime::LiveRuntime(LiveParams params)
    : shared_(std::make_shared<Shared>(within_bounds(std::move(params)))) {}

LiveRuntime::~LiveRuntime() { shared_->pool.stop(shared_->params.shutdown); }

std::shared_ptr<Strand> LiveRuntime::strand(const std::string& name) {
  return make_live_strand(shared_, name, false);
}

std::shared_ptr<Strand> LiveRuntime::dedicated_strand(const std::string& name) {
  return make_live_strand(shared_, name, true);
}

std::uint64_t LiveRuntime::failures() const { return shared_->failures.load(std::memory_order_acquire); }
std::uint64_t LiveRuntime::dropped() const { return shared_->dropped.load(std::memory_order_relaxed); }
std::uint64_t LiveRuntime::left_behind() const {
  return shared_->left_behind.load(std::memory_order_relaxed) + shared_->pool.hung();
}

}  // namespace adit
