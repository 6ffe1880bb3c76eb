// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/exec/executor.hpp"

namespace adit {

/// One piece of `compute` work of the virtual scheduler.
struct Job {
  enum class State { queued, running, finished };
  Job(Task the_work, std::int64_t due_ns, std::uint64_t number)
      : work(std::move(the_work)), due(due_ns), sequence(number) {}
  Task work;
  std::int64_t due;        ///< Virtual time at which the result is needed.
  std::uint64_t sequence;  ///< Breaks ties.
  State state{State::queued};
  bool failed{false};
  std::string failure{};
};

/// Threads that run jobs in the order in which their results are needed. The thread that needs a result
/// helps.
class JobPool {
 public:
  /// `threads`: besides the calling one; 0: every job runs when its result is needed.
  explicit JobPool(int threads);
  ~JobPool();
  JobPool(const JobPool&) = delete;
  JobPool& operator=(const JobPool&) = delete;

  void add(std::shared_ptr<Job> job);
  /// Returns when the job has finished: runs it here when no thread has begun it, else runs other jobs
  /// meanwhile.
  void finish(const std::shared_ptr<Job>& job);
  /// Drops a job that no thread has begun; a running one continues, but its result is ignored.
  void forget(const std::shared_ptr<Job>& job);

 private:
  struct Earlier {
    bool operator()(const std::shared_ptr<Job>& a, const std::shared_ptr<Job>& b) const {
      return a->due != b->due ? a->due < b->due : a->sequence < b->sequence;
    }
  };
  void loop();
  void run(std::shared_ptr<Job> job, std::unique_lock<std::mutex>& lock);

  std::mutex mutex_{};
  std::condition_variable added_{};
  std::condition_variable finished_{};
  std::set<std::shared_ptr<Job>, Earlier> queue_{};
  bool stopping_{false};
  std::vector<std::thread> threads_{};
};

}  // namespace adit
