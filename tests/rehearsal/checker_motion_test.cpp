#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rehearsal/record.hpp"

namespace adit::sim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// op1 holds the robot and drives it by joystick.
void drive(Record& r) {
  r.pass(1s);
  r.take(1);
  r.pass(200ms, still, &still);
  r.enter("manual");
  r.pass(100ms, still, &still);
  r.pass(500ms, forward, &forward);
}

void stop(Record& r, int by) {
  const CommandHeard c = r.ask(by, Verb::stop);
  r.stops.push_back({c.station, c.id});
  r.answer(c);
  r.behave("hold", true);
  r.publish();
}

TEST(CheckerMotion, HealthyDriveBreaksNothing) {
  Record r;
  drive(r);
  r.pass(300ms, still, &still);
  r.pass(900ms);
  r.behave("hold");
  r.pass(1s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerMotion, HealthyStopBreaksNothing) {
  Record r;
  drive(r);
  stop(r, 2);
  r.pass(2s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerMotion, RefusedStop) {
  Record r;
  r.take(1);
  r.answer(r.ask(2, Verb::stop), Reason::not_holder);
  r.pass(100ms);
  EXPECT_THAT(r.broken(), ElementsAre(4)) << r.texts();
}

TEST(CheckerMotion, VelocityWhileStopped) {
  Record r;
  drive(r);
  const CommandHeard c = r.ask(2, Verb::stop);
  r.stops.push_back({c.station, c.id});
  r.answer(c);
  r.publish();
  r.pass(200ms, forward, &forward);
  EXPECT_THAT(r.broken(), testing::Contains(4)) << r.texts();
}

TEST(CheckerMotion, StopOfOneStationForgottenWhileAnotherLasts) {
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

TEST(CheckerMotion, LateRepeatOfAStopThatWasResetBreaksNothing) {
  Record r;
  drive(r);
  r.pass(300ms, still, &still);
  CommandHeard c = r.ask(1, Verb::stop);
  r.stops.push_back({c.station, c.id});
  r.answer(c);
  r.behave("hold", true);
  r.publish();
  r.pass(100ms, still, &still);
  const CommandHeard clear = r.ask(1, Verb::reset);
  r.stops.clear();
  r.answer(clear);
  r.publish();
  r.behave("hold");
  r.pass(100ms, still, &still);
  r.enter("manual");
  r.pass(100ms, forward, &forward);
  r.see(c);
  r.answer(c);
  r.pass(100ms, forward, &forward);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerMotion, BodyThatDoesNotComeToRest) {
  Record r;
  drive(r);
  r.moving = {0.4, 0.0, 0.0};
  r.pass(40ms, forward, &forward);
  stop(r, 1);
  r.pass(2s);
  EXPECT_THAT(r.broken(), ElementsAre(4)) << r.texts();
}

TEST(CheckerMotion, ResetOfAnothersStopWithoutOverride) {
  Record r;
  drive(r);
  stop(r, 2);
  r.pass(1s);
  const CommandHeard c = r.ask(1, Verb::reset);
  r.answer(c);
  r.pass(100ms);
  EXPECT_THAT(r.broken(), ElementsAre(4)) << r.texts();
}

TEST(CheckerMotion, VelocityInHold) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, forward);
  r.pass(100ms);
  const CommandHeard c = r.ask(1, Verb::mode, "hold");
  r.answer(c);
  r.behave("hold");
  r.pass(200ms);
  r.pass(200ms, forward);
  EXPECT_THAT(r.broken(), ElementsAre(5, 7)) << r.texts();
}

TEST(CheckerMotion, ChangeOfSourceWithoutZero) {
  Record r;
  drive(r);
  const CommandHeard c = r.ask(1, Verb::mode, "waypoint");
  r.answer(c);
  r.behave("waypoint");
  r.pass(200ms, {0.4, 0.0, 0.1});
  EXPECT_THAT(r.broken(), ElementsAre(5)) << r.texts();
}

TEST(CheckerMotion, VelocityGoesOnWhenTheStickFallsSilent) {
  Record r;
  drive(r);
  r.pass(600ms, forward);
  EXPECT_THAT(r.broken(), ElementsAre(6)) << r.texts();
}

TEST(CheckerMotion, ManualModeStaysWithoutStick) {
  Record r;
  drive(r);
  r.pass(3s);
  EXPECT_THAT(r.broken(), ElementsAre(6)) << r.texts();
}

TEST(CheckerMotion, DriverLeftAlone) {
  Record r;
  r.pass(2s);
  r.driven = false;
  r.pass(300ms);
  EXPECT_THAT(r.broken(), ElementsAre(6)) << r.texts();
}

TEST(CheckerMotion, NoZeroAfterTheAgentsDeath) {
  Record r;
  r.pass(2s);
  r.see(AgentDied{});
  r.driven = false;
  r.pass(300ms);
  EXPECT_THAT(r.broken(), ElementsAre(6)) << r.texts();
}

TEST(CheckerMotion, ZeroAfterTheAgentsDeath) {
  Record r;
  r.pass(2s);
  r.see(AgentDied{});
  r.pass(300ms);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerMotion, MotionAfterReset) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, forward);
  stop(r, 1);
  r.pass(1s);
  const CommandHeard c = r.ask(1, Verb::reset);
  r.stops.clear();
  r.answer(c);
  r.publish();
  r.behave("waypoint");
  r.pass(200ms, forward);
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

void restart(Record& r) {
  r.see(AgentDied{});
  r.see(VelocitySent{});
  r.pass(500ms);
  r.see(AgentStarted{participant(101)});
  r.see(VelocitySent{});
  ++r.start;
  ++r.epoch;
}

TEST(CheckerMotion, AnAutonomousModeGoesOnAfterARestart) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, forward);
  restart(r);
  r.publish();
  r.behave("waypoint");
  r.pass(500ms, forward);
  EXPECT_THAT(r.broken(), ElementsAre()) << r.texts();
}

TEST(CheckerMotion, MotionAfterRestart) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, forward);
  r.enter("hold");
  restart(r);
  r.publish();
  r.behave("waypoint");
  r.pass(500ms, forward);
  EXPECT_THAT(r.broken(), ElementsAre(7, 9)) << r.texts();
}

TEST(CheckerMotion, AManualModeAfterARestart) {
  Record r;
  drive(r);
  restart(r);
  r.publish();
  r.behave("manual");
  r.pass(100ms, still, &still);
  EXPECT_THAT(r.broken(), ElementsAre(9)) << r.texts();
}

TEST(CheckerMotion, TheFirstVelocityAfterARestartIsZero) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, forward);
  r.see(AgentDied{});
  r.see(VelocitySent{});
  r.pass(500ms);
  r.see(AgentStarted{participant(101)});
  ++r.start;
  ++r.epoch;
  r.publish();
  r.behave("waypoint");
  r.pass(500ms, forward);
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

TEST(CheckerMotion, APlanWithoutScansIsStale) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, forward);
  r.seeing = false;
  r.pass(500ms, forward);
  EXPECT_THAT(r.broken(), ElementsAre()) << r.texts();
  r.pass(200ms, forward);
  EXPECT_THAT(r.broken(), ElementsAre(6)) << r.texts();
}

/// What must not be lost in a restart, and what rule tells.
TEST(CheckerMotion, WhatARestartMustKeep) {
  const auto after = [](const std::function<void(Record&)>& change) {
    Record r;
    r.take(1);
    r.lock(1);
    const CommandHeard c = r.ask(2, Verb::stop);
    r.stops.push_back({"op2", station_id(2)});
    r.answer(c);
    r.publish();
    r.see(NotificationSent{"stopped", "op1", 1});
    r.behave("hold", true);
    r.pass(100ms);
    restart(r);
    change(r);
    r.publish();
    r.behave("hold", !r.stops.empty());
    r.pass(100ms);
    return r.broken();
  };
  EXPECT_THAT(after([](Record&) {}), ElementsAre());
  EXPECT_THAT(after([](Record& r) { r.authority.holder = ""; }), ElementsAre(9)) << "the holder";
  EXPECT_THAT(after([](Record& r) { r.authority.holder = "op2"; }), ElementsAre(9)) << "another holder";
  EXPECT_THAT(after([](Record& r) { r.authority.locked = false; }), ElementsAre(9)) << "the lock";
  EXPECT_THAT(after([](Record& r) { r.stops.clear(); }), ElementsAre(9)) << "the stop";
  EXPECT_THAT(after([](Record& r) {
                r.stops.push_back({"op1", station_id(1)});
              }),
              ElementsAre(9))
      << "a new stop";
  EXPECT_THAT(after([](Record& r) { --r.start; }), ElementsAre(1)) << "the epoch's start";
  EXPECT_THAT(after([](Record& r) { --r.epoch; }), ElementsAre(9)) << "the epoch's counter";
}

TEST(CheckerMotion, WhatWasNotAnsweredMayBeDoneOrNot) {
  for (const bool done : {false, true}) {
    Record r;
    r.take(1);
    r.ask(2, Verb::take);
    r.see(AgentDied{});
    r.see(VelocitySent{});
    r.pass(500ms);
    r.see(AgentStarted{participant(101)});
    r.see(VelocitySent{});
    ++r.start;
    r.epoch += 2;
    if (done) {
      r.authority.holder = "op2";
      r.authority.holder_id = station_id(2);
    }
    r.publish();
    r.behave("hold");
    r.pass(100ms);
    EXPECT_THAT(r.broken(), ElementsAre()) << r.texts();
  }
}

TEST(CheckerMotion, ADiskThatTookNothingMayLoseTheStateButNotGuess) {
  const auto after = [](const std::string& holder) {
    Record r;
    r.take(1);
    r.see(DiskChanged{true});
    restart(r);
    r.authority = {};
    r.authority.holder = holder;
    r.publish();
    r.behave("hold");
    r.pass(100ms);
    return r.broken();
  };
  EXPECT_THAT(after(""), ElementsAre());
  EXPECT_THAT(after("op2"), ElementsAre(9));
}

TEST(CheckerMotion, ACommandComponentMadeAnewIsARestart) {
  for (const bool faulted : {true, false}) {
    Record r;
    r.take(1);
    r.pass(100ms);
    if (faulted) r.see(ComponentFaulted{"command"});
    r.pass(100ms);
    ++r.start;
    ++r.epoch;
    r.see(VelocitySent{});
    r.publish();
    r.behave("hold");
    r.pass(100ms);
    if (faulted)
      EXPECT_THAT(r.broken(), ElementsAre()) << r.texts();
    else
      EXPECT_THAT(r.broken(), ElementsAre(1)) << r.texts();
  }
}

TEST(CheckerMotion, BothAreToldOfAnOverride) {
  for (const bool told : {true, false}) {
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
    if (told) r.see(NotificationSent{"reset", "op2", 2});
    r.answer(reset);
    r.publish();
    r.pass(400ms);
    if (told)
      EXPECT_THAT(r.broken(), ElementsAre()) << r.texts();
    else
      EXPECT_THAT(r.broken(), ElementsAre(4)) << r.texts();
  }
}

TEST(CheckerMotion, ManualModeUnderTheNextHolder) {
  Record r;
  drive(r);
  r.pass(100ms, still, &still);
  r.take(2);
  r.pass(300ms);
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

TEST(CheckerMotion, ManualModeGoesOnWhenTheHoldersStationRestarts) {
  Record r;
  drive(r);
  r.see(PresenceHeard{participant(11), "op1", station_id(1)});
  r.pass(200ms, still, &still);
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

TEST(CheckerMotion, FirstPresenceAfterCommandsIsNoRestart) {
  Record r;
  r.stations = false;
  r.see(AgentStarted{participant(101)});  // it has heard nobody yet; op1's presences are lost
  r.publish();
  drive(r);
  r.hear_stations();
  r.pass(200ms, still, &still);
  EXPECT_EQ(r.texts().find("started again"), std::string::npos) << r.texts();
}

TEST(CheckerMotion, HoldWhenTheHoldersStationRestartsBreaksNothing) {
  Record r;
  drive(r);
  r.see(PresenceHeard{participant(11), "op1", station_id(1)});
  r.behave("hold");
  r.pass(500ms);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerMotion, ManualModeEnteredWithAPushedStick) {
  Record r;
  r.pass(1s);
  r.take(1);
  r.pass(200ms, still, &forward);
  r.enter("manual");
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

TEST(CheckerMotion, ManualModeEnteredWithoutAStick) {
  Record r;
  r.pass(1s);
  r.take(1);
  r.enter("smart_joystick");
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

TEST(CheckerMotion, StaleEchoIsNoStick) {
  Record r;
  r.pass(1s);
  r.take(1);
  for (int i = 0; i < 4; ++i) {
    r.see(JoystickHeard{participant(1), station_id(1), 9, r.epoch, ++r.sequence, 200'000'000, still});
    r.pass(50ms);
  }
  r.enter("manual");
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

TEST(CheckerMotion, MovedByAForeignStick) {
  Record r;
  r.pass(1s);
  r.take(1);
  r.pass(200ms, still, &still);
  r.enter("manual");
  for (int i = 0; i < 10; ++i) {
    r.push(1, still);
    const auto stamp = static_cast<std::uint64_t>((r.now / 100ms * 100ms - 100ms).count());
    r.see(JoystickHeard{participant(66), station_id(1), 9, r.epoch, 1000, stamp, forward});
    r.pass(50ms, forward);
  }
  EXPECT_THAT(r.broken(), testing::Contains(1)) << r.texts();
}

}  // namespace
}  // namespace adit::sim
