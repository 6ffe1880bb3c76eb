// SPDX-License-Identifier: Apache-2.0
// Tasks that another thread runs for a strand.
#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "core/exec/in_place.hpp"
#include "core/exec/live_runtime.hpp"

namespace adit {
namespace {

class InPlaceTest : public testing::Test {
 protected:
  InPlace& in_place() { return *dynamic_cast<InPlace*>(strand.get()); }
  /// The strand's thread runs and has found nothing to do.
  void idle() {
    std::promise<void> ran;
    strand->post([&] { ran.set_value(); });
    ran.get_future().wait();
    while (!in_place().try_run([] {})) std::this_thread::yield();
  }

  std::vector<std::string> failures{};
  LiveRuntime runtime{
      {.on_failure = [this](const std::string&, const std::string& what) { failures.push_back(what); }}};
  std::shared_ptr<Strand> strand{runtime.strand("test")};
};

TEST_F(InPlaceTest, AnIdleStrandsTaskRunsOnTheCallersThread) {
  idle();
  std::thread::id ran;
  ASSERT_TRUE(in_place().try_run([&] { ran = std::this_thread::get_id(); }));
  EXPECT_EQ(ran, std::this_thread::get_id());
}

TEST_F(InPlaceTest, ABusyStrandRefuses) {
  idle();
  std::promise<void> started, go;
  strand->post([&] {
    started.set_value();
    go.get_future().wait();
  });
  started.get_future().wait();
  EXPECT_FALSE(in_place().try_run([] {}));
  go.set_value();
  idle();
}

TEST_F(InPlaceTest, PostsAndTimersOfItsTaskRunAfterIt) {
  idle();
  std::vector<int> order;
  std::promise<void> done;
  ASSERT_TRUE(in_place().try_run([&] {
    static Timer timer;
    timer = strand->after(0ms, [&] {
      order.push_back(2);
      done.set_value();
    });
    strand->post([&] { order.push_back(2); });
    order.push_back(1);
  }));
  done.get_future().wait();
  idle();
  EXPECT_EQ(order, (std::vector<int>{1, 2, 2}));
}

TEST_F(InPlaceTest, AFailedTaskIsTheStrandsFailure) {
  idle();
  EXPECT_TRUE(in_place().try_run([] { throw std::runtime_error("a test's"); }));
  EXPECT_EQ(failures, std::vector<std::string>{"a test's"});
}

TEST_F(InPlaceTest, TasksNeverOverlap) {
  constexpr int rounds = 20000;
  int sum = 0;                          // guarded by the strand alone
  int in_place_runs = 0, accepted = 0;  // the strand's queue is bounded: it may refuse some
  std::thread other([&] {
    for (int i = 0; i < rounds; ++i) accepted += strand->post([&] { ++sum; }) ? 1 : 0;
  });
  for (int i = 0; i < rounds; ++i) in_place_runs += in_place().try_run([&] { ++sum; }) ? 1 : 0;
  other.join();
  std::promise<int> value;  // tasks run in the order posted, so this one is the last
  while (!strand->post([&] { value.set_value(sum); })) std::this_thread::yield();
  EXPECT_EQ(value.get_future().get(), accepted + in_place_runs);
}

TEST_F(InPlaceTest, AnEndedStrandRefuses) {
  idle();
  std::promise<void> started, go;
  std::atomic<bool> finished{false}, waited{false};
  std::thread guest([&] {
    EXPECT_TRUE(in_place().try_run([&] {
      started.set_value();
      go.get_future().wait();
      finished = true;
    }));
  });
  started.get_future().wait();
  std::thread ender([&] {
    strand->end();
    waited = finished.load();
  });
  go.set_value();
  ender.join();
  guest.join();
  EXPECT_TRUE(waited) << "end() returns when the task has";
  EXPECT_FALSE(in_place().try_run([] {}));
}

}  // namespace
}  // namespace adit
