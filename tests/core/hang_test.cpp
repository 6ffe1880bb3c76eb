// SPDX-License-Identifier: Apache-2.0
#include "core/exec/fault.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <future>
#include <stdexcept>

#include "core/component/component.hpp"
#include "core/exec/live_runtime.hpp"
#include "core/exec/virtual_runtime.hpp"

namespace adit {
namespace {

using testing::ElementsAre;

std::size_t threads_of_this_process() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return static_cast<std::size_t>(std::distance(begin(tasks), end(tasks)));
}

/// True once there are no more than these: the kernel lists a thread a moment longer than join() waits for
/// it.
bool are_gone_but(std::size_t threads) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (threads_of_this_process() > threads) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

/// Counts its destructions: what a hung frame owns.
struct Owned {
  int& gone;
  ~Owned() { ++gone; }
};

TEST(VirtualHang, the_others_go_on_and_the_strand_does_not) {
  VirtualScheduler scheduler(1);
  const auto machine = scheduler.machine("r1", 0s);
  const auto stuck = machine->strand("stuck"), other = machine->strand("other");
  std::vector<double> beats, stuck_beats;
  bool came_back = false;
  const Timer a = other->every(100ms, [&] { beats.push_back(seconds(scheduler.elapsed())); });
  const Timer b = stuck->every(100ms, [&] { stuck_beats.push_back(seconds(scheduler.elapsed())); });
  const Timer c = stuck->after(250ms, [&] {
    hang(*stuck);
    came_back = true;
  });
  scheduler.run_until(400ms);
  stuck->post([&] { came_back = true; });
  scheduler.run_until(500ms);
  EXPECT_THAT(beats, ElementsAre(0.1, 0.2, 0.3, 0.4, 0.5));
  EXPECT_THAT(stuck_beats, ElementsAre(0.1, 0.2));
  EXPECT_EQ(scheduler.elapsed(), 500ms);
  EXPECT_EQ(scheduler.hung(), 1u);
  EXPECT_FALSE(came_back);
}

TEST(VirtualHang, a_hung_frame_stays_where_it_is_and_ends_with_the_scheduler) {
  int gone = 0;
  std::thread([] {}).join();  // the thread sanitizer's own comes with the first
  const std::size_t threads = threads_of_this_process();
  {
    VirtualScheduler scheduler({.seed = 1, .workers = 1});
    const auto machine = scheduler.machine("r1", 0s);
    std::vector<std::shared_ptr<Executor>> strands;
    for (int i = 0; i < 5; ++i) {
      strands.push_back(machine->strand("s"));
      strands.back()->post([&gone, strand = strands.back().get()] {
        const Owned owned{gone};
        hang(*strand);
      });
    }
    strands.erase(strands.begin());  // a hung strand may be dropped
    scheduler.run_until(1s);
    strands.clear();
    EXPECT_EQ(scheduler.hung(), 4u);
    EXPECT_EQ(gone, 0);
    EXPECT_GE(threads_of_this_process(), threads + 4);
  }
  EXPECT_EQ(gone, 4);
  EXPECT_TRUE(are_gone_but(threads));
}

/// A component whose callback hangs, or not.
class Stuck : public Component {
 public:
  using Component::Component;
  void get_stuck() {
    post([this] { hang(executor()); });
  }
};

TEST(VirtualHang, is_no_failure_of_a_component_and_ends_its_beat) {
  HealthState const* seen = nullptr;
  std::shared_ptr<const HealthState> health_state;
  {
    VirtualScheduler scheduler(1);
    const auto machine = scheduler.machine("r1", 5s);
    const auto strand = machine->strand("s"), watcher = machine->strand("w");
    Stuck component("stuck", *strand);
    ASSERT_TRUE(component.start());
    health_state = component.health_state();
    scheduler.run_until(1s);
    EXPECT_TRUE(health_state->health(watcher->now()).healthy);
    component.get_stuck();
    scheduler.run_until(3s);
    EXPECT_FALSE(health_state->health(watcher->now()).healthy);
    EXPECT_GE(health_state->health(watcher->now()).beat_age, 2s);
    seen = health_state.get();
    scheduler.run_until(4s);
  }  // released: the exception passes the component's guard
  EXPECT_EQ(seen->health(Time{}).failures, 0u);
}

TEST(VirtualHang, same_seed_same_run_with_hangs) {
  const auto run = [](std::uint64_t seed) {
    VirtualScheduler scheduler(seed);
    std::string order;
    std::vector<std::unique_ptr<Runtime>> machines;
    std::vector<std::shared_ptr<Executor>> strands;
    std::vector<Timer> timers;
    for (const char* name : {"a", "b", "c", "d"}) {
      machines.push_back(scheduler.machine(name, 0s));
      strands.push_back(machines.back()->strand("s"));
      timers.push_back(strands.back()->every(1ms, [&, name, turns = 0, s = strands.back().get()]() mutable {
        order += name;
        if (++turns == 20 && order.back() != 'd') hang(*s);
      }));
    }
    scheduler.run_until(50ms);
    EXPECT_EQ(scheduler.hung(), 3u);
    return order;
  };
  EXPECT_EQ(run(3), run(3));
  EXPECT_NE(run(3), run(4));
}

TEST(VirtualHang, only_the_running_task_can_hang) {
  std::vector<std::string> failures;
  VirtualScheduler scheduler(
      {.seed = 1, .workers = 1, .on_failure = [&](const std::string&, const std::string& what) {
         failures.push_back(what);
       }});
  const auto machine = scheduler.machine("r1", 0s);
  const auto a = machine->strand("a"), b = machine->strand("b");
  EXPECT_THROW(hang(*a), std::logic_error);
  a->post([&] { hang(*b); });
  a->compute(
      {.modelled = 1ms}, [&] { hang(*a); }, [](const Result<void>&) {});
  scheduler.run_until(1s);
  EXPECT_EQ(failures.size(), 2u);
  EXPECT_EQ(scheduler.hung(), 0u);
}

TEST(VirtualAbandon, nothing_runs_on_a_strand_left_behind) {
  VirtualScheduler scheduler(1);
  const auto machine = scheduler.machine("r1", 0s);
  const auto strand = machine->strand("s");
  int ran = 0;
  const Timer timer = strand->every(1ms, [&] { ++ran; });
  strand->abandon();
  strand->post([&] { ++ran; });
  strand->compute(
      {.modelled = 1ms}, [] {}, [&](const Result<void>&) { ++ran; });
  const Timer late = strand->after(1ms, [&] { ++ran; });
  scheduler.run_until(1s);
  EXPECT_EQ(ran, 0);
}

TEST(LiveHang, a_strand_left_behind_costs_its_thread_and_nothing_else) {
  auto runtime = std::make_unique<LiveRuntime>();
  auto stuck = runtime->strand("stuck");
  const auto other = runtime->strand("other");
  std::promise<void> entered, turned;
  // The thread stays until the process ends, and the strand does not: the task must not touch it.
  stuck->post([&entered] {
    entered.set_value();
    for (;;) ::pause();
  });
  entered.get_future().wait();
  other->post([&] { turned.set_value(); });
  EXPECT_EQ(turned.get_future().wait_for(60s), std::future_status::ready);
  bool ran = false;
  stuck->post([&] { ran = true; });
  stuck->abandon();
  stuck->post([&] { ran = true; });
  EXPECT_EQ(runtime->left_behind(), 1u);
  stuck.reset();  // returns, though its task never will
  runtime.reset();
  EXPECT_FALSE(ran);
}

TEST(LiveAbandon, a_task_that_returns_late_ends_its_thread) {
  LiveRuntime runtime;
  auto strand = runtime.strand("slow");
  std::promise<void> go_on, entered;
  const auto held = std::make_shared<int>(0);
  strand->post([&, go = go_on.get_future().share(), held] {
    entered.set_value();
    go.wait();
  });
  strand->post([held] { ADD_FAILURE() << "ran on a strand that was left behind"; });
  entered.get_future().wait();
  strand->abandon();
  strand.reset();
  EXPECT_GT(held.use_count(), 1);
  go_on.set_value();
  while (held.use_count() > 1) std::this_thread::yield();
}

// Also those that its thread took out of the queue together with the one that never returns.
TEST(LiveAbandon, DropsEveryTaskBehindTheOneThatHangs) {
  LiveRuntime runtime;
  const auto strand = runtime.strand("stuck");
  std::promise<void> gate, entered, go_on;
  const auto held = std::make_shared<int>(0);
  strand->post([open = gate.get_future().share()] { open.wait(); });
  strand->post([&entered, go = go_on.get_future().share()] {
    entered.set_value();
    go.wait();
  });
  for (int i = 0; i < 100; ++i) strand->post([held] {});
  const Timer timer = strand->after(1h, [held] {});
  gate.set_value();
  entered.get_future().wait();
  strand->abandon();
  EXPECT_EQ(held.use_count(), 1);
  EXPECT_FALSE(strand->post([held] {}));
  EXPECT_EQ(held.use_count(), 1);
  go_on.set_value();
}

TEST(LiveWorker, computes_on_its_own_thread) {
  LiveRuntime runtime;
  const auto worker = runtime.dedicated_strand("planner");
  std::thread::id own, worked;
  std::promise<void> done;
  worker->post([&] {
    own = std::this_thread::get_id();
    worker->compute(
        {}, [&] { worked = std::this_thread::get_id(); }, [&](const Result<void>&) { done.set_value(); });
  });
  done.get_future().wait();
  EXPECT_EQ(own, worked);
}

TEST(LiveWorker, work_that_throws_is_a_failure_and_completes_with_an_error) {
  std::promise<std::string> reported, done;
  LiveParams params;
  params.on_failure = [&](const std::string& strand, const std::string& what) {
    reported.set_value(strand + ": " + what);
  };
  LiveRuntime runtime(params);
  const auto worker = runtime.dedicated_strand("planner");
  worker->compute(
      {.name = "plan"}, [] { throw std::runtime_error("no path"); },
      [&](const Result<void>& result) { done.set_value(result.error().text); });
  EXPECT_EQ(reported.get_future().get(), "planner: compute: no path");
  EXPECT_EQ(done.get_future().get(), "plan: no path");
}

}  // namespace
}  // namespace adit
