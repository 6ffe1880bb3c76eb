#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>

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

class Executor;
[[noreturn]] void hang(Executor& strand);  // core/exec/hang.hpp

/// One strand: runs its tasks one at a time, in the order posted, timers when due. Everything that a
/// component owns is touched from its strand only, so components hold no locks.
class Executor {
 public:
  virtual ~Executor() = default;
  Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  virtual const std::string& name() const = 0;
  /// The machine's clock, read on this strand: constant while a task runs in rehearsal.
  virtual Time now() const = 0;
  /// Runs the task on this strand later. May be called from any thread. The queue is bounded: a post
  /// that does not fit is dropped, counted and logged. The strand must outlive the call.
  virtual void post(Task task) = 0;
  /// Runs the task once, `delay` from now. Called on the strand (or before it runs).
  virtual Timer after(Duration delay, Task task) = 0;
  /// Runs the task every `period`, first one period from now; a late run does not cause a burst.
  virtual Timer every(Duration period, Task task) = 0;
  /// Runs `work` on a pool, beside everything else, then `done` on this strand. `work` must own or share
  /// all that it touches. In rehearsal `done` comes exactly `modelled` later in virtual time, however
  /// long the work takes; live, when the work is done. Work that throws is reported as a failure of the
  /// strand, and `done` does not run.
  virtual void compute(Duration modelled, Task work, Task done) = 0;
  /// Ends the strand: what waits never runs, new work is ignored. Live returns once the task that runs now
  /// has returned. On another strand or thread.
  virtual void end() = 0;
  /// Leaves the strand behind together with the task that it runs now, which may never return: what waits
  /// never runs, new work is ignored, dropping the strand waits for nothing. What that task refers to must
  /// be kept until it has returned. Called on another strand or thread.
  virtual void abandon() = 0;

 private:
  friend void hang(Executor& strand);
  /// Never returns to the task that called it.
  virtual void block() = 0;
};

/// Makes the strands of one machine (an agent, a station, the simulated world).
class Runtime {
 public:
  virtual ~Runtime() = default;
  Runtime() = default;
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;
  /// A new strand; it lives until the pointer is dropped, which must not happen on the strand itself.
  virtual std::shared_ptr<Executor> strand(const std::string& name) = 0;
  /// A strand for heavy work: live its `compute` runs on its own thread, of low priority, so that work that
  /// does not return holds up nobody else and its own timers show it. In rehearsal as any other.
  virtual std::shared_ptr<Executor> worker(const std::string& name) { return strand(name); }
};

}  // namespace adit
