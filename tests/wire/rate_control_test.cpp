// SPDX-License-Identifier: Apache-2.0
#include "core/wire/link/rate_control.hpp"

#include <gtest/gtest.h>

namespace adit::wire {
namespace {

/// Asks ten times a second.
struct Sender {
  RateControl control{};
  Time now{from_seconds(100.0)};
  std::uint64_t dropped{};
  int sent{};

  void run(Duration time, Duration queue, int drops_a_tick = 0) {
    for (const Time end = now + time; now < end; now += 100ms) {
      dropped += static_cast<std::uint64_t>(drops_a_tick);
      control.observe(now, queue, dropped);
      if (control.due(now)) ++sent;
    }
  }
};

TEST(RateControl, SendsAtItsFullRateWhileTheLinkIsFree) {
  Sender s;
  s.run(10s, 10ms);
  EXPECT_EQ(s.control.rate(), 10.0);
  EXPECT_EQ(s.control.stretch(), 1);
  EXPECT_EQ(s.sent, 100);
}

TEST(RateControl, AQueueThatStandsHalvesTheRateAndAgainDownToOne) {
  Sender s;
  s.run(1s, 10ms);
  s.run(400ms, 300ms);
  EXPECT_EQ(s.control.rate(), 5.0);
  s.run(500ms, 300ms);
  EXPECT_EQ(s.control.rate(), 2.5);
  EXPECT_EQ(s.control.stretch(), 4);
  s.run(5s, 300ms);
  EXPECT_EQ(s.control.rate(), 1.0);
  s.sent = 0;
  s.run(10s, 300ms);
  EXPECT_EQ(s.sent, 10);
}

TEST(RateControl, AMomentsQueueIsNoFullLink) {
  Sender s;
  for (int i = 0; i < 20; ++i) {
    s.run(200ms, 400ms);
    s.run(800ms, 0ms);
  }
  EXPECT_EQ(s.control.rate(), 10.0);
}

TEST(RateControl, DropsMeanAFullLinkButOneNowAndThenDoesNot) {
  Sender s;
  for (int i = 0; i < 20; ++i) {
    s.run(100ms, 0ms, 2);
    s.run(1s, 0ms);
  }
  EXPECT_EQ(s.control.rate(), 10.0);
  s.run(300ms, 0ms, 1);
  EXPECT_EQ(s.control.rate(), 5.0);
  s.run(3s, 0ms, 3);
  EXPECT_EQ(s.control.rate(), 1.0);
}

TEST(RateControl, ComesBackStepByStepOnceTheLinkWasCalmForAWhile) {
  Sender s;
  s.run(10s, 1s);
  ASSERT_EQ(s.control.rate(), 1.0);
  s.run(900ms, 0ms);
  EXPECT_EQ(s.control.rate(), 1.0);
  s.run(1s, 0ms);
  EXPECT_GE(s.control.rate(), 2.0);
  EXPECT_LE(s.control.rate(), 4.0);
  s.run(5s, 0ms);
  EXPECT_EQ(s.control.rate(), 10.0);
}

TEST(RateControl, BetweenFullAndLowItStays) {
  Sender s;
  s.run(400ms, 300ms);
  ASSERT_EQ(s.control.rate(), 5.0);
  s.run(20s, 120ms);
  EXPECT_EQ(s.control.rate(), 5.0);
}

TEST(RateControl, ASingleDropHoldsTheRiseBack) {
  Sender s;
  s.run(400ms, 300ms);
  for (int i = 0; i < 10; ++i) {
    s.run(100ms, 0ms, 1);
    s.run(800ms, 0ms);
  }
  EXPECT_EQ(s.control.rate(), 5.0);
}

TEST(RateControl, TheFloorHoldsWhileItIsSet) {
  Sender s;
  s.run(10s, 1s);
  s.control.set_floor(5.0);
  s.sent = 0;
  s.run(10s, 1s);
  EXPECT_EQ(s.sent, 50);
  s.control.set_floor(0.0);
  s.sent = 0;
  s.run(10s, 1s);
  EXPECT_LE(s.sent, 11);
}

TEST(RateControl, TimersThatAreALittleLateCostNoMessage) {
  RateControl control;
  int sent = 0;
  Time now{from_seconds(5.0)};
  for (int i = 0; i < 100; ++i) {
    now += i % 2 == 0 ? 93ms : 107ms;
    control.observe(now, 0ms, 0);
    sent += control.due(now) ? 1 : 0;
  }
  EXPECT_EQ(sent, 100);
}

}  // namespace
}  // namespace adit::wire
