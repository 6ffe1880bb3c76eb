// SPDX-License-Identifier: Apache-2.0
#pragma once
// Queue of jobs for the threads of a pool. Private to core/exec.
#include <deque>
#include <memory>
#include <vector>

#include "core/exec/live_job.hpp"

namespace adit {

/// Orders queued jobs by priority, then submission, with lanes and replacement. Its owner locks it.
class JobQueue {
 public:
  explicit JobQueue(std::size_t capacity) : capacity_(capacity) {}

  struct Added {
    Result<void> taken{};               ///< Errors: queue_full; no_answer when a job of the lane hangs.
    std::shared_ptr<LiveJob> replaced;  ///< The caller settles it, outside its lock.
  };
  Added add(std::shared_ptr<LiveJob> job);
  /// Returns the job to run now, or null. Its lane is busy until finished().
  std::shared_ptr<LiveJob> next();
  void finished(const LiveJob& job);
  /// Marks a job as hanging and returns the jobs queued behind it, which never run. New jobs of its lane are
  /// refused until it has finished.
  std::vector<std::shared_ptr<LiveJob>> hangs(const std::shared_ptr<LiveJob>& job);
  /// Removes and returns all queued jobs.
  std::vector<std::shared_ptr<LiveJob>> clear();
  bool runnable() const { return best() != waiting_.size(); }
  std::size_t size() const { return waiting_.size(); }

 private:
  std::size_t best() const;
  bool lane_busy(std::size_t index) const;

  std::size_t capacity_;
  std::deque<std::shared_ptr<LiveJob>> waiting_{};   ///< In the order of submission.
  std::vector<std::shared_ptr<LiveJob>> running_{};  ///< Jobs that occupy a lane.
  std::vector<std::shared_ptr<LiveJob>> hanging_{};  ///< The running jobs that hang.
};

}  // namespace adit
