// SPDX-License-Identifier: Apache-2.0
#include "core/exec/virtual_runtime.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <limits>
#include <map>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/exec/fault.hpp"
#include "core/exec/job_pool.hpp"
#include "core/exec/loop_threads.hpp"
#include "core/exec/processor_use.hpp"
#include "core/time/random.hpp"

namespace adit {
namespace {

using Alive = std::shared_ptr<std::atomic<bool>>;

class VirtualStrand;

/// A scheduled event, in a slot that is reused.
struct Event {
  VirtualStrand* strand{nullptr};
  Task task{};
  Alive alive{};               ///< Null: cannot be cancelled.
  std::int64_t period{0};      ///< 0: once.
  std::shared_ptr<Job> job{};  ///< Finished before the task runs.
  std::uint32_t next_free{0};
};

/// When an event is due. `order` is the machine's rank at that instant, then the posting order.
struct Due {
  std::int64_t when;
  std::uint64_t order;
  std::uint32_t slot;
};
struct Later {
  bool operator()(const Due& a, const Due& b) const {
    return a.when != b.when ? a.when > b.when : a.order > b.order;
  }
};

constexpr std::uint32_t kNoSlot = ~0U;
constexpr int kOrderBits = 48;  // Bits of the posting order: 2^48 events are more than a rehearsal runs.

}  // namespace

struct VirtualScheduler::State {
  explicit State(VirtualParams p) : params(std::move(p)), pool(std::clamp(params.workers, 1, 64) - 1) {}

  void check_thread() const {
    if (std::this_thread::get_id() != thread)
      throw std::logic_error("a strand of a rehearsal was used from another thread");
  }

  std::uint32_t take_slot() {
    if (free_slot == kNoSlot) {
      events.emplace_back();
      return static_cast<std::uint32_t>(events.size() - 1);
    }
    const std::uint32_t slot = free_slot;
    free_slot = events[slot].next_free;
    return slot;
  }

  void release(std::uint32_t slot) {
    Event& event = events[slot];
    event.strand = nullptr;
    event.alive.reset();
    event.job.reset();
    event.next_free = free_slot;
    free_slot = slot;
  }

  void push(std::int64_t when, std::uint64_t machine, std::uint32_t slot) {
    // The rank of a machine at an instant depends only on seed, machine and instant.
    const std::uint64_t place = Random(params.seed ^ (machine * 0xd1342543de82ef95ULL) ^
                                       (static_cast<std::uint64_t>(when) * 0x9e3779b97f4a7c15ULL))
                                    .next() >>
                                kOrderBits;
    heap.push_back({when, (place << kOrderBits) | sequence++, slot});
    std::push_heap(heap.begin(), heap.end(), Later{});
    if (heap.size() >= sweep_at) sweep();
  }

  bool add(VirtualStrand* strand, std::uint64_t machine, std::int64_t when, Task task, Alive alive,
           std::int64_t period, std::shared_ptr<Job> job);

  /// Removes every event that `gone` selects; their captures are destroyed after the heap is consistent
  /// again.
  template <class Gone>
  void remove_if(Gone gone) {
    std::vector<Event> dead;
    std::erase_if(heap, [&](const Due& due) {
      Event& event = events[due.slot];
      if (!gone(event)) return false;
      if (event.job) pool.forget(event.job);
      dead.push_back(std::move(event));
      event.task = nullptr;
      release(due.slot);
      return true;
    });
    std::make_heap(heap.begin(), heap.end(), Later{});
  }

  /// Removes cancelled timers, which stay in the heap until due, so that there are fewer of them than live
  /// ones.
  void sweep() {
    sweep_at = ~std::size_t{0};
    remove_if([](const Event& e) { return e.alive && !e.alive->load(std::memory_order_relaxed); });
    sweep_at = std::max<std::size_t>(4096, 2 * heap.size());
  }

  void fail(const std::string& strand, const std::string& what) {
    ++failures;
    if (params.on_failure) params.on_failure(strand, what);
  }

  bool step(std::int64_t limit);
  void run(std::uint32_t slot);
  void run_until(std::int64_t limit);
  /// Runs the posts of this strand that are due, and those that they post.
  void drain(const VirtualStrand& strand);
  [[noreturn]] void hang(VirtualStrand& strand);

  VirtualParams params;
  JobPool pool;
  LoopThreads loops{};
  std::thread::id thread{std::this_thread::get_id()};
  std::vector<Event> events{};
  std::vector<Due> heap{};
  std::uint32_t free_slot{kNoSlot};
  std::size_t sweep_at{4096};
  std::uint64_t sequence{0};
  std::uint64_t jobs{0};
  std::uint64_t machines{0};
  std::int64_t now{0};
  std::uint64_t at_this_instant{0};
  std::uint64_t tasks{0};
  std::uint64_t failures{0};
  VirtualStrand* running{nullptr};
  bool in_task{false};
  bool closed{false};
};

namespace {

using State = VirtualScheduler::State;

/// Inbox of a virtual strand; it outlives the strand.
class VirtualInbox final : public Inbox {
 public:
  explicit VirtualInbox(std::shared_ptr<State> core) : core_(std::move(core)) {}
  void open(VirtualStrand& strand) { strand_ = &strand; }
  void close() { strand_ = nullptr; }
  VirtualStrand* strand() const { return strand_; }

 private:
  bool add(Task task, bool control) override;
  std::shared_ptr<State> core_;
  VirtualStrand* strand_{nullptr};  ///< Null: the strand is gone.
};

/// A job from its submission to its completion.
struct VirtualJob final : public JobControl, public std::enable_shared_from_this<VirtualJob> {
  void cancel() override;

  JobSpec spec{};
  JobWork work{};
  JobDone done{};
  std::shared_ptr<VirtualInbox> home{};
  std::shared_ptr<Job> job{};  ///< Null: it is queued in its lane.
  std::int64_t due{};          ///< Set when it begins.
  std::stop_source stop{};
  bool settled{false};
};

/// The jobs of one lane: one runs, the others are queued.
struct Lane {
  std::shared_ptr<VirtualJob> running{};
  std::deque<std::shared_ptr<VirtualJob>> waiting{};
};

constexpr std::size_t kLaneQueue = 256;  // Same value as LiveParams::compute_queue.

class VirtualStrand final : public Strand, public CanHang {
 public:
  VirtualStrand(const std::shared_ptr<State>& core, std::uint64_t machine,
                std::shared_ptr<const Duration> offset, std::string name)
      : VirtualStrand(core, std::make_shared<VirtualInbox>(core), machine, std::move(offset),
                      std::move(name)) {}

  ~VirtualStrand() override {
    if (core_->running == this) core_->running = nullptr;
    inbox_->close();
    forget_all();
  }

  const std::string& name() const override { return name_; }
  std::uint64_t machine() const { return machine_; }
  Time now() const override { return Time(*offset_ + Duration(core_->now)); }

  bool take(Task task) {
    core_->check_thread();
    return core_->add(this, machine_, core_->now, std::move(task), nullptr, 0, nullptr);
  }

  Timer after(Duration delay, Task task) override {
    core_->check_thread();
    auto alive = std::make_shared<std::atomic<bool>>(true);
    core_->add(this, machine_, core_->now + std::max<std::int64_t>(0, delay.count()), std::move(task), alive,
               0, nullptr);
    return Timer(std::move(alive));
  }

  Timer every(Duration period, Task task) override {
    core_->check_thread();
    auto alive = std::make_shared<std::atomic<bool>>(true);
    const std::int64_t p = std::max<std::int64_t>(1, period.count());
    core_->add(this, machine_, core_->now + p, std::move(task), alive, p, nullptr);
    return Timer(std::move(alive));
  }

  /// Completes the job in a later task, unless it is already settled.
  void settle(const std::shared_ptr<VirtualJob>& job, Result<void> result) {
    if (std::exchange(job->settled, true)) return;
    take([job, result = std::move(result)]() mutable {
      std::exchange(job->done, nullptr)(std::move(result));
    });
  }
  void cancel(const std::shared_ptr<VirtualJob>& job) {
    core_->check_thread();
    if (job->settled) return;
    leave_lane(job);
    settle(job, Error{Reason::cancelled, job->spec.name + ": cancelled"});
  }

  void end() override {
    over_ = true;
    forget_all();
  }
  bool drain(Duration) override {
    core_->check_thread();
    core_->drain(*this);
    end();
    return true;
  }
  void abandon() override {
    core_->check_thread();
    end();
  }
  void block() override { core_->hang(*this); }
  bool over() const { return over_; }

 private:
  VirtualStrand(const std::shared_ptr<State>& core, const std::shared_ptr<VirtualInbox>& inbox,
                std::uint64_t machine, std::shared_ptr<const Duration> offset, std::string name)
      : Strand(inbox),
        core_(core),
        inbox_(inbox),
        machine_(machine),
        offset_(std::move(offset)),
        name_(std::move(name)) {
    inbox_->open(*this);
  }

  void forget_all() {
    const auto lanes = std::exchange(lanes_, {});
    core_->remove_if([this](const Event& event) { return event.strand == this; });
  }

  JobHandle submit(JobSpec spec, JobWork work, JobDone done) override {
    core_->check_thread();
    if (over_) return {};
    if (spec.latest_only && spec.lane.empty()) spec.lane = spec.name;
    auto job = std::make_shared<VirtualJob>();
    job->spec = std::move(spec);
    job->work = std::move(work);
    job->done = std::move(done);
    job->home = inbox_;
    job->spec.lane.empty() ? begin(job) : enqueue(job);
    if (job->spec.deadline > Duration{} && !job->settled) {
      const std::int64_t at = core_->now + job->spec.deadline.count();
      core_->add(
          this, machine_, at, [this, job] { missed(job); }, nullptr, 0, nullptr);
    }
    return JobHandle(job);
  }

  void enqueue(const std::shared_ptr<VirtualJob>& job) {
    Lane& lane = lanes_[job->spec.lane];
    if (!lane.running) {
      lane.running = job;
      return begin(job);
    }
    if (job->spec.latest_only) {
      const auto older = std::find_if(lane.waiting.begin(), lane.waiting.end(),
                                      [&](const auto& j) { return j->spec.name == job->spec.name; });
      if (older != lane.waiting.end()) {
        const auto replaced = std::exchange(*older, job);
        return settle(replaced, Error{Reason::cancelled, job->spec.name + ": replaced by a newer one"});
      }
    }
    if (lane.waiting.size() >= kLaneQueue)
      return settle(job, Error{Reason::queue_full, job->spec.name + ": too many jobs"});
    lane.waiting.push_back(job);
  }

  void begin(const std::shared_ptr<VirtualJob>& job) {
    job->due = core_->now + std::max<std::int64_t>(0, job->spec.modelled.count());
    Task work = [work = std::move(job->work), stop = job->stop.get_token()] { work(stop); };
    if (core_->params.on_use)
      work = [work = std::move(work), on_use = core_->params.on_use, strand = name_, name = job->spec.name] {
        const Duration before = own_processor_time();
        work();
        on_use(strand, name, own_processor_time() - before);
      };
    job->job = std::make_shared<Job>(std::move(work), job->due, core_->jobs++);
    job->work = nullptr;
    core_->add(
        this, machine_, job->due, [this, job] { finished(job); }, nullptr, 0, job->job);
    core_->pool.add(job->job);
  }

  /// Ends the job at its modelled time: its work is complete, and its lane is free.
  void finished(const std::shared_ptr<VirtualJob>& job) {
    if (!job->spec.lane.empty()) {
      Lane& lane = lanes_[job->spec.lane];
      lane.running = nullptr;
      if (!lane.waiting.empty()) {
        lane.running = std::move(lane.waiting.front());
        lane.waiting.pop_front();
        begin(lane.running);
      }
    }
    Result<void> result{};
    if (job->job->failed) {
      core_->fail(name_, "compute: " + job->job->failure);
      result = Error{Reason::internal, job->spec.name + ": " + job->job->failure};
    }
    if (std::exchange(job->settled, true)) return;
    std::exchange(job->done, nullptr)(std::move(result));
  }

  /// Removes a job that has not begun; it never begins.
  void leave_lane(const std::shared_ptr<VirtualJob>& job) {
    if (const auto lane = lanes_.find(job->spec.lane); !job->job && lane != lanes_.end())
      std::erase(lane->second.waiting, job);
  }

  void missed(const std::shared_ptr<VirtualJob>& job) {
    if (job->settled || (job->job && job->due <= core_->now)) return;
    leave_lane(job);
    job->settled = true;
    std::exchange(job->done,
                  nullptr)(Error{Reason::no_answer, job->spec.name + ": not done by its deadline"});
  }

  std::shared_ptr<State> core_;
  std::shared_ptr<VirtualInbox> inbox_;
  std::uint64_t machine_;
  std::shared_ptr<const Duration> offset_;
  std::string name_;
  std::map<std::string, Lane> lanes_{};
  bool over_{false};
};

bool VirtualInbox::add(Task task, bool) {
  core_->check_thread();
  return strand_ && strand_->take(std::move(task));
}

void VirtualJob::cancel() {
  if (auto* strand = home->strand()) strand->cancel(shared_from_this());
}

class VirtualMachine final : public Runtime {
 public:
  VirtualMachine(std::shared_ptr<State> core, std::uint64_t machine, Duration offset, std::string name)
      : core_(std::move(core)),
        machine_(machine),
        offset_(std::make_shared<Duration>(offset)),
        name_(std::move(name)) {}

  void jump(Duration by) { *offset_ += by; }

  std::shared_ptr<Strand> strand(const std::string& name) override {
    return std::make_shared<VirtualStrand>(core_, machine_, offset_, name_ + "/" + name);
  }

 private:
  std::shared_ptr<State> core_;
  std::uint64_t machine_;
  std::shared_ptr<Duration> offset_;  ///< Shared with its strands.
  std::string name_;
};

}  // namespace

bool VirtualScheduler::State::add(VirtualStrand* strand, std::uint64_t machine, std::int64_t when, Task task,
                                  Alive alive, std::int64_t period, std::shared_ptr<Job> job) {
  if (closed || strand->over()) return false;  // No task will run any more.
  const std::uint32_t slot = take_slot();
  Event& event = events[slot];
  event.strand = strand;
  event.task = std::move(task);
  event.alive = std::move(alive);
  event.period = period;
  event.job = std::move(job);
  push(when, machine, slot);
  return true;
}

bool VirtualScheduler::State::step(std::int64_t limit) {
  while (!heap.empty() && heap.front().when <= limit) {
    const Due due = heap.front();
    std::pop_heap(heap.begin(), heap.end(), Later{});
    heap.pop_back();
    Event& event = events[due.slot];
    if (event.alive && !event.alive->load(std::memory_order_relaxed)) {
      const Task dead = std::move(event.task);
      event.task = nullptr;
      release(due.slot);
      continue;
    }
    if (due.when > now) at_this_instant = 0;
    now = due.when;
    run(due.slot);
    return true;
  }
  return false;
}

void VirtualScheduler::State::run(std::uint32_t slot) {
  // The slot is moved out first: a task may add events, which moves the slots, or destroy its strand.
  const Event& event = events[slot];
  const std::string& strand_name = event.strand->name();
  if (++at_this_instant > params.max_per_instant)
    throw std::runtime_error("strand " + strand_name + ": tasks post each other without time going on");
  ++tasks;
  VirtualStrand* const strand = event.strand;
  const std::int64_t period = event.period;
  Task task = std::move(events[slot].task);
  Alive alive = std::move(events[slot].alive);
  const std::shared_ptr<Job> job = std::move(events[slot].job);
  events[slot].task = nullptr;
  release(slot);

  if (job) pool.finish(job);
  if (alive && period == 0) alive->store(false, std::memory_order_relaxed);
  running = strand;
  in_task = true;
  const Duration before = params.on_use ? own_processor_time() : Duration{};
  try {
    task();
    if (params.on_use && running) params.on_use(strand_name, "", own_processor_time() - before);
  } catch (const HangReleased&) {
    throw;  // The scheduler ends: strand and machine may be gone.
  } catch (...) {
    fail(running ? strand_name : "(dropped)", current_exception_text());
  }
  in_task = false;
  const bool dropped = running == nullptr;
  running = nullptr;
  if (period > 0 && !dropped && alive->load(std::memory_order_relaxed))
    add(strand, strand->machine(), now + period, std::move(task), std::move(alive), period, nullptr);
}

void VirtualScheduler::State::drain(const VirtualStrand& strand) {
  for (;;) {
    const auto is_first = [](const Due& a, const Due& b) {
      return a.when != b.when ? a.when < b.when : a.order < b.order;
    };
    auto first = heap.end();
    for (auto due = heap.begin(); due != heap.end(); ++due) {
      const Event& event = events[due->slot];
      const bool post = event.strand == &strand && !event.alive && !event.job && due->when <= now;
      if (post && (first == heap.end() || is_first(*due, *first))) first = due;
    }
    if (first == heap.end()) return;
    const std::uint32_t slot = first->slot;
    heap.erase(first);
    std::make_heap(heap.begin(), heap.end(), Later{});
    // It may be called within a task of another strand.
    VirtualStrand* const outer = running;
    const bool was_in_task = in_task;
    run(slot);
    running = outer;
    in_task = was_in_task;
  }
}

void VirtualScheduler::State::run_until(std::int64_t limit) {
  const std::function<void()> loop = [this, limit] {
    thread = std::this_thread::get_id();
    while (step(limit)) {
    }
  };
  if (in_task) throw std::logic_error("a task of a rehearsal cannot run the scheduler");
  const auto caller = std::this_thread::get_id();
  try {
    while (!loops.run(loop)) {  // A task hangs and occupies its thread; the loop continues on the next one.
      in_task = false;
      running = nullptr;
    }
  } catch (...) {
    thread = caller;
    throw;
  }
  thread = caller;
}

void VirtualScheduler::State::hang(VirtualStrand& strand) {
  check_thread();
  if (running != &strand) throw std::logic_error("only the task that runs can hang, on its own strand");
  strand.end();
  try {
    loops.hang();
  } catch (...) {
    thread = std::this_thread::get_id();  // The stack frames below may post while they are unwound.
    throw;
  }
}

VirtualScheduler::VirtualScheduler(VirtualParams params)
    : core_(std::make_shared<State>(std::move(params))),
      world_(machine("world", 0ns)),
      world_strand_(world_->strand("events")) {}

VirtualScheduler::VirtualScheduler(std::uint64_t seed) : VirtualScheduler(VirtualParams{.seed = seed}) {}

VirtualScheduler::~VirtualScheduler() {
  core_->closed = true;
  core_->loops.release();
  core_->thread = std::this_thread::get_id();
  core_->remove_if([](const Event&) { return true; });
}

std::unique_ptr<Runtime> VirtualScheduler::machine(std::string name, Duration clock_offset) {
  return std::make_unique<VirtualMachine>(core_, core_->machines++, clock_offset, std::move(name));
}

void VirtualScheduler::jump_clock(Runtime& machine, Duration by) {
  auto* own = dynamic_cast<VirtualMachine*>(&machine);
  if (own == nullptr) throw std::logic_error("only the clock of a rehearsal's machine jumps");
  own->jump(by);
}

void VirtualScheduler::at(Duration when, Task task) {
  auto* strand = static_cast<VirtualStrand*>(world_strand_.get());
  core_->check_thread();
  core_->add(strand, strand->machine(), std::max(when.count(), core_->now), std::move(task), nullptr, 0,
             nullptr);
}

void VirtualScheduler::run_until(Duration when) {
  core_->run_until(when.count());
  if (core_->now < when.count()) core_->at_this_instant = 0;
  core_->now = std::max(core_->now, when.count());
}

Duration VirtualScheduler::elapsed() const { return Duration(core_->now); }
std::uint64_t VirtualScheduler::tasks_run() const { return core_->tasks; }
std::uint64_t VirtualScheduler::failures() const { return core_->failures; }
std::size_t VirtualScheduler::hung() const { return core_->loops.hung(); }

}  // namespace adit
