#include "core/supervisor/overseer.hpp"

#include <gmock/gmock.h>

namespace adit {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = Order::Kind;

/// Two components whose pulses the test makes: `command` cannot be replaced, `planner` can.
class OverseerTest : public testing::Test {
 protected:
  OverseerTest() {
    overseer.add({.name = "command", .replaceable = false, .always = true});
    overseer.add({.name = "planner"});
    for (Pulse& p : pulses) p.running = true;
    look();
  }
  /// Lets time pass in steps in which those that live beat.
  std::vector<Order> pass(Duration time, Duration step = 50ms) {
    std::vector<Order> orders;
    for (Duration t{}; t < time; t += step) {
      now += step;
      for (std::size_t i = 0; i < pulses.size(); ++i)
        if (!stuck[i]) ++pulses[i].beats;
      pass_on_the_processor(step);
      for (const Order& order : look()) orders.push_back(order);
    }
    return orders;
  }
  std::vector<Order> look() {
    const auto verdict = overseer.look(pulses, now);
    for (const auto& event : verdict.events) events.push_back(event.kind);
    for (const Order& order : verdict.orders)
      if (order.kind == Kind::restart || order.kind == Kind::replace) {
        pulses[order.part] = {};  // as a unit does: nothing is known of the next instance
        pulses[order.part].running = comes_up;
        stuck[order.part] = false;
      }
    return verdict.orders;
  }
  /// `part`'s thread from now on: so much of each step it runs, waits for a processor, and is ready at its
  /// end.
  void on_the_processor(std::size_t part, double runs, double waits, bool ready) {
    thread = {part, runs, waits, {.ready = ready}};
  }
  void pass_on_the_processor(Duration step) {
    if (!thread) return;
    thread->use.ran += from_seconds(thread->runs * seconds(step));
    // As the system does: a wait is counted when it ends.
    if (!thread->use.ready || thread->runs > 0.0)
      thread->use.waited += from_seconds(thread->waits * seconds(step));
    pulses[thread->part].use = thread->use;
  }
  void fail(std::size_t part) {
    pulses[part].failed = true;
    pulses[part].running = false;
    pulses[part].text = "broken";
  }
  PartState state(std::size_t part) const { return overseer.status()[part].state; }

  struct Thread {
    std::size_t part{};
    double runs{}, waits{};
    ProcessorUse use{};
  };
  std::optional<Thread> thread{};
  Overseer overseer{};
  Time now{5s};
  std::vector<Pulse> pulses{2};
  std::vector<bool> stuck{false, false};
  bool comes_up{true};
  std::vector<PartEvent::Kind> events{};
};

TEST_F(OverseerTest, WhoBeatsIsLeftAlone) {
  EXPECT_THAT(pass(60s), IsEmpty());
  EXPECT_EQ(state(0), PartState::up);
  EXPECT_THAT(events, IsEmpty());
}

TEST_F(OverseerTest, WhoFailedIsMadeAnewWithinATenthOfASecond) {
  pass(1s);
  fail(1);
  EXPECT_THAT(look(), IsEmpty());  // at once told, started after the first pause
  EXPECT_THAT(pass(50ms), ElementsAre(Order{Kind::restart, 1}));
  pass(50ms);
  EXPECT_EQ(state(1), PartState::up);
  EXPECT_THAT(events, ElementsAre(PartEvent::Kind::failed, PartEvent::Kind::back));
  EXPECT_EQ(overseer.status()[1].restarts, 1u);
  EXPECT_EQ(overseer.status()[1].text, "broken");
}

TEST_F(OverseerTest, PausesGrowAndTheLastAttemptEscalates) {
  std::vector<double> pauses;
  for (int i = 0; i < 5; ++i) {
    fail(1);
    look();
    const Time failed_at = now;
    while (state(1) == PartState::waiting) pass(10ms, 10ms);
    pauses.push_back(seconds(now - failed_at));
    pass(20ms, 10ms);
  }
  EXPECT_THAT(pauses, ElementsAre(0.01, 0.04, 0.16, 0.64, 2.0));
  fail(1);
  EXPECT_THAT(look(), ElementsAre(Order{Kind::escalate, 1}));
  EXPECT_TRUE(overseer.escalated());
  fail(0);
  EXPECT_THAT(pass(10s), IsEmpty());  // nothing is ordered any more
}

TEST_F(OverseerTest, AttemptsAreForgottenAfterTheWindow) {
  for (int i = 0; i < 40; ++i) {
    fail(1);
    pass(7s);
    EXPECT_EQ(state(1), PartState::up) << i;
  }
  EXPECT_FALSE(overseer.escalated());
}

TEST_F(OverseerTest, WhoIsSilentIsReplacedWithinASecond) {
  pass(1s);
  stuck[1] = true;
  const Time hung_at = now;
  EXPECT_THAT(pass(650ms), IsEmpty());
  EXPECT_THAT(pass(150ms), ElementsAre(Order{Kind::replace, 1}));
  EXPECT_LT(now - hung_at, 1s);
  pass(50ms);
  EXPECT_EQ(state(1), PartState::up);
  EXPECT_EQ(overseer.status()[1].hangs, 1u);
  EXPECT_THAT(events, ElementsAre(PartEvent::Kind::hung, PartEvent::Kind::back));
}

TEST_F(OverseerTest, WhoGetsNoProcessorIsNotHungHoweverLongItIsSilent) {
  on_the_processor(0, 0.0, 1.0, true);  // it waits all the time
  stuck[0] = true;
  EXPECT_THAT(pass(60s), IsEmpty());
  EXPECT_EQ(state(0), PartState::up);
  EXPECT_GT(overseer.status()[0].silent, 59s);  // as others see it: zero is sent meanwhile
  EXPECT_LT(overseer.status()[0].stalled, 300ms);
  EXPECT_THAT(events, IsEmpty());
}

TEST_F(OverseerTest, WhoGetsATenthOfAProcessorIsHungOnceItRanForTooLong) {
  on_the_processor(0, 0.1, 0.9, true);
  stuck[0] = true;
  EXPECT_THAT(pass(4s), IsEmpty());
  EXPECT_THAT(pass(3s), ElementsAre(Order{Kind::escalate, 0}));
}

TEST_F(OverseerTest, WhoIsBlockedIsHungWithinASecondWhileAnotherIsStarved) {
  on_the_processor(0, 0.0, 1.0, true);
  stuck[0] = stuck[1] = true;
  pulses[1].use = ProcessorUse{.ran = 1s, .waited = 2s};  // and stays that
  EXPECT_THAT(pass(650ms), IsEmpty());
  EXPECT_THAT(pass(150ms), ElementsAre(Order{Kind::replace, 1}));
}

TEST_F(OverseerTest, WhoBlocksAfterItStarvedIsHungWithinASecondFromThen) {
  on_the_processor(0, 0.0, 1.0, true);
  stuck[0] = true;
  EXPECT_THAT(pass(10s), IsEmpty());
  on_the_processor(0, 0.0, 0.0, false);
  EXPECT_THAT(pass(800ms), ElementsAre(Order{Kind::escalate, 0}));
}

TEST_F(OverseerTest, LooksThatAreALittleLateFindAHangInTimeAllTheSame) {
  pass(1s);
  stuck[1] = true;
  const Time hung_at = now;
  for (int i = 0; overseer.status()[1].hangs == 0 && i < 100; ++i) pass(70ms, 70ms), pass(30ms, 30ms);
  EXPECT_LT(now - hung_at, 900ms);
  EXPECT_EQ(overseer.status()[1].hangs, 1u);
}

TEST_F(OverseerTest, WithoutAWordOfTheSystemAllSilenceCounts) {
  stuck[0] = true;
  pass(300ms);
  EXPECT_TRUE(overseer.doubts(0));
  EXPECT_FALSE(overseer.doubts(1));
  EXPECT_THAT(pass(500ms), ElementsAre(Order{Kind::escalate, 0}));
}

TEST_F(OverseerTest, TheSecondHangEscalates) {
  stuck[1] = true;
  pass(1s);
  pass(1h, 400ms);
  stuck[1] = true;
  EXPECT_THAT(pass(1s), ElementsAre(Order{Kind::escalate, 1}));
}

TEST_F(OverseerTest, WhatCannotBeReplacedEscalatesAtTheFirstHang) {
  stuck[0] = true;
  EXPECT_THAT(pass(1s), ElementsAre(Order{Kind::escalate, 0}));
  EXPECT_THAT(events, ElementsAre(PartEvent::Kind::hung, PartEvent::Kind::escalated));
}

TEST_F(OverseerTest, AMachineThatSleptDoesNotLookHung) {
  pass(1s);
  for (int i = 0; i < 5; ++i) {
    now += 60s;  // the overseer slept as well, and looks before anybody beat
    EXPECT_THAT(look(), IsEmpty());
    EXPECT_THAT(pass(100ms), IsEmpty());
  }
}

TEST_F(OverseerTest, WhoNeverComesUpIsHung) {
  comes_up = false;
  fail(1);
  EXPECT_THAT(pass(100ms), ElementsAre(Order{Kind::restart, 1}));
  EXPECT_THAT(pass(4800ms), IsEmpty());  // to start may take longer than to beat
  EXPECT_THAT(pass(400ms), ElementsAre(Order{Kind::replace, 1}));
}

TEST_F(OverseerTest, ByTheOperatorsPolicyItWaits) {
  ASSERT_TRUE(overseer.set_policy("planner", RestartPolicy::by_operator, now));
  fail(1);
  EXPECT_THAT(pass(100s, 500ms), IsEmpty());
  EXPECT_EQ(state(1), PartState::failed);
  const auto verdict = overseer.restart("planner", now);
  ASSERT_TRUE(verdict);
  EXPECT_THAT(verdict->orders, ElementsAre(Order{Kind::restart, 1}));
}

TEST_F(OverseerTest, AHungOneOfTheOperatorsIsSilencedAndReplacedOnHisWord) {
  ASSERT_TRUE(overseer.set_policy("planner", RestartPolicy::by_operator, now));
  stuck[1] = true;
  EXPECT_THAT(pass(1s), ElementsAre(Order{Kind::abandon, 1}));
  EXPECT_EQ(state(1), PartState::hung);
  const auto verdict = overseer.set_policy("planner", RestartPolicy::automatic, now);
  ASSERT_TRUE(verdict);
  EXPECT_THAT(verdict->orders, ElementsAre(Order{Kind::replace, 1}));
}

TEST_F(OverseerTest, RefusesWhatCannotBe) {
  EXPECT_EQ(overseer.restart("wheels", now).reason(), Reason::bad_argument);
  EXPECT_EQ(overseer.set_policy("wheels", RestartPolicy::automatic, now).reason(), Reason::bad_argument);
  EXPECT_EQ(overseer.set_policy("command", RestartPolicy::by_operator, now).reason(), Reason::not_supported);
}

TEST_F(OverseerTest, RestartsByTheOperatorDoNotHideAHang) {
  comes_up = false;
  ASSERT_TRUE(overseer.restart("planner", now));
  pulses[1] = {};
  stuck[1] = true;
  std::vector<Order> orders;
  for (int i = 0; i < 3; ++i) {
    for (const Order& order : pass(4s)) orders.push_back(order);
    const auto verdict = overseer.restart("planner", now);
    ASSERT_TRUE(verdict);
    for (const Order& order : verdict->orders) orders.push_back(order);
  }
  EXPECT_THAT(orders, testing::Contains(Order{Kind::replace, 1}));
}

}  // namespace
}  // namespace adit
