// SPDX-License-Identifier: Apache-2.0
// Meant for the thread sanitizer: many threads, strands that come and go, timers, work.
#include <gmock/gmock.h>

#include <future>
#include <thread>
#include <vector>

#include "core/exec/live_runtime.hpp"
#include "core/time/random.hpp"

namespace adit {
namespace {

TEST(LiveStress, every_post_of_every_thread_runs_once_and_in_its_order) {
  LiveParams params;
  params.queue = 1'000'000;
  LiveRuntime runtime(params);
  const auto strand = runtime.strand("sink");
  constexpr int threads = 4, posts = 5000;
  std::vector<int> last(threads, -1);
  int wrong = 0, ran = 0;
  std::vector<std::thread> posters;
  for (int t = 0; t < threads; ++t)
    posters.emplace_back([&, t] {
      for (int i = 0; i < posts; ++i)
        strand->post([&, t, i] {
          if (last[static_cast<std::size_t>(t)] != i - 1) ++wrong;
          last[static_cast<std::size_t>(t)] = i;
          ++ran;
        });
    });
  for (auto& poster : posters) poster.join();
  std::promise<void> done;
  strand->post([&] { done.set_value(); });
  done.get_future().wait();
  EXPECT_EQ(ran, threads * posts);
  EXPECT_EQ(wrong, 0);
}

TEST(LiveStress, strands_come_and_go_under_fire) {
  std::atomic<int> failures{0};
  LiveParams params;
  params.compute_threads = 2;
  params.on_failure = [&](const std::string&, const std::string&) { ++failures; };
  LiveRuntime runtime(params);
  std::atomic<int> ran{0};
  Random random(11);
  for (int round = 0; round < 60; ++round) {
    auto a = runtime.strand("a");
    auto b = runtime.strand("b");
    std::vector<Timer> timers;
    timers.push_back(a->every(from_seconds(random.uniform(1e-5, 1e-3)), [&] { ++ran; }));
    timers.push_back(b->after(from_seconds(random.uniform(0, 1e-3)), [&] { ++ran; }));
    std::promise<void> came_back;
    a->post([&, raw_a = a.get(), raw_b = b.get()] {
      raw_b->post([&, raw_a] {
        raw_a->compute(
            {}, [&] { ++ran; }, [&](const Result<void>&) { came_back.set_value(); });
      });
    });
    came_back.get_future().wait();
    std::promise<void> b_left_a;  // b may still be inside a's compute()
    b->post([&] { b_left_a.set_value(); });
    b_left_a.get_future().wait();
    for (int i = 0; i < 20; ++i)
      (i % 2 ? a : b)
          ->compute(
              {}, [&] { ++ran; }, [&](const Result<void>&) { ++ran; });
    if (random.chance(0.5)) a.reset();
    timers.clear();
  }
  EXPECT_GT(ran, 60);
}

TEST(LiveStress, two_strands_play_ball) {
  LiveRuntime runtime;
  // A strand must outlive the threads inside its post(): the last of them is a, in b's, so a ends first.
  const auto b = runtime.strand("b");
  const auto a = runtime.strand("a");
  std::promise<void> done;
  int left = 20'000;
  std::function<void()> ping, pong;
  ping = [&] { b->post(pong); };
  pong = [&] {
    if (--left == 0) return done.set_value();
    a->post(ping);
  };
  a->post(ping);
  done.get_future().wait();
  EXPECT_EQ(left, 0);
}

}  // namespace
}  // namespace adit
