// SPDX-License-Identifier: Apache-2.0
#include "core/exec/live_runtime.hpp"

#include <gmock/gmock.h>

#include <future>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace adit {
namespace {

using testing::ElementsAre;

struct LiveFailures {
  std::mutex mutex{};
  std::vector<std::string> lines{};
  std::vector<std::string> seen() {
    const std::lock_guard lock(mutex);
    return lines;
  }
  LiveParams params() {
    LiveParams p;
    p.on_failure = [this](const std::string& strand, const std::string& what) {
      const std::lock_guard lock(mutex);
      lines.push_back(strand + ": " + what);
    };
    return p;
  }
};

/// Waits until the strand has run all that was posted before.
void drain(Executor& strand) {
  std::promise<void> done;
  strand.post([&] { done.set_value(); });
  done.get_future().wait();
}

TEST(LiveRuntime, runs_posts_in_order_on_a_thread_of_its_own) {
  LiveRuntime runtime;
  const auto strand = runtime.strand("main");
  std::vector<int> ran;
  std::thread::id thread;
  for (int i = 0; i < 100; ++i)
    strand->post([&, i] {
      ran.push_back(i);
      thread = std::this_thread::get_id();
    });
  drain(*strand);
  ASSERT_EQ(ran.size(), 100u);
  EXPECT_TRUE(std::is_sorted(ran.begin(), ran.end()));
  EXPECT_NE(thread, std::this_thread::get_id());
}

TEST(LiveRuntime, timers_come_when_due_and_not_before) {
  LiveRuntime runtime;
  const auto strand = runtime.strand("main");
  const Time start = strand->now();
  std::promise<Time> fired;
  const Timer timer = strand->after(20ms, [&] { fired.set_value(strand->now()); });
  EXPECT_GE(fired.get_future().get() - start, 20ms);
}

TEST(LiveRuntime, a_late_period_makes_no_burst) {
  LiveRuntime runtime;
  const auto strand = runtime.strand("main");
  std::vector<Time> beats;
  std::promise<void> done;
  Timer timer;
  strand->post([&] {
    timer = strand->every(2ms, [&] {
      beats.push_back(strand->now());
      if (beats.size() == 1) {  // holds the loop for eight periods
        while (strand->now() - beats[0] < 17ms) {
        }
      }
      if (beats.size() == 5) {
        timer.cancel();
        done.set_value();
      }
    });
  });
  done.get_future().wait();
  drain(*strand);
  EXPECT_EQ(beats.size(), 5u);
  // With a burst the beats after the held one would follow each other at once.
  EXPECT_GE(beats[4] - beats[1], 4ms);
}

TEST(LiveRuntime, cancelled_timers_never_run) {
  LiveRuntime runtime;
  const auto strand = runtime.strand("main");
  bool ran = false;
  std::promise<void> later;
  Timer timer, check;
  strand->post([&] {
    timer = strand->after(1ms, [&] { ran = true; });
    timer.cancel();
    check = strand->after(5ms, [&] { later.set_value(); });
  });
  later.get_future().wait();
  drain(*strand);
  EXPECT_FALSE(ran);
}

TEST(LiveRuntime, drops_counts_and_reports_posts_beyond_the_queue) {
  LiveFailures failures;
  LiveParams params = failures.params();
  params.queue = 10;
  LiveRuntime runtime(params);
  const auto strand = runtime.strand("busy");
  std::promise<void> entered, go;
  int ran = 0;
  strand->post([&] {
    entered.set_value();
    go.get_future().wait();
  });
  entered.get_future().wait();
  for (int i = 0; i < 13; ++i) strand->post([&] { ++ran; });
  go.set_value();
  while (runtime.dropped() != 3) std::this_thread::yield();
  // The queue is empty again at the latest when the strand has taken the ten.
  std::promise<void> done;
  std::function<void()> ask = [&] { done.set_value(); };
  const Timer timer = strand->after(1ms, ask);
  done.get_future().wait();
  drain(*strand);
  EXPECT_EQ(ran, 10);
  EXPECT_THAT(failures.seen(), ElementsAre("busy: queue full, post dropped"));
}

TEST(LiveRuntime, reports_exceptions_of_tasks_timers_and_work_and_goes_on) {
  LiveFailures failures;
  LiveRuntime runtime(failures.params());
  const auto strand = runtime.strand("s");
  strand->post([] { throw std::runtime_error("task"); });
  drain(*strand);
  std::promise<void> second;
  int beats = 0;
  Timer timer = strand->every(1ms, [&] {
    if (++beats == 2) second.set_value();
    if (beats < 2) throw std::runtime_error("timer");
  });
  second.get_future().wait();
  std::promise<Reason> done;
  strand->compute(
      {}, [] { throw std::runtime_error("work"); },
      [&](const Result<void>& result) { done.set_value(result.reason()); });
  while (runtime.failures() < 3) std::this_thread::yield();
  EXPECT_EQ(done.get_future().get(), Reason::internal);
  drain(*strand);
  EXPECT_THAT(failures.seen(), ElementsAre("s: task", "s: timer", "s: compute: work"));
}

TEST(LiveRuntime, compute_runs_elsewhere_and_comes_back) {
  LiveRuntime runtime;
  const auto strand = runtime.strand("s");
  std::thread::id worker, back, own;
  std::promise<void> done;
  strand->post([&] {
    own = std::this_thread::get_id();
    strand->compute(
        {.modelled = 1s}, [&] { worker = std::this_thread::get_id(); },
        [&](const Result<void>&) {
          back = std::this_thread::get_id();
          done.set_value();
        });
  });
  done.get_future().wait();
  EXPECT_EQ(back, own);
  EXPECT_NE(worker, own);
}

TEST(LiveRuntime, dropping_a_strand_joins_and_drops_what_waits) {
  LiveRuntime runtime;
  auto strand = runtime.strand("s");
  const auto captured = std::make_shared<int>(0);
  std::promise<void> entered, go;
  bool finished = false;
  strand->post([&] {
    entered.set_value();
    go.get_future().wait();
    finished = true;
  });
  entered.get_future().wait();
  strand->post([captured] {});
  const Timer timer = strand->after(1h, [captured] {});
  std::thread dropper([&] { strand.reset(); });
  go.set_value();
  dropper.join();
  EXPECT_TRUE(finished);
  EXPECT_EQ(captured.use_count(), 1);
}

TEST(LiveRuntime, a_strand_outlives_its_runtime) {
  LiveFailures failures;
  auto runtime = std::make_unique<LiveRuntime>(failures.params());
  const auto strand = runtime->strand("s");
  runtime.reset();
  int ran = 0;
  strand->post([&] { ++ran; });
  drain(*strand);
  std::promise<Reason> done;
  strand->compute(
      {}, [&] { ++ran; }, [&](const Result<void>& result) { done.set_value(result.reason()); });
  EXPECT_EQ(done.get_future().get(), Reason::cancelled);
  EXPECT_EQ(ran, 1);
}

TEST(LiveRuntime, ends_in_bounded_time_though_work_hangs) {
  // Nothing here is of this frame: the thread stays until the process ends.
  const auto never = std::make_shared<std::promise<void>>();
  const auto entered = std::make_shared<std::promise<void>>();
  auto ended = std::async(std::launch::async, [never, entered] {
    LiveRuntime runtime;
    const auto strand = runtime.strand("s");
    strand->compute(
        {},
        [never, entered] {
          entered->set_value();
          never->get_future().wait();
        },
        [](const Result<void>&) {});
    entered->get_future().wait();
  });
  const bool in_time = ended.wait_for(60s) == std::future_status::ready;
  EXPECT_TRUE(in_time);
  if (!in_time) never->set_value();
}

TEST(LiveRuntime, control_posts_run_though_the_queue_is_full) {
  LiveFailures failures;
  LiveParams params = failures.params();
  params.queue = 1;
  LiveRuntime runtime(params);
  const auto strand = runtime.strand("s");
  std::promise<void> entered, go;
  strand->post([&] {
    entered.set_value();
    go.get_future().wait();
  });
  entered.get_future().wait();
  std::vector<std::string> ran;
  EXPECT_TRUE(strand->post([&] { ran.push_back("post"); }));
  EXPECT_FALSE(strand->post([&] { ran.push_back("dropped"); }));
  EXPECT_TRUE(strand->post_control([&] { ran.push_back("control"); }));
  go.set_value();
  EXPECT_TRUE(strand->drain(10s));
  EXPECT_THAT(ran, ElementsAre("post", "control"));
}

TEST(LiveRuntime, posts_after_the_end_are_refused) {
  LiveRuntime runtime;
  auto strand = runtime.strand("s");
  const auto inbox = strand->inbox();
  std::promise<void> ran;
  EXPECT_TRUE(inbox->post([&] { ran.set_value(); }));
  ran.get_future().wait();
  strand->end();
  EXPECT_FALSE(strand->post([] {}));
  EXPECT_FALSE(strand->post_control([] {}));
  strand.reset();
  EXPECT_FALSE(inbox->post([] {})) << "also when the strand is gone";
}

TEST(LiveRuntime, draining_runs_what_is_queued_and_what_that_posts) {
  LiveRuntime runtime;
  const auto strand = runtime.strand("disk");
  std::promise<void> go;
  std::vector<int> ran;
  strand->post([&] { go.get_future().wait(); });
  for (int i = 0; i < 100; ++i)
    strand->post([&, i] {
      ran.push_back(i);
      if (i == 99) strand->post([&] { ran.push_back(100); });
    });
  std::thread other([&] { go.set_value(); });
  EXPECT_TRUE(strand->drain(10s));
  other.join();
  EXPECT_EQ(ran.size(), 101u);
  EXPECT_FALSE(strand->post([] {}));
  EXPECT_EQ(runtime.left_behind(), 0u);
}

TEST(LiveRuntime, draining_a_strand_that_hangs_is_bounded) {
  // Nothing here is of this frame: the thread stays until the process ends.
  const auto never = std::make_shared<std::promise<void>>();
  LiveRuntime runtime;
  auto strand = runtime.strand("disk");
  strand->post([never] { never->get_future().wait(); });
  EXPECT_FALSE(strand->drain(50ms));
  EXPECT_EQ(runtime.left_behind(), 1u);
  strand.reset();
}

}  // namespace
}  // namespace adit
