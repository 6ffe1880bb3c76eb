// SPDX-License-Identifier: Apache-2.0
#pragma once
// The threads that run jobs of one LiveRuntime. Private to core/exec.
#include <memory>

#include "core/exec/live_job.hpp"
#include "core/exec/live_runtime.hpp"

namespace adit {

/// Two groups of threads: low-priority ones for computations, and one group for disk I/O. A thread starts
/// when there is work for it. A watchdog thread checks running jobs: the thread of a job that hangs is
/// replaced, up to a bound, so that other jobs continue.
class ComputePool {
 public:
  explicit ComputePool(const LiveParams& params);
  ~ComputePool();
  ComputePool(const ComputePool&) = delete;
  ComputePool& operator=(const ComputePool&) = delete;

  /// Queues the job, or settles it with the error that it returns: queue_full, no_answer (a job of its lane
  /// hangs, or no thread is left), cancelled (the pool has stopped).
  Result<void> add(const std::shared_ptr<LiveJob>& job);
  /// Cancels the queued jobs, requests running ones to stop, and joins the threads. A thread that does not
  /// end within `limit` is abandoned.
  void stop(Duration limit);
  /// Number of threads whose job hangs now.
  std::size_t hung() const;

 private:
  struct State;
  struct Worker;
  static void work(const std::shared_ptr<State>& state, Worker& worker);
  static void watch(const std::shared_ptr<State>& state);
  std::shared_ptr<State> state_;  ///< Shared with the threads, which may outlive the pool.
};

/// Lowers the priority of the calling thread, which needs no privilege.
void lower_priority(int nice);

}  // namespace adit
