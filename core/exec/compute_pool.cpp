// SPDX-License-Identifier: Apache-2.0
#include "core/exec/compute_pool.hpp"

#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <thread>

#include "core/exec/job_queue.hpp"
#include "core/exec/processor_use.hpp"

namespace adit {
namespace {

// Threads of a group that may hang; after that the group gets no more threads.
constexpr std::size_t kMaxHung = 8;
constexpr std::int64_t kLooksPerJob = 4;  // Checks of a job within its watchdog time.

}  // namespace

void lower_priority(int nice) {
  // Linux keeps a nice value per thread.
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), nice);
}

struct ComputePool::Worker {
  std::size_t group{};
  std::thread thread{};
  int system_id{};
  std::shared_ptr<LiveJob> job{};  ///< The job that it runs now.
  std::int64_t looked_at{};        ///< Time of the watchdog's last check, or the start of the job, ns.
  Duration stalled{};              ///< How long the job has run, excluding waits for a processor.
  std::optional<ProcessorUse> use{};
  bool hung{}, exited{};
};

struct ComputePool::State {
  struct Group {
    JobQueue queue;
    std::size_t limit;
    int nice;
    const char* name;
    std::size_t threads{0};  ///< Threads that do not hang.
    std::size_t idle{0};
  };
  explicit State(const LiveParams& p)
      : on_failure(p.on_failure),
        groups{Group{JobQueue(p.compute_queue), static_cast<std::size_t>(p.compute_threads), p.compute_nice,
                     "compute"},
               Group{JobQueue(p.compute_queue), 1, 0, "io"}} {}

  std::size_t hung() const {
    return static_cast<std::size_t>(
        std::count_if(workers.begin(), workers.end(), [](const auto& w) { return w->hung && !w->exited; }));
  }

  std::mutex mutex{};  // Guards the members below.
  std::condition_variable added{}, began{}, exited{};
  FailureHandler on_failure;
  std::array<Group, 2> groups;
  std::vector<std::shared_ptr<Worker>> workers{};
  std::thread watcher{};
  bool watching{false}, stopping{false};
};

ComputePool::ComputePool(const LiveParams& params) : state_(std::make_shared<State>(params)) {}

ComputePool::~ComputePool() { stop(Duration{}); }

Result<void> ComputePool::add(const std::shared_ptr<LiveJob>& job) {
  State& s = *state_;
  JobQueue::Added added;
  {
    const std::lock_guard lock(s.mutex);
    const std::size_t g = job->spec.pool == PoolKind::io ? 1 : 0;
    State::Group& group = s.groups[g];
    const bool may_start = group.threads < group.limit && s.hung() < kMaxHung;
    if (s.stopping)
      added.taken = Error{Reason::cancelled, job->spec.name + ": the runtime has ended"};
    else if (group.threads == 0 && !may_start)
      added.taken = Error{Reason::no_answer, job->spec.name + ": every thread of the pool hangs"};
    else
      added = group.queue.add(job);
    if (added.taken && group.queue.size() > group.idle && may_start) {
      if (!s.watcher.joinable()) s.watcher = std::thread([state = state_] { watch(state); });
      const auto worker = std::make_shared<Worker>();
      worker->group = g;
      worker->thread = std::thread([state = state_, worker] { work(state, *worker); });
      s.workers.push_back(worker);
      ++group.threads;
    }
  }
  if (added.replaced)
    added.replaced->settle(Error{Reason::cancelled, added.replaced->spec.name + ": replaced by a newer one"});
  if (!added.taken)
    job->settle(added.taken.error());
  else
    state_->added.notify_all();
  return added.taken;
}

void ComputePool::work(const std::shared_ptr<State>& state, Worker& worker) {
  State& s = *state;
  State::Group& group = s.groups[worker.group];
  pthread_setname_np(pthread_self(), group.name);
  if (group.nice > 0) lower_priority(group.nice);
  std::unique_lock lock(s.mutex);
  worker.system_id = static_cast<int>(syscall(SYS_gettid));
  while (!worker.hung) {
    ++group.idle;
    s.added.wait(lock, [&] { return s.stopping || group.queue.runnable(); });
    --group.idle;
    if (s.stopping) break;
    worker.job = group.queue.next();
    worker.looked_at = steady_ns();
    worker.stalled = {};
    worker.use.reset();
    if (!s.watching) s.began.notify_one();
    lock.unlock();
    worker.job->run();
    lock.lock();
    group.queue.finished(*worker.job);
    const auto done = std::move(worker.job);  // Its captures are destroyed outside the lock.
    worker.job = nullptr;
    lock.unlock();
    if (!done->spec.lane.empty()) s.added.notify_all();
    lock.lock();
  }
  if (!worker.hung) --group.threads;
  worker.exited = true;
  s.exited.notify_all();
}

void ComputePool::watch(const std::shared_ptr<State>& state) {
  State& s = *state;
  pthread_setname_np(pthread_self(), "compute watch");
  std::unique_lock lock(s.mutex);
  while (!s.stopping) {
    constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
    const auto next_look = [](const Worker& w) {
      const Duration watchdog = std::clamp<Duration>(w.job->spec.watchdog, 100ms, 1h);
      return w.looked_at + watchdog.count() / kLooksPerJob;
    };
    std::int64_t next = kNever;
    for (const auto& w : s.workers)
      if (w->job && !w->hung) next = std::min(next, next_look(*w));
    if (next == kNever) {
      s.began.wait(lock);
      continue;
    }
    s.watching = true;  // A job that begins meanwhile is seen within the shortest watchdog time, 100 ms.
    const std::int64_t now = steady_ns();
    if (next > now) {
      s.began.wait_for(lock, std::min<Duration>(Duration(next - now), 100ms), [&] { return s.stopping; });
      s.watching = false;
      continue;
    }
    s.watching = false;
    std::vector<std::shared_ptr<LiveJob>> hanging, behind;
    for (const auto& w : s.workers) {
      if (!w->job || w->hung || next_look(*w) > now) continue;
      const auto use = processor_use(w->system_id);
      const Duration passed(now - w->looked_at);
      w->stalled += use && w->use ? answerable(*w->use, *use, passed) : passed;
      w->use = use;
      w->looked_at = now;
      if (w->stalled < std::clamp<Duration>(w->job->spec.watchdog, 100ms, 1h)) continue;
      w->hung = true;
      State::Group& group = s.groups[w->group];
      --group.threads;
      hanging.push_back(w->job);
      for (auto& job : group.queue.hangs(w->job)) behind.push_back(std::move(job));
    }
    if (hanging.empty()) continue;
    // Starts another thread for the queued jobs, unless too many hang already.
    std::erase_if(s.workers, [](const auto& w) {
      if (w->exited) w->thread.join();
      return w->exited;
    });
    for (std::size_t g = 0; g < s.groups.size(); ++g) {
      State::Group& group = s.groups[g];
      if (!group.queue.runnable() || group.idle > 0) continue;
      if (group.threads < group.limit && s.hung() <= kMaxHung) {
        const auto worker = std::make_shared<Worker>();
        worker->group = g;
        worker->thread = std::thread([state, worker] { work(state, *worker); });
        s.workers.push_back(worker);
        ++group.threads;
      } else if (group.threads == 0) {
        for (auto& job : group.queue.clear()) behind.push_back(std::move(job));
      }
    }
    lock.unlock();
    for (const auto& job : hanging) {
      job->request_stop();
      job->settle(Error{Reason::no_answer, job->spec.name + ": does not return"});
      if (s.on_failure)
        s.on_failure(job->strand,
                     "job " + job->spec.name + " does not return; another thread takes its place");
    }
    for (const auto& job : behind)
      job->settle(Error{Reason::no_answer, job->spec.name + ": the job before it does not return"});
    hanging.clear();
    behind.clear();
    lock.lock();
  }
}

void ComputePool::stop(Duration limit) {
  State& s = *state_;
  std::vector<std::shared_ptr<LiveJob>> waiting;
  std::vector<std::shared_ptr<Worker>> workers;
  std::thread watcher;
  {
    std::unique_lock lock(s.mutex);
    s.stopping = true;
    for (State::Group& group : s.groups)
      for (auto& job : group.queue.clear()) waiting.push_back(std::move(job));
    for (const auto& w : s.workers)
      if (w->job) w->job->request_stop();
    s.added.notify_all();
    s.began.notify_all();
    const auto all_exited = [&] {
      return std::all_of(s.workers.begin(), s.workers.end(),
                         [](const auto& w) { return w->exited || w->hung; });
    };
    s.exited.wait_for(lock, limit, all_exited);
    workers.swap(s.workers);
    watcher.swap(s.watcher);
    for (const auto& w : workers) w->exited ? w->thread.join() : w->thread.detach();
  }
  if (watcher.joinable()) watcher.join();
  for (const auto& job : waiting)
    job->settle(Error{Reason::cancelled, job->spec.name + ": the runtime has ended"});
}

std::size_t ComputePool::hung() const {
  const std::lock_guard lock(state_->mutex);
  return state_->hung();
}

}  // namespace adit
