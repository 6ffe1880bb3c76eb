// SPDX-License-Identifier: Apache-2.0
#include "core/exec/processor_use.hpp"

#include <gmock/gmock.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <future>
#include <thread>

namespace adit {
namespace {

constexpr ProcessorUse kBefore{.ran = 3s, .waited = 5s, .ready = false};

ProcessorUse later(Duration ran, Duration waited, bool ready) {
  return {kBefore.ran + ran, kBefore.waited + waited, ready};
}

TEST(Answerable, a_blocked_thread_answers_for_all_of_the_time) {
  EXPECT_EQ(answerable(kBefore, later(0ms, 0ms, false), 50ms), 50ms);
}

TEST(Answerable, a_thread_that_waits_for_a_processor_answers_for_nothing) {
  EXPECT_EQ(answerable(kBefore, later(0ms, 0ms, true), 50ms), 0ms);
}

TEST(Answerable, a_thread_that_never_lets_go_answers_for_what_it_ran) {
  EXPECT_EQ(answerable(kBefore, later(50ms, 0ms, true), 50ms), 50ms);
  EXPECT_EQ(answerable(kBefore, later(4ms, 46ms, true), 50ms), 4ms);
}

TEST(Answerable, what_a_blocked_thread_waited_for_a_processor_before_does_not_count) {
  EXPECT_EQ(answerable(kBefore, later(10ms, 30ms, false), 50ms), 20ms);
}

TEST(Answerable, a_wait_that_began_before_the_last_look_takes_no_more_than_there_is) {
  EXPECT_EQ(answerable(kBefore, later(1ms, 200ms, false), 50ms), 0ms);
  EXPECT_EQ(answerable(kBefore, later(80ms, 0ms, true), 50ms),
            50ms);  // ran up to the last sample, reported late
}

TEST(ProcessorUse, distinguishes_a_sleeping_thread_from_a_running_one) {
  std::promise<int> id;
  std::promise<void> end;
  std::thread sleeper([&] {
    id.set_value(static_cast<int>(syscall(SYS_gettid)));
    end.get_future().wait();
  });
  const int sleeping = id.get_future().get();
  std::optional<ProcessorUse> before = processor_use(sleeping), after = before;
  // Until it blocks, whatever the machine does.
  while (after && (after->ready || after->ran != before->ran)) {
    before = after;
    after = processor_use(sleeping);
  }
  ASSERT_TRUE(after);
  EXPECT_FALSE(after->ready);
  const auto own = processor_use(static_cast<int>(syscall(SYS_gettid)));
  ASSERT_TRUE(own);
  EXPECT_TRUE(own->ready);
  EXPECT_GT(own->ran, 0ms);
  end.set_value();
  sleeper.join();
  // The system releases a joined thread a moment after join() returned.
  while (processor_use(sleeping)) std::this_thread::yield();
  EXPECT_FALSE(processor_use(-1));
}

}  // namespace
}  // namespace adit
