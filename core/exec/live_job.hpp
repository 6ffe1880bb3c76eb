// SPDX-License-Identifier: Apache-2.0
#pragma once
// One job of a live strand. Private to core/exec.
#include <atomic>
#include <mutex>
#include <string>

#include "core/exec/executor.hpp"
#include "core/exec/failure.hpp"

namespace adit {

/// One job from its submission to its completion. The first call of settle() decides the result. Thread safe;
/// `spec` and `strand` do not change.
class LiveJob final : public JobControl, public std::enable_shared_from_this<LiveJob> {
 public:
  /// `on_failure` receives exceptions of the work.
  LiveJob(JobSpec the_spec, JobWork work, JobDone done, std::shared_ptr<Inbox> home, std::string strand_name,
          FailureHandler on_failure);

  /// Starts the deadline's timer on the home strand. Call it before the job is queued.
  void watch_deadline(Executor& home_strand);
  /// Runs the work, unless the job is already settled, and settles the job. Called once.
  void run();
  /// Posts the completion to the home strand. Returns false when the job is already settled.
  bool settle(Result<void> result);
  bool settled() const { return settled_.load(std::memory_order_acquire); }
  void request_stop() { stop_.request_stop(); }
  void cancel() override;

  /// Whether both run in one lane.
  bool shares_lane(const LiveJob& other) const {
    return !spec.lane.empty() && home_ == other.home_ && spec.lane == other.spec.lane;
  }

  const JobSpec spec;
  const std::string strand;

 private:
  JobWork work_;
  JobDone done_;
  std::shared_ptr<Inbox> home_;
  FailureHandler on_failure_;
  std::stop_source stop_{};
  /// Of deadline_: a job that another thread submits may be past its deadline before submit() returns.
  std::mutex deadline_mutex_{};
  Timer deadline_{};  ///< Created before the job is queued; cancelled in the completion on the home strand.
  std::int64_t due_ns_{};  ///< End of the deadline on the steady clock; 0: none.
  std::atomic<bool> settled_{false};
};

/// Current time on the clock of live strands, ns.
std::int64_t steady_ns();

}  // namespace adit
