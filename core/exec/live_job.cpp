// SPDX-License-Identifier: Apache-2.0
#include "core/exec/live_job.hpp"

#include <utility>

namespace adit {

std::int64_t steady_ns() {
  return std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

LiveJob::LiveJob(JobSpec the_spec, JobWork work, JobDone done, std::shared_ptr<Inbox> home,
                 std::string strand_name, FailureHandler on_failure)
    : spec(std::move(the_spec)),
      strand(std::move(strand_name)),
      work_(std::move(work)),
      done_(std::move(done)),
      home_(std::move(home)),
      on_failure_(std::move(on_failure)) {}

void LiveJob::watch_deadline(Executor& home_strand) {
  if (spec.deadline <= Duration{}) return;
  due_ns_ = steady_ns() + spec.deadline.count();
  Timer deadline = home_strand.after(spec.deadline, [weak = weak_from_this()] {
    const auto job = weak.lock();
    if (!job || job->settled()) return;
    job->request_stop();
    job->settle(Error{Reason::no_answer, job->spec.name + ": not done by its deadline"});
  });
  const std::lock_guard lock(deadline_mutex_);
  deadline_ = std::move(deadline);
}

void LiveJob::run() {
  if (settled()) {
    work_ = nullptr;
    return;
  }
  Result<void> result{};
  try {
    work_(stop_.get_token());
  } catch (...) {
    const std::string text = current_exception_text();
    result = Error{Reason::internal, spec.name + ": " + text};
    on_failure_(strand, "compute: " + text);
  }
  work_ = nullptr;
  if (due_ns_ != 0 && steady_ns() > due_ns_)
    result = Error{Reason::no_answer, spec.name + ": not done by its deadline"};
  settle(std::move(result));
}

bool LiveJob::settle(Result<void> result) {
  if (settled_.exchange(true, std::memory_order_acq_rel)) return false;
  home_->post_control([self = shared_from_this(), result = std::move(result)]() mutable {
    {
      const std::lock_guard lock(self->deadline_mutex_);
      self->deadline_.cancel();
    }
    const JobDone done = std::move(self->done_);
    self->done_ = nullptr;
    done(std::move(result));
  });
  return true;
}

void LiveJob::cancel() {
  request_stop();
  settle(Error{Reason::cancelled, spec.name + ": cancelled"});
}

}  // namespace adit
