// SPDX-License-Identifier: Apache-2.0
// How commands go out: numbers, repeats, giving up, order.
#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

class SenderTest : public StationTest {
 protected:
  SenderTest() {
    add("r1");
    start();
    run_for(6s);
  }
  FakeRobot& r1() { return *robots_[0]; }
};

TEST_F(SenderTest, NumbersRiseByOneFromOne) {
  EXPECT_EQ(execute("take r1").exit_code, 0);
  EXPECT_EQ(execute("lock r1").exit_code, 0);
  EXPECT_EQ(execute("goto r1 4 5").exit_code, 0);
  EXPECT_THAT(r1().numbers(), ElementsAre(1, 2, 3));
  EXPECT_EQ(r1().commands().back().command.numbers()[1], 5.0);
  EXPECT_EQ(op_->counts().sent, 3U);
  EXPECT_EQ(op_->counts().accepted, 3U);
}

TEST_F(SenderTest, ACommandCarriesTheEpochOfTheAnswerBefore) {
  r1().epoch = 41;
  r1().publish();
  run_for(100ms);
  execute("take r1");
  execute("lock r1");
  EXPECT_EQ(r1().commands().back().command.epoch().counter(), 42U);
  EXPECT_EQ(r1().commands().back().command.epoch().start(), 99U);
}

TEST_F(SenderTest, RepeatsEachHundredMillisecondsAndGivesUpAfterThreeSeconds) {
  r1().answering = [](const radio::Command&) { return std::nullopt; };
  const Duration before = scheduler_.elapsed();
  const Outcome outcome = execute("take r1");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.error, HasSubstr("[no_answer]"));
  EXPECT_NEAR(seconds(scheduler_.elapsed() - before), 3.0, 0.05);
  run_for(1s);
  ASSERT_EQ(r1().commands().size(), 31U);
  EXPECT_THAT(r1().numbers(), ElementsAre(1, 2)) << "the last is the question that takes its place";
  EXPECT_EQ(r1().commands().back().command.kind(), radio::CMD_QUERY);
  EXPECT_NEAR(seconds(r1().commands()[5].at - r1().commands()[4].at), 0.1, 0.005);
  EXPECT_EQ(op_->counts().unanswered, 1U);
  EXPECT_EQ(op_->counts().repeats, 29U);
}

TEST_F(SenderTest, WhatARestartOfTheRobotMadeStaleIsSentAnewOnce) {
  EXPECT_EQ(execute("take r1").exit_code, 0);
  // The agent came back: another start, the holder kept; what was given under the former one is stale.
  r1().epoch_start = 100;
  r1().answering = [](const radio::Command& command) -> std::optional<Reason> {
    return command.epoch().start() == 100 ? Reason::none : Reason::stale_epoch;
  };
  EXPECT_EQ(execute("goto r1 4 5").exit_code, 0);
  EXPECT_THAT(r1().numbers(), ElementsAre(1, 2, 3));
  EXPECT_EQ(op_->counts().accepted, 2U);
  EXPECT_EQ(op_->counts().refused, 0U);
}

TEST_F(SenderTest, AStaleEpochOfTheSameStartIsARefusal) {
  EXPECT_EQ(execute("take r1").exit_code, 0);
  r1().answering = [](const radio::Command&) { return Reason::stale_epoch; };
  EXPECT_EQ(execute("goto r1 4 5").exit_code, 1);
  EXPECT_THAT(r1().numbers(), ElementsAre(1, 2));
}

TEST_F(SenderTest, WhatARestartMadeStaleIsNotSentAnewByAFormerHolder) {
  EXPECT_EQ(execute("take r1").exit_code, 0);
  r1().epoch_start = 100;
  r1().holder = "op2";
  r1().answering = [](const radio::Command&) { return Reason::stale_epoch; };
  EXPECT_EQ(execute("goto r1 4 5").exit_code, 1);
  EXPECT_THAT(r1().numbers(), ElementsAre(1, 2));
}

TEST_F(SenderTest, AStopRepeatsEachFiftyMillisecondsForTenSeconds) {
  r1().answering = [](const radio::Command&) { return std::nullopt; };
  const Duration before = scheduler_.elapsed();
  EXPECT_EQ(execute("stop r1").exit_code, 3);
  EXPECT_NEAR(seconds(scheduler_.elapsed() - before), 10.0, 0.05);
  EXPECT_EQ(r1().commands().size(), 200U);
}

TEST_F(SenderTest, ARepeatThatIsAnsweredEndsIt) {
  int heard = 0;
  r1().answering = [&](const radio::Command&) -> std::optional<Reason> {
    return ++heard < 4 ? std::nullopt : std::optional(Reason::none);
  };
  EXPECT_EQ(execute("take r1").exit_code, 0);
  run_for(1s);
  EXPECT_EQ(r1().commands().size(), 4U);
}

TEST_F(SenderTest, AStopOvertakesWhatWaits) {
  r1().answering = [](const radio::Command& command) -> std::optional<Reason> {
    return command.kind() == radio::CMD_STOP ? std::optional(Reason::none) : std::nullopt;
  };
  begin("take r1");
  begin("goto r1 1 2");
  begin("mode r1 hold");
  const Duration before = scheduler_.elapsed();
  EXPECT_EQ(execute("stop r1").exit_code, 0);
  EXPECT_LT(scheduler_.elapsed() - before, 20ms);
  EXPECT_TRUE(late_.empty());
}

TEST_F(SenderTest, WhatAStopOvertookIsNumberedAnew) {
  // As a robot that lost the take on its way and saw the stop first.
  int takes = 0;
  r1().answering = [&](const radio::Command& command) -> std::optional<Reason> {
    if (command.kind() != radio::CMD_TAKE) return Reason::none;
    if (++takes == 1) return std::nullopt;
    return command.seq() == 1 ? Reason::stale_sequence : Reason::none;
  };
  begin("take r1");
  EXPECT_EQ(execute("stop r1").exit_code, 0);
  run_for(1s);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_EQ(late_[0].exit_code, 0);
  EXPECT_EQ(r1().commands().back().command.seq(), 3U);
}

TEST_F(SenderTest, AnIdentityThatIsNotKnownYetIsTriedAgainForAStop) {
  int stops = 0;
  r1().answering = [&](const radio::Command&) -> std::optional<Reason> {
    return ++stops < 3 ? Reason::identity_mismatch : Reason::none;
  };
  EXPECT_EQ(execute("stop r1").exit_code, 0);
  EXPECT_EQ(stops, 3);
  stops = -1000;
  EXPECT_EQ(execute("stop r1", 20s).exit_code, 1);  // but not for ever
}

TEST_F(SenderTest, TheQueueIsBounded) {
  r1().answering = [](const radio::Command&) { return std::nullopt; };
  for (int i = 0; i < 18; ++i) begin("lock r1");
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_EQ(late_[0].exit_code, 1);
  EXPECT_THAT(late_[0].error, HasSubstr("[queue_full]"));
}

TEST_F(SenderTest, AnswersToOthersAreNotOurs) {
  r1().answering = [](const radio::Command&) { return std::nullopt; };
  begin("take r1");
  r1().refuse_stream("op1", {9}, Reason::locked);
  run_for(1s);
  EXPECT_TRUE(late_.empty());
  EXPECT_FALSE(op_->last_answer().has_value());
}

class LossySender : public StationTest, public testing::WithParamInterface<std::uint64_t> {
 protected:
  LossySender()
      : StationTest({.name = "bad", .bandwidth = 500e3, .latency = 0.05, .loss = 0.3}, GetParam()) {}
};
INSTANTIATE_TEST_SUITE_P(Seeds, LossySender, testing::Range<std::uint64_t>(1, 11));

TEST_P(LossySender, EveryCommandIsAnsweredOverALossyLink) {
  FakeRobot& r1 = add("r1");
  start();
  run_for(10s);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(execute(i % 2 == 0 ? "take r1" : "goto r1 1 1").exit_code, 0) << i;
  EXPECT_EQ(op_->counts().accepted, 20U);
  EXPECT_EQ(r1.numbers().size(), 20U);
}

}  // namespace
}  // namespace adit::station
