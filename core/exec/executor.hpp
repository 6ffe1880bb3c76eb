#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "core/exec/job.hpp"
#include "core/time/time.hpp"

namespace adit {

using Task = std::function<void()>;

/// Keeps a scheduled task alive: destroying or cancelling it before it ran means that it never runs.
/// Must be cancelled on the strand it was made on.
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

/// Posts to a strand from any thread, also after the strand is gone: posts are refused then.
class Inbox {
 public:
  virtual ~Inbox() = default;
  Inbox() = default;
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  /// Runs the task on the strand later. False when it never will: the strand has ended, or its queue is full
  /// (counted and reported).
  bool post(Task task) { return add(std::move(task), false); }
  /// The same for what must not be lost because others flood the strand: restarts, completions, participant
  /// events. Not bounded by the queue of post(), but by one of its own that only a defect fills.
  bool post_control(Task task) { return add(std::move(task), true); }

 private:
  virtual bool add(Task task, bool control) = 0;
};

/// What a component needs of its strand: a loop that runs its tasks one at a time, in the order posted,
/// timers when due. Everything that a component owns is touched from its strand only, so components hold no
/// locks.
class Executor {
 public:
  virtual ~Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  virtual const std::string& name() const = 0;
  /// The machine's clock, read on this strand: constant while a task runs in rehearsal.
  virtual Time now() const = 0;

  /// Those of the inbox. May be called from any thread; the strand must outlive the call.
  bool post(Task task) { return inbox_->post(std::move(task)); }
  bool post_control(Task task) { return inbox_->post_control(std::move(task)); }
  /// For those that may outlive the strand. Any thread.
  const std::shared_ptr<Inbox>& inbox() const { return inbox_; }

  /// Runs the task once, `delay` from now. Called on the strand (or before it runs).
  virtual Timer after(Duration delay, Task task) = 0;
  /// Runs the task every `period`, first one period from now; a late run does not cause a burst.
  virtual Timer every(Duration period, Task task) = 0;

  /// Runs `work`, callable as R() or R(std::stop_token), on a pool, beside everything else, then `done` on
  /// this strand with Result<R> (work that returns Result<T>: with that). `done` is called exactly once, in a
  /// later task, whatever happens; an Error says what: internal (the work threw, which is reported as a
  /// failure of the strand, too), queue_full, no_answer (deadline or watchdog), cancelled (also: replaced by
  /// a newer job, the runtime ends). Only when the strand itself ends first is it never called.
  ///
  /// `work` must own or share all that it touches. In rehearsal `done` comes exactly JobSpec::modelled after
  /// the job's begin in virtual time, however long the work takes, deadlines and replacements act on virtual
  /// time alone, and the stop token of work that has begun is never triggered.
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

/// A strand as its owner sees it. The functions are called on another strand or thread.
class Strand : public Executor {
 public:
  /// Ends the strand: queued tasks never run, new work is refused. Live returns once the task that runs now
  /// has returned.
  virtual void end() = 0;
  /// Runs the posts that are queued, and those that they post, then ends the strand; timers no longer run.
  /// False when that took longer than `limit`: the strand is left behind then, as by abandon(). For strands
  /// that do I/O.
  virtual bool drain(Duration limit) = 0;
  /// Leaves the strand behind together with the task that it runs now, which may never return: queued tasks
  /// never run and are dropped, new work is refused, dropping the strand waits for nothing. What that task
  /// refers to must live until it has returned.
  virtual void abandon() = 0;

 protected:
  using Executor::Executor;
};

/// Makes the strands of one machine (an agent, a station, the simulated world).
class Runtime {
 public:
  virtual ~Runtime() = default;
  Runtime() = default;
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;
  /// A new strand; it lives until the pointer is dropped, which must not happen on the strand itself.
  virtual std::shared_ptr<Strand> strand(const std::string& name) = 0;
  /// A strand for heavy work: live its `compute` runs on its own thread, of low priority, so that work that
  /// does not return holds up no other strand and its own timers show it. In rehearsal as any other.
  virtual std::shared_ptr<Strand> dedicated_strand(const std::string& name) { return strand(name); }
};

}  // namespace adit
