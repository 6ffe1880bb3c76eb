#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

#include "core/exec/live_shared.hpp"
#include "core/exec/processor_use.hpp"

namespace adit {
namespace {

using Alive = std::shared_ptr<std::atomic<bool>>;

std::int64_t steady_ns() {
  return std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Alarm {
  std::int64_t when;
  std::uint64_t order;
  std::int64_t period;
  Task task;
  Alive alive;
};
struct Later {
  bool operator()(const Alarm& a, const Alarm& b) const {
    return a.when != b.when ? a.when > b.when : a.order > b.order;
  }
};

/// Queue and loop of one strand, owned by its thread and by the executor.
class Loop {
 public:
  Loop(std::shared_ptr<LiveRuntime::Shared> shared, std::string name)
      : shared_(std::move(shared)), name_(std::move(name)) {}

  void post(Task task, bool always) {
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return;
      if (always || posted_.size() < shared_->params.queue) {
        posted_.push_back(std::move(task));
        task = nullptr;
      }
    }
    if (task) return shared_->drop(name_, "queue full, post dropped");
    wake_.wake();
  }

  Timer add_alarm(Duration delay, Duration period, Task task) {
    auto alive = std::make_shared<std::atomic<bool>>(true);
    std::vector<Alarm> dead;  // dies after the lock
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return Timer(std::move(alive));
      alarms_.push_back({steady_ns() + std::max<std::int64_t>(0, delay.count()), order_++, period.count(),
                         std::move(task), alive});
      std::push_heap(alarms_.begin(), alarms_.end(), Later{});
      if (alarms_.size() >= sweep_at_) sweep(dead);
      next_alarm_.store(alarms_.front().when, std::memory_order_relaxed);
    }
    if (std::this_thread::get_id() != thread_id_.load(std::memory_order_relaxed)) wake_.wake();
    return Timer(std::move(alive));
  }

  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    stop_now_.store(true, std::memory_order_relaxed);
    wake_.wake();
  }

  void run() {
    system_id_.store(static_cast<int>(syscall(SYS_gettid)), std::memory_order_relaxed);
    thread_id_.store(std::this_thread::get_id(), std::memory_order_relaxed);
    pthread_setname_np(pthread_self(), name_.substr(0, 15).c_str());
    std::vector<Task> batch;
    while (!stop_now_.load(std::memory_order_relaxed)) {
      run_alarms();
      wake_.prepare();
      bool sleep = false;
      {
        const std::lock_guard lock(mutex_);
        batch.swap(posted_);
        sleep = batch.empty() && !stopping_;
      }
      if (sleep) {
        wake_.wait(next_alarm_.load(std::memory_order_relaxed));
        continue;
      }
      wake_.clear();
      for (Task& task : batch) {
        if (stop_now_.load(std::memory_order_relaxed)) break;
        invoke(task);
        task = nullptr;
        run_alarms();  // a flood of posts must not hold timers up
      }
      batch.clear();
    }
    // What waits is dropped here, on the strand's own thread, outside the lock.
    std::vector<Alarm> alarms;
    const std::lock_guard lock(mutex_);
    batch.swap(posted_);
    alarms.swap(alarms_);
  }

  int system_id() const { return system_id_.load(std::memory_order_relaxed); }
  const std::string& name() const { return name_; }
  LiveRuntime::Shared& shared() { return *shared_; }
  bool on_own_thread() const {
    return std::this_thread::get_id() == thread_id_.load(std::memory_order_relaxed);
  }

 private:
  void invoke(Task& task) {
    try {
      task();
    } catch (...) {
      shared_->fail(name_, current_exception_text());
    }
  }

  /// Runs what is due now; alarms made meanwhile wait for the next round.
  void run_alarms() {
    std::int64_t now = steady_ns();
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
        std::pop_heap(alarms_.begin(), alarms_.end(), Later{});
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

  /// The next instant of its raster that is not past: a late run costs beats, it makes no burst.
  void again(Alarm alarm) {
    alarm.when += alarm.period;
    const std::int64_t now = steady_ns();
    if (alarm.when <= now) alarm.when += ((now - alarm.when) / alarm.period + 1) * alarm.period;
    const std::lock_guard lock(mutex_);
    alarm.order = order_++;
    alarms_.push_back(std::move(alarm));
    std::push_heap(alarms_.begin(), alarms_.end(), Later{});
    refresh_next();
  }

  void refresh_next() {
    next_alarm_.store(alarms_.empty() ? never : alarms_.front().when, std::memory_order_relaxed);
  }

  void sweep(std::vector<Alarm>& dead) {
    for (Alarm& alarm : alarms_)
      if (!alarm.alive->load(std::memory_order_relaxed)) dead.push_back(std::move(alarm));
    std::erase_if(alarms_, [](const Alarm& a) { return !a.alive; });
    std::make_heap(alarms_.begin(), alarms_.end(), Later{});
    sweep_at_ = std::max<std::size_t>(1024, 2 * alarms_.size());
  }

  static constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();
  std::shared_ptr<LiveRuntime::Shared> shared_;
  std::string name_;
  std::atomic<std::thread::id> thread_id_{};
  std::atomic<int> system_id_{0};  // 0: does not run yet
  std::atomic<bool> stop_now_{false};
  std::atomic<std::int64_t> next_alarm_{never};
  WakeWord wake_{};
  std::mutex mutex_{};  // guards what follows
  std::vector<Task> posted_{};
  std::vector<Alarm> alarms_{};
  std::uint64_t order_{0};
  std::size_t sweep_at_{1024};
  bool stopping_{false};
};

class LiveStrand final : public Executor, public OnProcessor {
 public:
  LiveStrand(std::shared_ptr<LiveRuntime::Shared> shared, const std::string& name, bool heavy)
      : loop_(std::make_shared<Loop>(std::move(shared), name)), heavy_(heavy), thread_([loop = loop_, heavy] {
          if (heavy) lower_priority(loop->shared().params.compute_nice);
          loop->run();
        }) {}

  ~LiveStrand() override { end(); }

  void end() override {
    loop_->stop();
    if (!thread_.joinable()) return;
    if (loop_->on_own_thread()) {
      // Against the contract of Runtime::strand; the thread ends after the task that runs now.
      loop_->shared().fail(loop_->name(), "strand dropped on itself");
      thread_.detach();
    } else {
      thread_.join();
    }
  }

  const std::string& name() const override { return loop_->name(); }
  Time now() const override { return Time(Duration(steady_ns())); }
  void post(Task task) override { loop_->post(std::move(task), false); }
  Timer after(Duration delay, Task task) override { return loop_->add_alarm(delay, 0ns, std::move(task)); }
  Timer every(Duration period, Task task) override {
    const Duration p = std::max(period, Duration(1));
    return loop_->add_alarm(p, p, std::move(task));
  }

  void compute(Duration /*modelled*/, Task work, Task done) override {
    auto job = [weak = std::weak_ptr<Loop>(loop_), work = std::move(work), done = std::move(done)]() mutable {
      std::string failure;
      try {
        work();
      } catch (...) {
        failure = current_exception_text();
      }
      work = nullptr;
      const auto loop = weak.lock();
      if (!loop) return;
      if (!failure.empty()) return loop->shared().fail(loop->name(), "compute: " + failure);
      loop->post(std::move(done), true);  // bounded by the compute queue
    };
    if (heavy_)
      loop_->post(std::move(job), false);
    else if (!loop_->shared().pool.add(std::move(job)))
      loop_->shared().drop(loop_->name(), "compute queue full, work dropped");
  }

  void abandon() override {
    loop_->stop();
    if (!thread_.joinable()) return;
    thread_.detach();
    loop_->shared().left_behind.fetch_add(1, std::memory_order_relaxed);
  }

  std::optional<ProcessorUse> processor_use() const override {
    const int id = loop_->system_id();
    return id == 0 ? ProcessorUse{.ready = true} : adit::processor_use(id);
  }

 private:
  void block() override {
    for (;;) ::pause();
  }

  std::shared_ptr<Loop> loop_;
  bool heavy_;
  std::thread thread_;
};

}  // namespace

std::shared_ptr<Executor> make_live_strand(std::shared_ptr<LiveRuntime::Shared> shared,
                                           const std::string& name, bool heavy) {
  return std::make_shared<LiveStrand>(std::move(shared), name, heavy);
}

}  // namespace adit
