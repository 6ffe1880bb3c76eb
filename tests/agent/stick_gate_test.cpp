// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/agent/command_bench.hpp"

namespace adit::agent {
namespace {

class StickGateTest : public testing::Test {
 protected:
  StickGateTest() { bench.say("op1", "take"); }
  Reason send(const StickSample& s) {
    bench.now += 2s;  // refusals are reported once a second
    StickSample fresh = s;
    if (s.echo != 0 && !keep_echo) {
      bench.interface().sent_stamp(to_stamp(bench.now));
      fresh.echo = to_stamp(bench.now);
    }
    const auto answer = bench.interface().handle(fresh, bench.now);
    return answer ? answer->reason : Reason::none;
  }
  CommandBench bench{};
  bool keep_echo{};
};

TEST_F(StickGateTest, HoldersSamplePasses) {
  EXPECT_EQ(send(bench.stick("op1", {0.5, 0, 0.1})), Reason::none);
  ASSERT_EQ(bench.requests.sticks.size(), 1u);
  EXPECT_EQ(bench.requests.sticks[0], (Twist2{0.5, 0, 0.1}));
}

TEST_F(StickGateTest, OthersAreRefused) {
  EXPECT_EQ(send(bench.stick("op2", {0.5, 0, 0})), Reason::not_holder);
  EXPECT_EQ(send(bench.stick("impostor:op1", {0.5, 0, 0})), Reason::not_holder);
  EXPECT_EQ(send(bench.stick("forger:op1", {0.5, 0, 0})), Reason::identity_mismatch);
  EXPECT_EQ(bench.notices.back().code, "intruder");
  EXPECT_TRUE(bench.requests.sticks.empty());
}

TEST_F(StickGateTest, NobodyHolds) {
  bench.say("op1", "release");
  EXPECT_EQ(send(bench.stick("op1")), Reason::nobody_holds);
}

TEST_F(StickGateTest, OldEpochAndOldNumbersAreRefused) {
  StickSample s = bench.stick("op1");
  s.epoch.counter -= 1;
  EXPECT_EQ(send(s), Reason::stale_epoch);
  s = bench.stick("op1");
  EXPECT_EQ(send(s), Reason::none);
  EXPECT_EQ(send(s), Reason::stale_sequence);
}

TEST_F(StickGateTest, ASampleIsAsOldAsItsReception) {
  StickSample s = bench.stick("op1", {0.5, 0, 0});
  s.waited = 200ms;
  EXPECT_EQ(send(s), Reason::none);
  EXPECT_EQ(bench.requests.stick_at, bench.now - 200ms);
  s = bench.stick("op1", {0.5, 0, 0});
  s.waited = 301ms;
  EXPECT_EQ(send(s), Reason::sample_stale) << "a joystick that is silent for so long moves nothing";
}

TEST_F(StickGateTest, EchoIsJudgedByOurClock) {
  keep_echo = true;
  const StickSample late = bench.stick("op1");
  EXPECT_EQ(send(late), Reason::sample_stale);  // two seconds old
  StickSample s = bench.stick("op1");
  s.echo = to_stamp(bench.now + 3s);  // never sent, and from our future
  EXPECT_EQ(send(s), Reason::sample_stale);
  s = bench.stick("op1");
  s.echo = 0;
  EXPECT_EQ(send(s), Reason::sample_stale);
}

TEST_F(StickGateTest, SixHundredMillisecondsAreTheLimit) {
  StickSample s = bench.stick("op1");
  bench.now += 600ms;
  EXPECT_FALSE(bench.interface().handle(s, bench.now));
  s = bench.stick("op1");
  bench.now += 601ms;
  EXPECT_TRUE(bench.interface().handle(s, bench.now));
}

TEST_F(StickGateTest, RefusalsAreReportedOnceASecond) {
  bench.now += 2s;
  int reports = 0;
  for (int i = 0; i < 40; ++i, bench.now += 50ms)
    if (bench.interface().handle(bench.stick("op2"), bench.now)) ++reports;
  EXPECT_EQ(reports, 2);
}

TEST_F(StickGateTest, RefusalHasNumberZeroAndNamesTheHolder) {
  bench.now += 2s;
  const auto answer = bench.interface().handle(bench.stick("op2"), bench.now);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->seq, 0u);
  EXPECT_EQ(answer->station, "op2");
  EXPECT_EQ(answer->holder, "op1");
}

TEST_F(StickGateTest, NotANumberIsRefused) {
  EXPECT_EQ(send(bench.stick("op1", {std::nan(""), 0, 0})), Reason::out_of_range);
}

TEST_F(StickGateTest, AWrongModeIsRefused) {
  bench.requests.takes_stick = false;
  EXPECT_EQ(send(bench.stick("op1", {0.5, 0, 0})), Reason::wrong_mode);
  EXPECT_EQ(send(bench.stick("op1")), Reason::none);
}

TEST_F(StickGateTest, RestartedStationCountsFromOneAgain) {
  for (int i = 0; i < 5; ++i) send(bench.stick("op1"));
  bench.kill("op1");
  bench.start("op1");
  StickSample s = bench.stick("op1");
  s.seq = 1;
  EXPECT_EQ(send(s), Reason::none);
}

}  // namespace
}  // namespace adit::agent
