// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <stdexcept>
#include <thread>
#include <vector>

#include "core/exec/virtual_runtime.hpp"

namespace adit {
namespace {

using testing::ElementsAre;

/// Work that takes some real time, differing from call to call.
double burn(int n) {
  double sum = 0;
  for (int i = 1; i < n * 1000; ++i) sum += 1.0 / i;
  return sum;
}

std::string computed(int workers) {
  VirtualScheduler scheduler({.seed = 3, .workers = workers});
  const auto machine = scheduler.machine("r1", 9s);
  const auto strand = machine->strand("main");
  std::string log;
  int n = 0;
  const Timer timer = strand->every(10ms, [&] {
    const int me = ++n;
    strand->compute(
        {.modelled = 1ms * (1 + me * 7 % 13)}, [me] { return burn(me * 5 % 17); },
        [&, me](const Result<double>& result) {
          log += std::to_string(me) + "@" + std::to_string(scheduler.elapsed().count()) + "=" +
                 std::to_string(*result) + " ";
        });
  });
  scheduler.run_until(500ms);
  return log;
}

TEST(VirtualCompute, completes_exactly_at_its_modelled_time) {
  VirtualScheduler scheduler(1);
  const auto machine = scheduler.machine("r1", 0s);
  const auto strand = machine->strand("main");
  Duration done_at{};
  const Timer start = strand->after(1s, [&] {
    strand->compute(
        {.modelled = 30ms}, [] { return burn(3); },
        [&](const Result<double>& result) {
          done_at = scheduler.elapsed();
          EXPECT_GT(*result, 7.0);
        });
  });
  scheduler.run_until(2s);
  EXPECT_EQ(done_at, 1030ms);
}

TEST(VirtualCompute, the_number_of_workers_changes_nothing) {
  const std::string one = computed(1);
  EXPECT_FALSE(one.empty());
  EXPECT_EQ(one, computed(2));
  EXPECT_EQ(one, computed(4));
}

TEST(VirtualCompute, work_that_throws_is_reported_at_its_time_and_completes_with_an_error) {
  std::vector<std::string> lines;
  VirtualScheduler scheduler(
      {.seed = 1, .on_failure = [&](const std::string& strand, const std::string& what) {
         lines.push_back(strand + ": " + what);
       }});
  const auto machine = scheduler.machine("r1", 0s);
  const auto strand = machine->strand("plan");
  std::vector<std::string> done;
  strand->compute(
      {.name = "plan", .modelled = 1s}, [] { throw std::runtime_error("no path"); },
      [&](const Result<void>& result) { done.push_back(result.error().text); });
  scheduler.run_until(999ms);
  EXPECT_TRUE(lines.empty());
  scheduler.run_until(1s);
  EXPECT_THAT(lines, ElementsAre("r1/plan: compute: no path"));
  EXPECT_THAT(done, ElementsAre("plan: no path"));
}

TEST(VirtualCompute, work_cannot_touch_a_strand) {
  std::vector<std::string> lines;
  VirtualScheduler scheduler(
      {.seed = 1, .workers = 2, .on_failure = [&](const std::string&, const std::string& w) {
         lines.push_back(w);
       }});
  const auto machine = scheduler.machine("r1", 0s);
  const auto strand = machine->strand("main");
  std::exception_ptr caught;
  std::thread other([&] {
    try {
      strand->post([] {});
    } catch (const std::logic_error&) {
      caught = std::current_exception();
    }
  });
  other.join();
  EXPECT_TRUE(caught);
}

TEST(VirtualCompute, the_scheduler_can_go_while_work_waits) {
  const auto captured = std::make_shared<int>(0);
  {
    VirtualScheduler scheduler({.seed = 1, .workers = 3});
    const auto machine = scheduler.machine("r1", 0s);
    const auto strand = machine->strand("main");
    for (int i = 0; i < 50; ++i)
      strand->compute(
          {.modelled = 1s}, [captured] { burn(5); }, [captured](const Result<void>&) {});
  }
  EXPECT_EQ(captured.use_count(), 1);
}

}  // namespace
}  // namespace adit
