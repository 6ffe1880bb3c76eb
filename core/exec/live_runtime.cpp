#include "core/exec/live_runtime.hpp"

#include <linux/futex.h>
#include <pthread.h>
#include <sys/resource.h>
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
  return p;
}
}  // namespace

void WakeWord::wait(std::int64_t deadline_ns) {
  timespec deadline{};
  deadline.tv_sec = static_cast<std::time_t>(deadline_ns / 1'000'000'000);
  deadline.tv_nsec = static_cast<long>(deadline_ns % 1'000'000'000);
  // FUTEX_WAIT_BITSET takes an absolute time on CLOCK_MONOTONIC, which is what steady_clock reads.
  // Any return (woken, timed out, interrupted, word changed) makes the caller look again.
  syscall(SYS_futex, &word_, FUTEX_WAIT_BITSET_PRIVATE, 1U, &deadline, nullptr, FUTEX_BITSET_MATCH_ANY);
  clear();
}

void WakeWord::wake() {
  if (word_.exchange(0, std::memory_order_seq_cst) == 1)
    syscall(SYS_futex, &word_, FUTEX_WAKE_PRIVATE, INT_MAX, nullptr, nullptr, 0);
}

void lower_priority(int nice) {
  // Linux keeps a nice value per thread.
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), nice);
}

ComputePool::ComputePool(int threads, std::size_t capacity, int nice) : capacity_(capacity) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this, nice] { loop(nice); });
}

ComputePool::~ComputePool() { stop(); }

bool ComputePool::add(Task task) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_ || queue_.size() >= capacity_) return false;
    queue_.push_back(std::move(task));
  }
  added_.notify_one();
  return true;
}

void ComputePool::stop() {
  std::deque<Task> waiting;  // dies after the lock
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    waiting.swap(queue_);
  }
  added_.notify_all();
  for (auto& thread : threads_)
    if (thread.joinable()) thread.join();
}

void ComputePool::loop(int nice) {
  pthread_setname_np(pthread_self(), "compute");
  lower_priority(nice);
  std::unique_lock lock(mutex_);
  for (;;) {
    added_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
    if (stopping_) return;
    Task task = std::move(queue_.front());
    queue_.pop_front();
    lock.unlock();
    task();
    task = nullptr;
    lock.lock();
  }
}

LiveRuntime::LiveRuntime(LiveParams params)
    : shared_(std::make_shared<Shared>(within_bounds(std::move(params)))) {}

LiveRuntime::~LiveRuntime() { shared_->pool.stop(); }

std::shared_ptr<Executor> LiveRuntime::strand(const std::string& name) {
  return make_live_strand(shared_, name, false);
}

std::shared_ptr<Executor> LiveRuntime::worker(const std::string& name) {
  return make_live_strand(shared_, name, true);
}

std::uint64_t LiveRuntime::failures() const { return shared_->failures.load(std::memory_order_acquire); }
std::uint64_t LiveRuntime::dropped() const { return shared_->dropped.load(std::memory_order_relaxed); }
std::uint64_t LiveRuntime::left_behind() const {
  return shared_->left_behind.load(std::memory_order_relaxed);
}

}  // namespace adit
