// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rehearsal/drive.hpp"

namespace adit::sim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(CheckerStop, HealthyStopBreaksNothing) {
  Record r;
  drive(r);
  stop(r, 2);
  r.pass(2s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerStop, RefusedStop) {
  Record r;
  r.take(1);
  r.answer(r.ask(2, Verb::stop), Reason::not_holder);
  r.pass(100ms);
  EXPECT_THAT(r.broken(), ElementsAre(4)) << r.texts();
}

TEST(CheckerStop, VelocityWhileStopped) {
  Record r;
  drive(r);
  const CommandHeard c = r.ask(2, Verb::stop);
  r.stops.push_back({c.station, c.id});
  r.answer(c);
  r.publish();
  r.pass(200ms, kForward, &kForward);
  EXPECT_THAT(r.broken(), testing::Contains(4)) << r.texts();
}

TEST(CheckerStop, StopOfOneStationForgottenWhileAnotherLasts) {
  Record r;
  drive(r);
  stop(r, 1);
  stop(r, 2);
  r.pass(1s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
  r.stops.pop_back();
  r.publish();
  r.pass(100ms);
  EXPECT_THAT(r.broken(), ElementsAre(4)) << r.texts();
}

TEST(CheckerStop, LateRepeatOfAStopThatWasResetBreaksNothing) {
  Record r;
  drive(r);
  r.pass(300ms, kStill, &kStill);
  CommandHeard c = r.ask(1, Verb::stop);
  r.stops.push_back({c.station, c.id});
  r.answer(c);
  r.behave("hold", true);
  r.publish();
  r.pass(100ms, kStill, &kStill);
  const CommandHeard clear = r.ask(1, Verb::reset);
  r.stops.clear();
  r.answer(clear);
  r.publish();
  r.behave("hold");
  r.pass(100ms, kStill, &kStill);
  r.enter("manual");
  r.pass(100ms, kForward, &kForward);
  r.see(c);
  r.answer(c);
  r.pass(100ms, kForward, &kForward);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerStop, BodyThatDoesNotComeToRest) {
  Record r;
  drive(r);
  r.moving = {0.4, 0.0, 0.0};
  r.pass(40ms, kForward, &kForward);
  stop(r, 1);
  r.pass(2s);
  EXPECT_THAT(r.broken(), ElementsAre(4)) << r.texts();
}

TEST(CheckerStop, ResetOfAnothersStopWithoutOverride) {
  Record r;
  drive(r);
  stop(r, 2);
  r.pass(1s);
  const CommandHeard c = r.ask(1, Verb::reset);
  r.answer(c);
  r.pass(100ms);
  EXPECT_THAT(r.broken(), ElementsAre(4)) << r.texts();
}

TEST(CheckerStop, MotionAfterReset) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, kForward);
  stop(r, 1);
  r.pass(1s);
  const CommandHeard c = r.ask(1, Verb::reset);
  r.stops.clear();
  r.answer(c);
  r.publish();
  r.behave("waypoint");
  r.pass(200ms, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

TEST(CheckerStop, OverrideNotifiesBothOperators) {
  for (const bool notified : {true, false}) {
    Record r;
    r.take(1);
    const CommandHeard stop = r.ask(2, Verb::stop);
    r.stops.push_back({"op2", station_id(2)});
    r.answer(stop);
    r.publish();
    r.pass(50ms);
    const CommandHeard reset = r.ask(1, Verb::reset, "", true);
    r.stops.clear();
    r.see(NotificationSent{"reset", "op1", 1});
    if (notified) r.see(NotificationSent{"reset", "op2", 2});
    r.answer(reset);
    r.publish();
    r.pass(400ms);
    if (notified)
      EXPECT_THAT(r.broken(), ElementsAre()) << r.texts();
    else
      EXPECT_THAT(r.broken(), ElementsAre(4)) << r.texts();
  }
}

}  // namespace
}  // namespace adit::sim
