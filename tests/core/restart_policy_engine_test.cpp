// SPDX-License-Identifier: Apache-2.0
#include "core/supervisor/restart_policy_engine.hpp"

#include <gmock/gmock.h>

namespace adit {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = RestartAction::Kind;

/// Two components whose samples the test makes: `command` cannot be replaced, `planner` can.
class RestartPolicyEngineTest : public testing::Test {
 protected:
  RestartPolicyEngineTest() {
    restart_policy.add({.name = "command", .replaceable = false, .always = true});
    restart_policy.add({.name = "planner"});
    for (HealthSample& p : samples) p.running = true;
    poll();
  }
  /// Lets time pass in steps in which those that live beat.
  std::vector<RestartAction> pass(Duration time, Duration step = 50ms) {
    std::vector<RestartAction> actions;
    for (Duration t{}; t < time; t += step) {
      now += step;
      for (std::size_t i = 0; i < samples.size(); ++i)
        if (!stuck[i]) ++samples[i].heartbeats;
      pass_on_the_processor(step);
      for (const RestartAction& action : poll()) actions.push_back(action);
    }
    return actions;
  }
  std::vector<RestartAction> poll() {
    const auto decision = restart_policy.poll(samples, now);
    for (const auto& event : decision.events) events.push_back(event.kind);
    for (const RestartAction& action : decision.actions)
      if (action.kind == Kind::restart || action.kind == Kind::replace) {
        samples[action.part] = {};  // as a unit does: nothing is known of the next instance
        samples[action.part].running = comes_up;
        stuck[action.part] = false;
      }
    return decision.actions;
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
    samples[thread->part].use = thread->use;
  }
  void fail(std::size_t part) {
    samples[part].failed = true;
    samples[part].running = false;
    samples[part].text = "broken";
  }
  PartState state(std::size_t part) const { return restart_policy.status()[part].state; }

  struct Thread {
    std::size_t part{};
    double runs{}, waits{};
    ProcessorUse use{};
  };
  std::optional<Thread> thread{};
  RestartPolicyEngine restart_policy{};
  Time now{5s};
  std::vector<HealthSample> samples{2};
  std::vector<bool> stuck{false, false};
  bool comes_up{true};
  std::vector<PartEvent::Kind> events{};
};

TEST_F(RestartPolicyEngineTest, DoesNotRestartAComponentWithAHeartbeat) {
  EXPECT_THAT(pass(60s), IsEmpty());
  EXPECT_EQ(state(0), PartState::up);
  EXPECT_THAT(events, IsEmpty());
}

TEST_F(RestartPolicyEngineTest, RestartsAFailedComponentWithinATenthOfASecond) {
  pass(1s);
  fail(1);
  EXPECT_THAT(poll(), IsEmpty());  // reported at once, restarted after the first pause
  EXPECT_THAT(pass(50ms), ElementsAre(RestartAction{Kind::restart, 1}));
  pass(50ms);
  EXPECT_EQ(state(1), PartState::up);
  EXPECT_THAT(events, ElementsAre(PartEvent::Kind::failed, PartEvent::Kind::back));
  EXPECT_EQ(restart_policy.status()[1].restarts, 1u);
  EXPECT_EQ(restart_policy.status()[1].text, "broken");
}

TEST_F(RestartPolicyEngineTest, PausesGrowAndTheLastAttemptEscalates) {
  std::vector<double> pauses;
  for (int i = 0; i < 5; ++i) {
    fail(1);
    poll();
    const Time failed_at = now;
    while (state(1) == PartState::waiting) pass(10ms, 10ms);
    pauses.push_back(seconds(now - failed_at));
    pass(20ms, 10ms);
  }
  EXPECT_THAT(pauses, ElementsAre(0.01, 0.04, 0.16, 0.64, 2.0));
  fail(1);
  EXPECT_THAT(poll(), ElementsAre(RestartAction{Kind::escalate, 1}));
  EXPECT_TRUE(restart_policy.escalated());
  fail(0);
  EXPECT_THAT(pass(10s), IsEmpty());  // nothing is ordered any more
}

TEST_F(RestartPolicyEngineTest, AttemptsAreForgottenAfterTheWindow) {
  for (int i = 0; i < 40; ++i) {
    fail(1);
    pass(7s);
    EXPECT_EQ(state(1), PartState::up) << i;
  }
  EXPECT_FALSE(restart_policy.escalated());
}

TEST_F(RestartPolicyEngineTest, ReplacesASilentComponentWithinASecond) {
  pass(1s);
  stuck[1] = true;
  const Time hung_at = now;
  EXPECT_THAT(pass(650ms), IsEmpty());
  EXPECT_THAT(pass(150ms), ElementsAre(RestartAction{Kind::replace, 1}));
  EXPECT_LT(now - hung_at, 1s);
  pass(50ms);
  EXPECT_EQ(state(1), PartState::up);
  EXPECT_EQ(restart_policy.status()[1].hangs, 1u);
  EXPECT_THAT(events, ElementsAre(PartEvent::Kind::hung, PartEvent::Kind::back));
}

TEST_F(RestartPolicyEngineTest, SilenceWithoutProcessorTimeIsNoHang) {
  on_the_processor(0, 0.0, 1.0, true);  // it waits all the time
  stuck[0] = true;
  EXPECT_THAT(pass(60s), IsEmpty());
  EXPECT_EQ(state(0), PartState::up);
  EXPECT_GT(restart_policy.status()[0].silent, 59s);  // as others see it: zero is sent meanwhile
  EXPECT_LT(restart_policy.status()[0].stalled, 300ms);
  EXPECT_THAT(events, IsEmpty());
}

TEST_F(RestartPolicyEngineTest, ComponentWithATenthOfAProcessorIsHungAfterEnoughCpuTime) {
  on_the_processor(0, 0.1, 0.9, true);
  stuck[0] = true;
  EXPECT_THAT(pass(4s), IsEmpty());
  EXPECT_THAT(pass(3s), ElementsAre(RestartAction{Kind::escalate, 0}));
}

TEST_F(RestartPolicyEngineTest, BlockedComponentIsHungWithinASecondWhileAnotherIsStarved) {
  on_the_processor(0, 0.0, 1.0, true);
  stuck[0] = stuck[1] = true;
  samples[1].use = ProcessorUse{.ran = 1s, .waited = 2s};  // and stays that
  EXPECT_THAT(pass(650ms), IsEmpty());
  EXPECT_THAT(pass(150ms), ElementsAre(RestartAction{Kind::replace, 1}));
}

TEST_F(RestartPolicyEngineTest, BlockedComponentIsHungASecondAfterItsStarvationEnded) {
  on_the_processor(0, 0.0, 1.0, true);
  stuck[0] = true;
  EXPECT_THAT(pass(10s), IsEmpty());
  on_the_processor(0, 0.0, 0.0, false);
  EXPECT_THAT(pass(800ms), ElementsAre(RestartAction{Kind::escalate, 0}));
}

TEST_F(RestartPolicyEngineTest, LooksThatAreALittleLateFindAHangInTimeAllTheSame) {
  pass(1s);
  stuck[1] = true;
  const Time hung_at = now;
  for (int i = 0; restart_policy.status()[1].hangs == 0 && i < 100; ++i) pass(70ms, 70ms), pass(30ms, 30ms);
  EXPECT_LT(now - hung_at, 900ms);
  EXPECT_EQ(restart_policy.status()[1].hangs, 1u);
}

TEST_F(RestartPolicyEngineTest, WithoutAWordOfTheSystemAllSilenceCounts) {
  stuck[0] = true;
  pass(300ms);
  EXPECT_TRUE(restart_policy.doubts(0));
  EXPECT_FALSE(restart_policy.doubts(1));
  EXPECT_THAT(pass(500ms), ElementsAre(RestartAction{Kind::escalate, 0}));
}

TEST_F(RestartPolicyEngineTest, TheSecondHangEscalates) {
  stuck[1] = true;
  pass(1s);
  pass(1h, 400ms);
  stuck[1] = true;
  EXPECT_THAT(pass(1s), ElementsAre(RestartAction{Kind::escalate, 1}));
}

TEST_F(RestartPolicyEngineTest, EscalatesAtTheFirstHangOfAnIrreplaceableComponent) {
  stuck[0] = true;
  EXPECT_THAT(pass(1s), ElementsAre(RestartAction{Kind::escalate, 0}));
  EXPECT_THAT(events, ElementsAre(PartEvent::Kind::hung, PartEvent::Kind::escalated));
}

TEST_F(RestartPolicyEngineTest, AMachineThatSleptDoesNotLookHung) {
  pass(1s);
  for (int i = 0; i < 5; ++i) {
    now += 60s;  // the engine slept as well, and looks before anybody beat
    EXPECT_THAT(poll(), IsEmpty());
    EXPECT_THAT(pass(100ms), IsEmpty());
  }
}

TEST_F(RestartPolicyEngineTest, ComponentThatNeverComesUpIsHung) {
  comes_up = false;
  fail(1);
  EXPECT_THAT(pass(100ms), ElementsAre(RestartAction{Kind::restart, 1}));
  EXPECT_THAT(pass(4800ms), IsEmpty());  // to start may take longer than to beat
  EXPECT_THAT(pass(400ms), ElementsAre(RestartAction{Kind::replace, 1}));
}

TEST_F(RestartPolicyEngineTest, ByTheOperatorsPolicyItWaits) {
  ASSERT_TRUE(restart_policy.set_policy("planner", RestartPolicy::by_operator, now));
  fail(1);
  EXPECT_THAT(pass(100s, 500ms), IsEmpty());
  EXPECT_EQ(state(1), PartState::failed);
  const auto decision = restart_policy.restart("planner", now);
  ASSERT_TRUE(decision);
  EXPECT_THAT(decision->actions, ElementsAre(RestartAction{Kind::restart, 1}));
}

TEST_F(RestartPolicyEngineTest, AHungOneOfTheOperatorsIsSilencedAndReplacedOnHisWord) {
  ASSERT_TRUE(restart_policy.set_policy("planner", RestartPolicy::by_operator, now));
  stuck[1] = true;
  EXPECT_THAT(pass(1s), ElementsAre(RestartAction{Kind::abandon, 1}));
  EXPECT_EQ(state(1), PartState::hung);
  const auto decision = restart_policy.set_policy("planner", RestartPolicy::automatic, now);
  ASSERT_TRUE(decision);
  EXPECT_THAT(decision->actions, ElementsAre(RestartAction{Kind::replace, 1}));
}

TEST_F(RestartPolicyEngineTest, RefusesUnknownComponentsAndUnsupportedPolicies) {
  EXPECT_EQ(restart_policy.restart("wheels", now).reason(), Reason::bad_argument);
  EXPECT_EQ(restart_policy.set_policy("wheels", RestartPolicy::automatic, now).reason(),
            Reason::bad_argument);
  EXPECT_EQ(restart_policy.set_policy("command", RestartPolicy::by_operator, now).reason(),
            Reason::not_supported);
}

TEST_F(RestartPolicyEngineTest, RestartsByTheOperatorDoNotHideAHang) {
  comes_up = false;
  ASSERT_TRUE(restart_policy.restart("planner", now));
  samples[1] = {};
  stuck[1] = true;
  std::vector<RestartAction> actions;
  for (int i = 0; i < 3; ++i) {
    for (const RestartAction& action : pass(4s)) actions.push_back(action);
    const auto decision = restart_policy.restart("planner", now);
    ASSERT_TRUE(decision);
    for (const RestartAction& action : decision->actions) actions.push_back(action);
  }
  EXPECT_THAT(actions, testing::Contains(RestartAction{Kind::replace, 1}));
}

}  // namespace
}  // namespace adit
