// SPDX-License-Identifier: Apache-2.0
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

#include "core/exec/fault.hpp"
#include "core/exec/in_place.hpp"
#include "core/exec/job_queue.hpp"
#include "core/exec/live_shared.hpp"
#include "core/exec/processor_use.hpp"

namespace adit {
namespace {

using Alive = std::shared_ptr<std::atomic<bool>>;

// Length of the queue of control posts, beyond the queue of other posts.
constexpr std::size_t kControlQueue = 65536;
constexpr std::size_t kChunk = 32;  // Tasks taken out of the queue at once.

struct Alarm {
  std::int64_t when;
  std::uint64_t order;
  std::int64_t period;
  Task task;
  Alive alive;
};
struct LaterAlarm {
  bool operator()(const Alarm& a, const Alarm& b) const {
    return a.when != b.when ? a.when > b.when : a.order > b.order;
  }
};

/// Queue and loop of one strand. Its thread, its executor and the inboxes of other threads share ownership.
class Loop final : public Inbox {
 public:
  Loop(std::shared_ptr<LiveRuntime::Shared> shared, std::string name)
      : shared_(std::move(shared)), name_(std::move(name)) {}

  bool add(Task task, bool control) override {
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return false;
      if (posted_.size() < (control ? shared_->params.queue + kControlQueue : shared_->params.queue)) {
        posted_.push_back(std::move(task));
        task = nullptr;
      }
    }
    if (task) {
      shared_->drop(name_, control ? "queue full, control post dropped" : "queue full, post dropped");
      return false;
    }
    wake_.wake();
    return true;
  }

  bool try_run(const Task& task) {
    const std::unique_lock running(running_, std::try_to_lock);
    if (!running) return false;
    {
      const std::lock_guard lock(mutex_);
      if (stopping_ || !posted_.empty()) return false;
    }
    static thread_local const int caller = static_cast<int>(syscall(SYS_gettid));
    guest_.store(std::this_thread::get_id(), std::memory_order_relaxed);
    guest_system_id_.store(caller, std::memory_order_relaxed);
    invoke(task);
    guest_system_id_.store(0, std::memory_order_relaxed);
    guest_.store({}, std::memory_order_relaxed);
    return true;
  }

  Timer add_alarm(Duration delay, Duration period, Task task) {
    auto alive = std::make_shared<std::atomic<bool>>(true);
    std::vector<Alarm> dead;  // Destroyed after the lock is released.
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return Timer(std::move(alive));
      alarms_.push_back({steady_ns() + std::max<std::int64_t>(0, delay.count()), order_++, period.count(),
                         std::move(task), alive});
      std::push_heap(alarms_.begin(), alarms_.end(), LaterAlarm{});
      if (alarms_.size() >= sweep_at_) sweep(dead);
      next_alarm_.store(alarms_.front().when, std::memory_order_relaxed);
    }
    if (std::this_thread::get_id() != thread_id_.load(std::memory_order_relaxed)) wake_.wake();
    return Timer(std::move(alive));
  }

  /// Stops the loop: no task runs after the current one. The thread then drops the queued tasks.
  void stop() {
    stop_now_.store(true, std::memory_order_relaxed);
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.wake();
  }

  /// Drops the queued tasks, and those that the thread has taken but not run. Safe to call from any thread.
  void drop() {
    std::deque<Task> posted;  // Destroyed after the lock is released.
    std::vector<Alarm> alarms;
    std::vector<Task> batch;
    const std::scoped_lock lock(mutex_, batch_mutex_);
    posted.swap(posted_);
    alarms.swap(alarms_);
    batch.swap(batch_);
    next_in_batch_ = 0;
    refresh_next();
  }

  /// Returns true when all posts have run and the loop has returned, false when that takes longer than
  /// `limit`.
  bool drain(Duration limit) {
    std::unique_lock lock(mutex_);
    draining_ = true;
    wake_.wake();
    return exited_.wait_for(lock, limit, [this] { return returned_; });
  }

  void run() {
    system_id_.store(static_cast<int>(syscall(SYS_gettid)), std::memory_order_relaxed);
    thread_id_.store(std::this_thread::get_id(), std::memory_order_relaxed);
    pthread_setname_np(pthread_self(), name_.substr(0, 15).c_str());
    std::unique_lock running(running_);
    while (!stop_now_.load(std::memory_order_relaxed)) {
      run_alarms();
      wake_.prepare();
      bool sleep = false, drained = false;
      {
        const std::scoped_lock lock(mutex_, batch_mutex_);
        batch_.clear();
        next_in_batch_ = 0;
        while (!posted_.empty() && batch_.size() < kChunk) {
          batch_.push_back(std::move(posted_.front()));
          posted_.pop_front();
        }
        sleep = batch_.empty() && !stopping_;
        drained = batch_.empty() && draining_;
      }
      if (drained) break;
      if (sleep) {
        running.unlock();  // While this thread sleeps, another thread may run a task for it.
        wake_.wait(next_alarm_.load(std::memory_order_relaxed));
        running.lock();
        continue;
      }
      wake_.clear();
      while (Task task = next_of_batch()) {
        invoke(task);
        task = nullptr;  // Its captures must not live until the next task.
        run_alarms();    // Timers run between tasks, so that a flood of posts does not delay them.
      }
    }
    stop();
    drop();
    const std::lock_guard lock(mutex_);
    returned_ = true;
    exited_.notify_all();
  }

  /// System id of the thread that runs the strand's tasks now; 0: not started.
  int system_id() const {
    const int guest = guest_system_id_.load(std::memory_order_relaxed);
    return guest != 0 ? guest : system_id_.load(std::memory_order_relaxed);
  }
  const std::string& name() const { return name_; }
  const std::shared_ptr<LiveRuntime::Shared>& shared() const { return shared_; }
  bool on_own_thread() const {
    const auto self = std::this_thread::get_id();
    return self == thread_id_.load(std::memory_order_relaxed) ||
           self == guest_.load(std::memory_order_relaxed);
  }

 private:
  /// Returns null at the end of the batch, or when the loop has stopped.
  Task next_of_batch() {
    const std::lock_guard lock(batch_mutex_);
    if (stop_now_.load(std::memory_order_relaxed) || next_in_batch_ >= batch_.size()) return nullptr;
    return std::move(batch_[next_in_batch_++]);
  }

  void invoke(const Task& task) {
    try {
      task();
    } catch (...) {
      shared_->fail(name_, current_exception_text());
    }
  }

  /// Runs the timers that are due; timers created meanwhile run in the next round.
  void run_alarms() {
    const std::int64_t now = steady_ns();
    if (next_alarm_.load(std::memory_order_relaxed) > now) return;
    std::uint64_t made_before = 0;
    {
      const std::lock_guard lock(mutex_);
      made_before = order_;
    }
    for (;;) {
      Alarm alarm{};
      {
        const std::lock_guard lock(mutex_);
        if (alarms_.empty() || alarms_.front().when > now || alarms_.front().order >= made_before) break;
        std::pop_heap(alarms_.begin(), alarms_.end(), LaterAlarm{});
        alarm = std::move(alarms_.back());
        alarms_.pop_back();
        refresh_next();
      }
      if (!alarm.alive->load(std::memory_order_relaxed)) continue;
      if (alarm.period == 0) alarm.alive->store(false, std::memory_order_relaxed);
      invoke(alarm.task);
      if (stop_now_.load(std::memory_order_relaxed)) return;
      if (alarm.period > 0 && alarm.alive->load(std::memory_order_relaxed)) again(std::move(alarm));
    }
  }

  /// Reschedules a periodic timer at its next multiple of the period that is not past: a late run skips beats
  /// and causes no burst.
  void again(Alarm alarm) {
    alarm.when += alarm.period;
    const std::int64_t now = steady_ns();
    if (alarm.when <= now) alarm.when += ((now - alarm.when) / alarm.period + 1) * alarm.period;
    const std::lock_guard lock(mutex_);
    if (stopping_) return;
    alarm.order = order_++;
    alarms_.push_back(std::move(alarm));
    std::push_heap(alarms_.begin(), alarms_.end(), LaterAlarm{});
    refresh_next();
  }

  void refresh_next() {
    next_alarm_.store(alarms_.empty() ? kNever : alarms_.front().when, std::memory_order_relaxed);
  }

  void sweep(std::vector<Alarm>& dead) {
    for (Alarm& alarm : alarms_)
      if (!alarm.alive->load(std::memory_order_relaxed)) dead.push_back(std::move(alarm));
    std::erase_if(alarms_, [](const Alarm& a) { return !a.alive; });
    std::make_heap(alarms_.begin(), alarms_.end(), LaterAlarm{});
    sweep_at_ = std::max<std::size_t>(1024, 2 * alarms_.size());
  }

  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  std::shared_ptr<LiveRuntime::Shared> shared_;
  std::string name_;
  std::atomic<std::thread::id> thread_id_{};
  std::atomic<int> system_id_{0};  // 0: not started.
  std::atomic<bool> stop_now_{false};
  std::atomic<std::int64_t> next_alarm_{kNever};
  WakeWord wake_{};
  std::mutex running_{};                  // Held by the thread that runs a task of this strand.
  std::atomic<std::thread::id> guest_{};  // A foreign thread that runs a task of this strand.
  std::atomic<int> guest_system_id_{0};   // System id of that thread.
  std::mutex batch_mutex_{};              // guards the next two
  std::vector<Task> batch_{};             // Tasks that the thread has taken out of the queue.
  std::size_t next_in_batch_{0};          // The first task that was not run.
  std::mutex mutex_{};                    // Guards the members below.
  std::deque<Task> posted_{};
  std::vector<Alarm> alarms_{};
  std::uint64_t order_{0};
  std::size_t sweep_at_{1024};
  bool stopping_{false}, draining_{false}, returned_{false};
  std::condition_variable exited_{};
};

/// Jobs of a worker strand, which run on its own thread.
struct OwnJobs {
  explicit OwnJobs(std::size_t capacity) : queue(capacity) {}
  std::mutex mutex{};  // Guards the queue.
  JobQueue queue;

  void run_next() {
    std::shared_ptr<LiveJob> job;
    {
      const std::lock_guard lock(mutex);
      job = queue.next();
    }
    if (!job) return;  // It was replaced or cancelled.
    job->run();
    const std::lock_guard lock(mutex);
    queue.finished(*job);
  }
};

class LiveStrand final : public Strand, public OnProcessor, public InPlace, public CanHang {
 public:
  LiveStrand(const std::shared_ptr<Loop>& loop, bool dedicated)
      : Strand(loop),
        loop_(loop),
        own_(dedicated ? std::make_shared<OwnJobs>(loop->shared()->params.compute_queue) : nullptr),
        thread_([loop, dedicated] {
          if (dedicated) lower_priority(loop->shared()->params.compute_nice);
          loop->run();
        }) {}

  ~LiveStrand() override { end(); }

  void end() override {
    loop_->stop();
    if (!thread_.joinable()) return;
    if (loop_->on_own_thread()) {
      // Violates the contract of Runtime::strand; the thread ends after the current task.
      loop_->shared()->fail(loop_->name(), "strand dropped on itself");
      thread_.detach();
    } else {
      thread_.join();
    }
  }

  bool drain(Duration limit) override {
    const bool drained = loop_->drain(limit);
    drained ? end() : abandon();
    return drained;
  }

  void abandon() override {
    loop_->stop();
    if (!thread_.joinable()) return;
    loop_->drop();  // Drops them here, as the thread may never return.
    thread_.detach();
    loop_->shared()->left_behind.fetch_add(1, std::memory_order_relaxed);
  }

  const std::string& name() const override { return loop_->name(); }
  Time now() const override { return Time(Duration(steady_ns())); }
  bool try_run(const Task& task) override {
    const auto loop = loop_;  // The strand may be abandoned meanwhile.
    return loop->try_run(task);
  }
  Timer after(Duration delay, Task task) override { return loop_->add_alarm(delay, 0ns, std::move(task)); }
  Timer every(Duration period, Task task) override {
    const Duration p = std::max(period, Duration(1));
    return loop_->add_alarm(p, p, std::move(task));
  }

  std::optional<ProcessorUse> processor_use() const override {
    const int id = loop_->system_id();
    return id == 0 ? ProcessorUse{.ready = true} : adit::processor_use(id);
  }

  void block() override {
    for (;;) ::pause();
  }

 private:
  JobHandle submit(JobSpec spec, JobWork work, JobDone done) override {
    if (spec.latest_only && spec.lane.empty()) spec.lane = spec.name;
    auto report = [shared = std::weak_ptr(loop_->shared())](const std::string& strand,
                                                            const std::string& what) {
      if (const auto known = shared.lock()) known->fail(strand, what);
    };
    const auto job = std::make_shared<LiveJob>(std::move(spec), std::move(work), std::move(done), loop_,
                                               loop_->name(), std::move(report));
    job->watch_deadline(*this);
    const Result<void> taken = own_ ? add_own(job) : loop_->shared()->pool.add(job);
    if (taken.reason() == Reason::queue_full)
      loop_->shared()->drop(loop_->name(), "compute queue full, job " + job->spec.name + " dropped");
    return JobHandle(job);
  }

  Result<void> add_own(const std::shared_ptr<LiveJob>& job) {
    JobQueue::Added added;
    {
      const std::lock_guard lock(own_->mutex);
      added = own_->queue.add(job);
    }
    if (added.replaced)
      added.replaced->settle(
          Error{Reason::cancelled, added.replaced->spec.name + ": replaced by a newer one"});
    if (added.taken)
      loop_->post_control([own = own_] { own->run_next(); });  // That queue bounds these posts.
    else
      job->settle(added.taken.error());
    return added.taken;
  }

  std::shared_ptr<Loop> loop_;
  std::shared_ptr<OwnJobs> own_;  ///< Null: its jobs run on the pools.
  std::thread thread_;
};

}  // namespace

std::shared_ptr<Strand> make_live_strand(std::shared_ptr<LiveRuntime::Shared> shared, const std::string& name,
                                         bool dedicated) {
  return std::make_shared<LiveStrand>(std::make_shared<Loop>(std::move(shared), name), dedicated);
}

}  // namespace adit
