// SPDX-License-Identifier: Apache-2.0
// Jobs of live strands: exactly one completion, priorities, replacement, watchdog, a pool for disk I/O.
#include <gmock/gmock.h>

#include <future>
#include <mutex>
#include <thread>

#include "core/exec/live_runtime.hpp"

namespace adit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Work that waits until it is let go, on what outlives this test.
struct Gate {
  std::promise<void> entered{}, go{};
  std::shared_future<void> open{go.get_future().share()};
};

class LiveJobs : public testing::Test {
 protected:
  LiveParams params() {
    LiveParams p;
    p.shutdown = 100ms;
    p.compute_queue = 4;
    p.on_failure = [this](const std::string& who, const std::string& what) {
      const std::lock_guard lock(mutex);
      lines.push_back(who + ": " + what);
    };
    return p;
  }
  /// A job that holds its thread until the gate opens.
  static std::shared_ptr<Gate> hold(Executor& on, JobSpec spec = {}) {
    auto gate = std::make_shared<Gate>();
    on.compute(
        std::move(spec),
        [gate] {
          gate->entered.set_value();
          gate->open.wait();
        },
        [](const Result<void>&) {});
    gate->entered.get_future().wait();
    return gate;
  }
  void note(int number, const Result<void>& result) {
    const std::lock_guard lock(mutex);
    ended.push_back(std::to_string(number) + (result ? "" : " " + std::string(name(result.reason()))));
    changed.notify_all();
  }
  JobHandle submit(int number, JobSpec spec) {
    return strand->compute(
        std::move(spec), [] {}, [this, number](const Result<void>& r) { note(number, r); });
  }
  std::vector<std::string> wait_for(std::size_t count) {
    std::unique_lock lock(mutex);
    EXPECT_TRUE(changed.wait_for(lock, 20s, [&] { return ended.size() >= count; }));
    return ended;
  }

  std::mutex mutex{};
  std::condition_variable changed{};
  std::vector<std::string> lines{}, ended{};
  LiveRuntime runtime{params()};
  std::shared_ptr<Strand> strand{runtime.strand("s")};
};

TEST_F(LiveJobs, ThoseOfHighPriorityGoFirst) {
  const auto gate = hold(*strand);
  submit(1, {.priority = JobPriority::low});
  submit(2, {});
  submit(3, {.priority = JobPriority::high});
  submit(4, {.priority = JobPriority::high});
  gate->go.set_value();
  EXPECT_THAT(wait_for(4), ElementsAre("3", "4", "2", "1"));
}

TEST_F(LiveJobs, JobBeyondTheQueueCompletesWithQueueFull) {
  const auto gate = hold(*strand);
  for (int i = 1; i <= 5; ++i) submit(i, {});
  EXPECT_THAT(wait_for(1), ElementsAre("5 queue_full"));
  EXPECT_EQ(runtime.dropped(), 1u);
  gate->go.set_value();
  EXPECT_EQ(wait_for(5).size(), 5u);
}

TEST_F(LiveJobs, LatestOnlyReplacesTheOneThatWaits) {
  const auto gate = hold(*strand);
  for (int i = 1; i <= 20; ++i) submit(i, {.name = "scan", .latest_only = true});
  wait_for(19);
  gate->go.set_value();
  EXPECT_EQ(wait_for(20).back(), "20");
}

TEST_F(LiveJobs, AWorkersToo) {
  strand = runtime.dedicated_strand("w");
  const auto gate = hold(*strand);
  for (int i = 1; i <= 20; ++i) submit(i, {.name = "scan", .latest_only = true});
  for (int i = 21; i <= 24; ++i) submit(i, {});
  gate->go.set_value();
  const auto seen = wait_for(24);
  EXPECT_EQ(std::count(seen.begin(), seen.end(), "20"), 1);
  EXPECT_EQ(std::count(seen.begin(), seen.end(), "24 queue_full"), 1);
}

TEST_F(LiveJobs, ADeadlineCompletesAJobThatWaitsAndOneThatRuns) {
  // It outlives this test: the job's thread may still be in set_value().
  const auto stopped = std::make_shared<std::promise<bool>>();
  std::atomic<int> completions{0};
  strand->compute(
      {.name = "slow", .deadline = 1s},  // Long enough that it has begun also on a machine with other work.
      [stopped](const std::stop_token& stop) {
        while (!stop.stop_requested()) std::this_thread::yield();
        stopped->set_value(true);
      },
      [&](const Result<void>& r) {
        ++completions;
        note(1, r);
      });
  submit(2, {.deadline = 1ms});
  EXPECT_TRUE(stopped->get_future().get());
  const auto seen = wait_for(2);
  EXPECT_THAT(seen, testing::UnorderedElementsAre("1 no_answer", "2 no_answer"));
  submit(3, {});
  wait_for(3);
  EXPECT_EQ(completions, 1) << "its late end is dropped";
}

TEST_F(LiveJobs, ACancelledJobCompletesOnce) {
  const auto gate = hold(*strand);
  const JobHandle job = submit(1, {});
  strand->post([job] {
    job.cancel();
    job.cancel();
  });
  EXPECT_THAT(wait_for(1), ElementsAre("1 cancelled"));
  gate->go.set_value();
  submit(2, {});
  EXPECT_THAT(wait_for(2), ElementsAre("1 cancelled", "2"));
}

TEST_F(LiveJobs, ASlowDiskHoldsUpNoComputation) {
  const auto gate = hold(*strand, {.pool = PoolKind::io});
  submit(1, {.pool = PoolKind::io});
  submit(2, {});
  EXPECT_THAT(wait_for(1), ElementsAre("2"));
  gate->go.set_value();
  EXPECT_THAT(wait_for(2), ElementsAre("2", "1"));
}

TEST_F(LiveJobs, AJobThatHangsIsReportedAndItsThreadReplaced) {
  const auto gate = hold(*strand, {.name = "loop closure", .watchdog = 100ms, .lane = "map"});
  submit(1, {.lane = "map"});  // it shares what the one that hangs may still use
  submit(2, {});
  EXPECT_THAT(wait_for(2), testing::UnorderedElementsAre("1 no_answer", "2"));
  EXPECT_EQ(runtime.left_behind(), 1u);
  {
    const std::lock_guard lock(mutex);
    EXPECT_THAT(lines, ElementsAre(HasSubstr("job loop closure does not return")));
  }
  submit(3, {.lane = "map"});
  EXPECT_EQ(wait_for(3).back(), "3 no_answer");
  gate->go.set_value();
  while (runtime.left_behind() != 0) std::this_thread::yield();
  submit(4, {.lane = "map"});
  EXPECT_EQ(wait_for(4).back(), "4");
}

TEST_F(LiveJobs, WhenEveryThreadHangsJobsCompleteWithAnError) {
  std::vector<std::shared_ptr<Gate>> gates;
  for (int i = 0; i < 9; ++i) gates.push_back(hold(*strand, {.watchdog = 100ms}));
  while (runtime.left_behind() < 9) std::this_thread::yield();
  submit(1, {});
  EXPECT_THAT(wait_for(1), ElementsAre("1 no_answer"));
  for (const auto& gate : gates) gate->go.set_value();
  while (runtime.left_behind() != 0) std::this_thread::yield();
  submit(2, {});
  EXPECT_EQ(wait_for(2).back(), "2");
}

TEST_F(LiveJobs, TheRuntimesEndCancelsThoseThatWait) {
  auto ending = std::make_unique<LiveRuntime>(params());
  strand = ending->strand("s");
  const auto gate = hold(*strand);
  submit(1, {});
  std::thread opener([&] { gate->go.set_value(); });
  ending.reset();
  opener.join();
  const auto seen = wait_for(1);
  EXPECT_THAT(seen, ElementsAre(testing::AnyOf("1", "1 cancelled")));
  strand->end();
}

}  // namespace
}  // namespace adit
