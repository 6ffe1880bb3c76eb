#pragma once
// Jobs that wait for a thread. Private to core/exec.
#include <deque>
#include <memory>
#include <vector>

#include "core/exec/live_job.hpp"

namespace adit {

/// Orders waiting jobs by priority, then submission, with lanes and replacement. Its owner locks it.
class JobQueue {
 public:
  explicit JobQueue(std::size_t capacity) : capacity_(capacity) {}

  struct Added {
    Result<void> taken{};               ///< queue_full; no_answer when a job of the lane hangs
    std::shared_ptr<LiveJob> replaced;  ///< To be settled by the caller, outside its lock.
  };
  Added add(std::shared_ptr<LiveJob> job);
  /// The job to run now, null when there is none. Its lane is busy until finished().
  std::shared_ptr<LiveJob> next();
  void finished(const LiveJob& job);
  /// The jobs that wait behind this one, which hangs; they never run. New ones of its lane are refused until
  /// it has finished.
  std::vector<std::shared_ptr<LiveJob>> hangs(const std::shared_ptr<LiveJob>& job);
  /// All that wait.
  std::vector<std::shared_ptr<LiveJob>> clear();
  bool runnable() const { return best() != waiting_.size(); }
  std::size_t size() const { return waiting_.size(); }

 private:
  std::size_t best() const;
  bool lane_busy(std::size_t index) const;

  std::size_t capacity_;
  std::deque<std::shared_ptr<LiveJob>> waiting_{};   ///< In the order of submission.
  std::vector<std::shared_ptr<LiveJob>> running_{};  ///< Those that have a lane.
  std::vector<std::shared_ptr<LiveJob>> hanging_{};  ///< Of the running ones.
};

}  // namespace adit
