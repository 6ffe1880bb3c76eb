// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <algorithm>
#include <future>
#include <thread>
#include <vector>

#include "core/exec/live_runtime.hpp"
#include "core/exec/virtual_runtime.hpp"

namespace adit {
namespace {

/// Periodic timers of `range(0)` strands: the load of a rehearsal.
void virtual_timers(benchmark::State& state) {
  VirtualScheduler scheduler(1);
  std::vector<std::unique_ptr<Runtime>> machines;
  std::vector<std::shared_ptr<Executor>> strands;
  std::vector<Timer> timers;
  for (int i = 0; i < state.range(0); ++i) {
    machines.push_back(scheduler.machine("m", 1s * i));
    strands.push_back(machines.back()->strand("s"));
    timers.push_back(strands.back()->every(1ms + Duration(i * 1000), [] {}));
  }
  const std::uint64_t before = scheduler.tasks_run();
  for (auto _ : state) scheduler.run_until(scheduler.elapsed() + 10ms);
  state.SetItemsProcessed(static_cast<std::int64_t>(scheduler.tasks_run() - before));
}
BENCHMARK(virtual_timers)->Arg(1)->Arg(10)->Arg(100);

/// Two strands that post each other.
void virtual_posts(benchmark::State& state) {
  VirtualScheduler scheduler({.seed = 1, .max_per_instant = ~std::uint64_t{0}});
  const auto machine = scheduler.machine("m", 1s);
  const auto a = machine->strand("a"), b = machine->strand("b");
  Executor* const strands[] = {a.get(), b.get()};
  constexpr std::uint64_t kRally = 10'000;
  std::uint64_t n = 0;
  std::function<void()> ball = [&] {
    if (++n % kRally != 0) strands[n % 2]->post([&ball] { ball(); });
  };
  for (auto _ : state) {
    ball();
    scheduler.run_until(scheduler.elapsed() + 1ns);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(n));
}
BENCHMARK(virtual_posts);

/// From post() on one thread to the task on an idle strand.
void live_wake_up(benchmark::State& state) {
  LiveRuntime runtime;
  const auto strand = runtime.strand("s");
  std::vector<double> micros;
  for (auto _ : state) {
    std::this_thread::sleep_for(500us);  // so that the strand sleeps
    std::promise<Time> ran;
    const Time posted = strand->now();
    strand->post([&] { ran.set_value(strand->now()); });
    const double us = seconds(ran.get_future().get() - posted) * 1e6;
    micros.push_back(us);
    state.SetIterationTime(us * 1e-6);
  }
  std::sort(micros.begin(), micros.end());
  state.counters["median_us"] = micros[micros.size() / 2];
  state.counters["p99_us"] = micros[micros.size() * 99 / 100];
}
BENCHMARK(live_wake_up)->UseManualTime()->Iterations(2000);

}  // namespace
}  // namespace adit

BENCHMARK_MAIN();
