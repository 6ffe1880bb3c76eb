// SPDX-License-Identifier: Apache-2.0
// Lanes, replacement, deadlines and cancellation of jobs in rehearsal: all in modelled time.
#include <gmock/gmock.h>

#include "core/exec/virtual_runtime.hpp"

namespace adit {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class VirtualJobs : public testing::Test {
 protected:
  /// Submits a job that returns its number; its end is noted as "NUMBER@ms" or "NUMBER@ms REASON".
  JobHandle submit(int number, JobSpec spec) {
    return strand->compute(
        spec,
        [this, number] {
          began.push_back(number);
          return number;
        },
        [this, number](const Result<int>& result) {
          std::string text = std::to_string(number) + "@" + std::to_string(scheduler.elapsed() / 1ms);
          if (!result) text += " " + std::string(name(result.reason()));
          ended.push_back(text);
        });
  }

  VirtualScheduler scheduler{{.seed = 1, .workers = 1}};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Strand> strand{machine->strand("s")};
  std::vector<int> began{};
  std::vector<std::string> ended{};
};

TEST_F(VirtualJobs, WithoutALaneRunBesideEachOther) {
  submit(1, {.modelled = 10ms});
  submit(2, {.modelled = 10ms});
  scheduler.run_until(1s);
  EXPECT_THAT(ended, ElementsAre("1@10", "2@10"));
}

TEST_F(VirtualJobs, OfOneLaneRunOneAtATime) {
  submit(1, {.modelled = 10ms, .lane = "map"});
  submit(2, {.modelled = 20ms, .lane = "map"});
  submit(3, {.modelled = 5ms, .lane = "other"});
  submit(4, {.modelled = 10ms, .lane = "map"});
  scheduler.run_until(1s);
  EXPECT_THAT(ended, ElementsAre("3@5", "1@10", "2@30", "4@40"));
}

TEST_F(VirtualJobs, LatestOnlyReplacesTheOneThatWaits) {
  for (int i = 1; i <= 4; ++i) submit(i, {.name = "scan", .modelled = 10ms, .latest_only = true});
  scheduler.run_until(1s);
  EXPECT_THAT(ended, ElementsAre("2@0 cancelled", "3@0 cancelled", "1@10", "4@20"));
  EXPECT_THAT(began, ElementsAre(1, 4));
}

TEST_F(VirtualJobs, ADeadlineCountsFromTheSubmission) {
  submit(1, {.modelled = 10ms, .deadline = 10ms, .lane = "map"});  // due at its deadline: it counts
  submit(2, {.modelled = 10ms, .deadline = 15ms, .lane = "map"});
  submit(3, {.modelled = 10ms, .deadline = 9ms, .lane = "map"});
  submit(4, {.modelled = 10ms, .lane = "map"});
  scheduler.run_until(1s);
  EXPECT_THAT(ended, ElementsAre("3@9 no_answer", "1@10", "2@15 no_answer", "4@30"));
  EXPECT_THAT(began, ElementsAre(1, 2, 4)) << "a job whose deadline passed in the queue does not begin";
}

TEST_F(VirtualJobs, ACancelledJobCompletesOnce) {
  const auto running = submit(1, {.modelled = 10ms, .deadline = 1s, .lane = "map"});
  const auto waiting = submit(2, {.modelled = 10ms, .deadline = 1s, .lane = "map"});
  const auto done = submit(3, {.modelled = 1ms});
  const Timer timer = strand->after(5ms, [&] {
    for (const auto& job : {running, waiting, done, running}) job.cancel();
  });
  scheduler.run_until(2s);
  EXPECT_THAT(ended, ElementsAre("3@1", "1@5 cancelled", "2@5 cancelled"));
  EXPECT_THAT(began, testing::Not(testing::Contains(2)));
}

TEST_F(VirtualJobs, TheQueueOfALaneIsBounded) {
  for (int i = 0; i < 258; ++i) submit(i, {.modelled = 1ms, .lane = "map"});
  scheduler.run_until(1s);
  ASSERT_EQ(ended.size(), 258u);
  EXPECT_EQ(ended.front(), "257@0 queue_full");
}

TEST_F(VirtualJobs, NothingCompletesOnAStrandThatEnded) {
  const auto captured = std::make_shared<int>(0);
  for (int i = 0; i < 3; ++i)
    strand->compute(
        {.modelled = 10ms, .deadline = 20ms, .lane = "map"}, [captured] {},
        [captured](const Result<void>&) { FAIL(); });
  const auto handle = submit(9, {.modelled = 10ms, .lane = "map"});
  strand->end();
  handle.cancel();
  scheduler.run_until(1s);
  strand.reset();
  handle.cancel();
  EXPECT_THAT(ended, IsEmpty());
  EXPECT_EQ(captured.use_count(), 1);
}

TEST_F(VirtualJobs, DrainingRunsThePostsThatAreDue) {
  std::vector<int> ran;
  strand->post([&] { strand->post([&] { ran.push_back(3); }); });
  strand->post([&] { ran.push_back(2); });
  const Timer timer = strand->after(1ms, [&] { ran.push_back(4); });
  EXPECT_TRUE(strand->drain(1s));
  EXPECT_THAT(ran, ElementsAre(2, 3));
  EXPECT_FALSE(strand->post([] {}));
  scheduler.run_until(1s);
  EXPECT_EQ(ran.size(), 2u);
}

TEST(VirtualUse, TasksAndComputationsAreReportedByName) {
  std::vector<std::string> used;
  VirtualScheduler scheduler({.workers = 1, .on_use = [&](const auto& strand, const auto& job, Duration) {
                                used.push_back(strand + " " + job);
                              }});
  const auto machine = scheduler.machine("r1", 0s);
  const auto strand = machine->strand("s");
  strand->compute(
      {.name = "plan", .modelled = 10ms}, [] {}, [](const Result<void>&) {});
  scheduler.run_until(1s);
  EXPECT_THAT(used, ElementsAre("r1/s plan", "r1/s ")) << "the work, then its completion";
}

}  // namespace
}  // namespace adit
