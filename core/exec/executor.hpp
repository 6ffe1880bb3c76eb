// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "core/exec/job.hpp"
#include "core/time/time.hpp"

namespace adit {

using Task = std::function<void()>;

/// Handle of a scheduled task: a task whose timer is destroyed or cancelled before it ran never runs. Must be
/// cancelled on the strand where it was created.
class [[nodiscard]] Timer {
 public:
  Timer() = default;
  explicit Timer(std::shared_ptr<std::atomic<bool>> alive) : alive_(std::move(alive)) {}
  Timer(Timer&&) = default;
  Timer& operator=(Timer&& other) noexcept {
    if (this != &other) {
      cancel();
      alive_ = std::move(other.alive_);
    }
    return *this;
  }
  ~Timer() { cancel(); }
  void cancel() {
    if (alive_) alive_->store(false, std::memory_order_relaxed);
    alive_.reset();
  }
  /// True until cancelled or, for `after`, until it ran.
  bool active() const { return alive_ && alive_->load(std::memory_order_relaxed); }

 private:
  std::shared_ptr<std::atomic<bool>> alive_{};
};

/// Posts tasks to a strand from any thread. It outlives the strand; posts are then refused.
class Inbox {
 public:
  virtual ~Inbox() = default;
  Inbox() = default;
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  /// Runs the task later on the strand. Returns false when it will never run: the strand has ended, or its
  /// queue is full (counted and reported).
  bool post(Task task) { return add(std::move(task), false); }
  /// The same for tasks that must not be lost because others flood the strand: restarts, completions,
  /// participant events. They have a separate bounded queue that only a defect fills.
  bool post_control(Task task) { return add(std::move(task), true); }

 private:
  virtual bool add(Task task, bool control) = 0;
};

/// Interface of a strand for its components: a loop that runs tasks one at a time, in the order posted, and
/// timers when due. Everything that a component owns is accessed only on its strand, so components need no
/// locks.
class Executor {
 public:
  virtual ~Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  virtual const std::string& name() const = 0;
  /// The machine's clock, read on this strand; in rehearsal it is constant while a task runs.
  virtual Time now() const = 0;

  /// Forwards to the inbox. Safe to call from any thread; the strand must outlive the call.
  bool post(Task task) { return inbox_->post(std::move(task)); }
  bool post_control(Task task) { return inbox_->post_control(std::move(task)); }
  /// The inbox, for objects that may outlive the strand. Safe to call from any thread.
  const std::shared_ptr<Inbox>& inbox() const { return inbox_; }

  /// Runs the task once, `delay` from now. Call it on the strand, or before the strand runs.
  virtual Timer after(Duration delay, Task task) = 0;
  /// Runs the task every `period`, first one period from now; a late run does not cause a burst.
  virtual Timer every(Duration period, Task task) = 0;

  /// Runs `work`, callable as R() or R(std::stop_token), on a thread pool, then `done` on this strand with
  /// Result<R> (work that returns Result<T>: with that). `done` is called exactly once, in a later task,
  /// whatever happens. The reasons of an Error: internal (the work threw, which is also reported as a failure
  /// of the strand), queue_full, no_answer (deadline or watchdog), cancelled (also: replaced by a newer job,
  /// the runtime ends). Only when the strand itself ends first is `done` never called.
  ///
  /// `work` must own or share everything that it accesses. In rehearsal `done` runs exactly JobSpec::modelled
  /// after the start of the job in virtual time, however long the work takes; deadlines and replacements act
  /// on virtual time only, and the stop token of work that has begun is never triggered.
  template <class Work, class Done>
  JobHandle compute(JobSpec spec, Work work, Done done) {
    using Value = job_value_t<Work>;
    if constexpr (std::is_same_v<decltype(run_work(work, std::stop_token{})), void>) {
      return submit(
          std::move(spec),
          [work = std::move(work)](std::stop_token stop) mutable { run_work(work, std::move(stop)); },
          std::move(done));
    } else {
      auto value = std::make_shared<std::optional<Result<Value>>>();
      return submit(
          std::move(spec),
          [value, work = std::move(work)](std::stop_token stop) mutable {
            value->emplace(run_work(work, std::move(stop)));
          },
          [value, done = std::move(done)](Result<void> ended) mutable {
            done(ended ? std::move(**value) : Result<Value>(ended.error()));
          });
    }
  }

 protected:
  explicit Executor(std::shared_ptr<Inbox> inbox) : inbox_(std::move(inbox)) {}

 private:
  virtual JobHandle submit(JobSpec spec, JobWork work, JobDone done) = 0;
  std::shared_ptr<Inbox> inbox_;
};

/// A strand as its owner uses it. Call these functions on another strand or thread.
class Strand : public Executor {
 public:
  /// Ends the strand: queued tasks never run, and new work is refused. Live, it returns once the running task
  /// has returned.
  virtual void end() = 0;
  /// Runs the queued posts and those that they post, then ends the strand; timers no longer run. Returns
  /// false when that takes longer than `limit`: the strand is then abandoned, as by abandon(). For strands
  /// that do I/O.
  virtual bool drain(Duration limit) = 0;
  /// Abandons the strand together with its running task, which may never return: queued tasks are dropped and
  /// never run, new work is refused, and destroying the strand does not wait. Objects that the running task
  /// refers to must live until it has returned.
  virtual void abandon() = 0;

 protected:
  using Executor::Executor;
};

/// Creates the strands of one machine (an agent, a station, the simulated world).
class Runtime {
 public:
  virtual ~Runtime() = default;
  Runtime() = default;
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;
  /// Creates a strand. It lives until the pointer is dropped, which must not happen on the strand itself.
  virtual std::shared_ptr<Strand> strand(const std::string& name) = 0;
  /// Creates a strand for heavy work. Live, its `compute` work runs on its own thread, of low priority: work
  /// that does not return delays no other strand, and stops this strand's timers, which shows the hang. In
  /// rehearsal it is an ordinary strand.
  virtual std::shared_ptr<Strand> dedicated_strand(const std::string& name) { return strand(name); }
};

}  // namespace adit
