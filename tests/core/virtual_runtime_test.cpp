// SPDX-License-Identifier: Apache-2.0
#include "core/exec/virtual_runtime.hpp"

#include <gmock/gmock.h>

#include <stdexcept>
#include <vector>

namespace adit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Failures {
  std::vector<std::string> lines{};
  VirtualParams params(std::uint64_t seed = 1) {
    return {.seed = seed,
            .max_per_instant = 1000,
            .on_failure = [this](const std::string& strand, const std::string& what) {
              lines.push_back(strand + ": " + what);
            }};
  }
};

TEST(VirtualScheduler, runs_posts_in_order_without_time_going_on) {
  VirtualScheduler scheduler(1);
  const auto machine = scheduler.machine("r1", 5s);
  const auto strand = machine->strand("main");
  std::vector<int> ran;
  strand->post([&] {
    ran.push_back(1);
    strand->post([&] { ran.push_back(3); });
  });
  strand->post([&] { ran.push_back(2); });
  scheduler.run_until(0ns);
  EXPECT_THAT(ran, ElementsAre(1, 2, 3));
  EXPECT_EQ(scheduler.elapsed(), 0ns);
  EXPECT_EQ(scheduler.tasks_run(), 3u);
}

TEST(VirtualScheduler, gives_each_machine_its_own_clock) {
  VirtualScheduler scheduler(1);
  const auto a = scheduler.machine("a", 100s);
  const auto b = scheduler.machine("b", 777s);
  const auto sa = a->strand("x");
  const auto sb = b->strand("x");
  Time at_a{}, at_b{};
  const Timer ta = sa->after(2s, [&] { at_a = sa->now(); });
  const Timer tb = sb->after(2s, [&] { at_b = sb->now(); });
  scheduler.run_until(2s);
  EXPECT_EQ(at_a.time_since_epoch(), 102s);
  EXPECT_EQ(at_b.time_since_epoch(), 779s);
  EXPECT_EQ(sa->name(), "a/x");
}

TEST(VirtualScheduler, a_clock_that_jumps_moves_no_timer) {
  VirtualScheduler scheduler(1);
  const auto machine = scheduler.machine("a", 100s);
  const auto other = scheduler.machine("b", 100s);
  const auto before = machine->strand("before"), untouched = other->strand("x");
  Time shown{};
  const Timer timer = before->after(2s, [&] { shown = before->now(); });
  scheduler.run_until(1s);
  scheduler.jump_clock(*machine, 30s);
  const auto later = machine->strand("after");
  EXPECT_EQ(later->now().time_since_epoch(), 131s);
  EXPECT_EQ(untouched->now().time_since_epoch(), 101s);
  scheduler.run_until(1999ms);
  EXPECT_EQ(shown, Time{});
  scheduler.run_until(2s);
  EXPECT_EQ(shown.time_since_epoch(), 132s);
}

TEST(VirtualScheduler, runs_timers_at_their_time_up_to_and_including_the_limit) {
  VirtualScheduler scheduler(1);
  const auto machine = scheduler.machine("r1", 0s);
  const auto strand = machine->strand("main");
  std::vector<double> at;
  const Timer each = strand->every(100ms, [&] { at.push_back(seconds(scheduler.elapsed())); });
  scheduler.run_until(300ms);
  EXPECT_THAT(at, ElementsAre(0.1, 0.2, 0.3));
  scheduler.run_until(399ms);
  EXPECT_EQ(at.size(), 3u);
  EXPECT_EQ(scheduler.elapsed(), 399ms);
}

TEST(VirtualScheduler, cancelled_timers_never_run) {
  VirtualScheduler scheduler(1);
  const auto machine = scheduler.machine("r1", 0s);
  const auto strand = machine->strand("main");
  int once = 0, beats = 0;
  Timer one = strand->after(10ms, [&] { ++once; });
  Timer each{};
  each = strand->every(10ms, [&] {
    if (++beats == 3) each.cancel();
  });
  one.cancel();
  scheduler.run_until(1s);
  EXPECT_EQ(once, 0);
  EXPECT_EQ(beats, 3);
  Timer done = strand->after(1ms, [] {});
  EXPECT_TRUE(done.active());
  scheduler.run_until(2s);
  EXPECT_FALSE(done.active());
}

TEST(VirtualScheduler, keeps_no_heap_of_cancelled_timers) {
  VirtualScheduler scheduler(1);
  const auto machine = scheduler.machine("r1", 0s);
  const auto strand = machine->strand("main");
  const auto captured = std::make_shared<int>(0);
  for (int i = 0; i < 100'000; ++i) {
    Timer timer = strand->after(1h, [captured] {});
    timer.cancel();
  }
  EXPECT_LT(captured.use_count(), 5000);
}

TEST(VirtualScheduler, tasks_of_a_dropped_strand_never_run_and_die_at_once) {
  VirtualScheduler scheduler(1);
  const auto machine = scheduler.machine("r1", 0s);
  auto doomed = machine->strand("doomed");
  const auto captured = std::make_shared<int>(0);
  int ran = 0;
  doomed->post([&ran, captured] { ++ran; });
  const Timer timer = doomed->every(1ms, [&ran, captured] { ++ran; });
  doomed->compute(
      {.modelled = 1ms}, [captured] {}, [&ran, captured](const Result<void>&) { ++ran; });
  doomed.reset();
  scheduler.run_until(1s);
  EXPECT_EQ(ran, 0);
  EXPECT_EQ(captured.use_count(), 1);
}

TEST(VirtualScheduler, a_strand_may_be_dropped_by_a_task_of_the_world) {
  VirtualScheduler scheduler(1);
  const auto machine = scheduler.machine("r1", 0s);
  auto strand = machine->strand("main");
  int beats = 0;
  const Timer timer = strand->every(1s, [&] { ++beats; });
  scheduler.at(3500ms, [&] { strand.reset(); });
  scheduler.run_until(10s);
  EXPECT_EQ(beats, 3);
}

TEST(VirtualScheduler, reports_and_counts_exceptions_and_goes_on) {
  Failures failures;
  VirtualScheduler scheduler(failures.params());
  const auto machine = scheduler.machine("r1", 0s);
  const auto strand = machine->strand("main");
  int beats = 0;
  const Timer timer = strand->every(1s, [&] {
    ++beats;
    throw std::runtime_error("broken");
  });
  strand->post([] { throw 42; });
  scheduler.run_until(2s);
  EXPECT_EQ(beats, 2);
  EXPECT_EQ(scheduler.failures(), 3u);
  EXPECT_THAT(failures.lines, ElementsAre("r1/main: an exception that is no std::exception",
                                          "r1/main: broken", "r1/main: broken"));
}

TEST(VirtualScheduler, refuses_tasks_that_hold_time_for_ever) {
  Failures failures;
  VirtualScheduler scheduler(failures.params());
  const auto machine = scheduler.machine("r1", 0s);
  const auto strand = machine->strand("main");
  std::function<void()> again = [&] { strand->post(again); };
  again();
  try {
    scheduler.run_until(1s);
    FAIL() << "run_until came back";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("r1/main"));
  }
}

TEST(VirtualScheduler, a_task_cannot_run_the_scheduler) {
  Failures failures;
  VirtualScheduler scheduler(failures.params());
  scheduler.at(0s, [&] { scheduler.run_until(1s); });
  scheduler.run_until(2s);
  EXPECT_EQ(scheduler.failures(), 1u);
}

/// Who runs when at 200 instants at which three machines have two tasks each.
std::string interleaving(std::uint64_t seed) {
  VirtualScheduler scheduler(seed);
  std::string log;
  std::vector<std::unique_ptr<Runtime>> machines;
  std::vector<std::shared_ptr<Executor>> strands;
  std::vector<Timer> timers;
  for (const char* name : {"a", "b", "c"}) {
    machines.push_back(scheduler.machine(name, 1s));
    strands.push_back(machines.back()->strand("s"));
    for (const char* turn : {"1", "2"})
      timers.push_back(strands.back()->every(1ms, [&log, name, turn] { (log += name) += turn; }));
  }
  scheduler.run_until(200ms);
  return log;
}

TEST(VirtualScheduler, same_seed_same_order_and_the_seed_explores_orders) {
  const std::string run = interleaving(7);
  EXPECT_EQ(run, interleaving(7));
  EXPECT_NE(run, interleaving(8));
  EXPECT_EQ(run.size(), 200u * 6 * 2);
  int first_a = 0;
  for (std::size_t i = 0; i < run.size(); i += 12) {
    if (run[i] == 'a') ++first_a;
    for (const char* pair : {"a1a2", "b1b2", "c1c2"})  // a machine's own order never changes
      EXPECT_NE(run.substr(i, 12).find(pair), std::string::npos) << run.substr(i, 12);
  }
  EXPECT_GT(first_a, 30);
  EXPECT_LT(first_a, 110);
}

TEST(VirtualScheduler, strands_outlive_it_harmlessly) {
  auto scheduler = std::make_unique<VirtualScheduler>(1);
  const auto machine = scheduler->machine("r1", 0s);
  const auto strand = machine->strand("main");
  const auto captured = std::make_shared<int>(0);
  strand->post([captured] {});
  scheduler.reset();
  strand->post([captured] {});
  EXPECT_EQ(captured.use_count(), 1);
}

}  // namespace
}  // namespace adit
