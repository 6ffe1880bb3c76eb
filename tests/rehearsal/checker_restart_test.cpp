// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rehearsal/drive.hpp"

namespace adit::sim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(CheckerRestart, NoZeroAfterTheAgentsDeath) {
  Record r;
  r.pass(2s);
  r.see(AgentDied{});
  r.driven = false;
  r.pass(300ms);
  EXPECT_THAT(r.broken(), ElementsAre(6)) << r.texts();
}

TEST(CheckerRestart, ZeroAfterTheAgentsDeath) {
  Record r;
  r.pass(2s);
  r.see(AgentDied{});
  r.pass(300ms);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
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

TEST(CheckerRestart, AnAutonomousModeGoesOnAfterARestart) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, kForward);
  restart(r);
  r.publish();
  r.behave("waypoint");
  r.pass(500ms, kForward);
  EXPECT_THAT(r.broken(), ElementsAre()) << r.texts();
}

TEST(CheckerRestart, MotionAfterRestart) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, kForward);
  r.enter("hold");
  restart(r);
  r.publish();
  r.behave("waypoint");
  r.pass(500ms, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(7, 9)) << r.texts();
}

TEST(CheckerRestart, AManualModeAfterARestart) {
  Record r;
  drive(r);
  restart(r);
  r.publish();
  r.behave("manual");
  r.pass(100ms, kStill, &kStill);
  EXPECT_THAT(r.broken(), ElementsAre(9)) << r.texts();
}

TEST(CheckerRestart, TheFirstVelocityAfterARestartIsZero) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, kForward);
  r.see(AgentDied{});
  r.see(VelocitySent{});
  r.pass(500ms);
  r.see(AgentStarted{participant(101)});
  ++r.start;
  ++r.epoch;
  r.publish();
  r.behave("waypoint");
  r.pass(500ms, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

/// State that a restart must not lose, and the rule that reports each loss.
TEST(CheckerRestart, StateLostInARestart) {
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

TEST(CheckerRestart, UnansweredCommandMayBeDoneOrNot) {
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

/// The robot reads its holder's id from its disk: it may grant the robot back to him before it hears him.
TEST(CheckerRestart, AGrantToTheRestoredHolderWhoIsNotHeardYet) {
  const auto granted_to = [](const StationId& id) {
    Record r;
    r.take(1);
    r.stations = false;
    restart(r);
    r.publish();
    r.behave("hold");
    r.pass(20ms);
    r.see(PresenceHeard{participant(2), "op2", station_id(2)});
    r.take(2);
    const CommandHeard c = r.ask(2, Verb::grant, "op1");
    r.authority.holder = "op1";
    r.authority.holder_id = id;
    ++r.epoch;
    r.answer(c);
    r.publish();
    r.pass(20ms);
    return r.broken();
  };
  EXPECT_THAT(granted_to(station_id(1)), ElementsAre());
  EXPECT_THAT(granted_to(station_id(3)), ElementsAre(1)) << "another station of the same name";
}

TEST(CheckerRestart, ADiskThatTookNothingMayLoseTheStateButNotGuess) {
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

TEST(CheckerRestart, ACommandComponentMadeAnewIsARestart) {
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

}  // namespace
}  // namespace adit::sim
