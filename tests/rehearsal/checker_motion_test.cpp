// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rehearsal/drive.hpp"

namespace adit::sim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(CheckerMotion, HealthyDriveBreaksNothing) {
  Record r;
  drive(r);
  r.pass(300ms, kStill, &kStill);
  r.pass(900ms);
  r.behave("hold");
  r.pass(1s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerMotion, AVelocityAfterAJumpOfTheOdometryNeedsANewRequest) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  for (int i = 0; i < 10; ++i) {
    r.see(OdometryHeard{{0.05 * i, 0, 0}});
    r.pass(100ms, kForward);
  }
  EXPECT_THAT(r.broken(), ElementsAre()) << r.texts();
  r.see(OdometryHeard{{-5, 0, 0}});
  r.pass(200ms, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

CommandHeard add_area(Record& r, const char* kind, std::vector<double> corners) {
  CommandHeard c{participant(1), "op1", station_id(1), r.start, r.epoch, ++r.sequence, Verb::area_add, "a"};
  c.words = {"a", kind};
  c.numbers = std::move(corners);
  r.see(c);
  return c;
}

void drive_to(Record& r, double x) {
  for (; r.pose.x < x; r.pose.x += 0.02) r.pass(40ms, kForward);
}

TEST(CheckerMotion, AnAutonomousModeThatLeavesItsAreas) {
  Record r;
  r.take(1);
  r.answer(add_area(r, "keep_in", {-3, -3, 3, 3}));
  r.enter("waypoint");
  drive_to(r, 2.6);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
  drive_to(r, 2.8);
  EXPECT_THAT(r.broken(), ElementsAre(10)) << r.texts();
}

TEST(CheckerMotion, AnAreaThatWasRefusedBindsNobody) {
  Record r;
  r.take(1);
  r.answer(add_area(r, "keep_out", {2, -3, 5, 3}), Reason::outside_area);
  r.enter("waypoint");
  drive_to(r, 3.0);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerMotion, AManualModeMayLeaveTheAreasAndAnAutonomousOneComesBack) {
  Record r;
  r.take(1);
  r.answer(add_area(r, "keep_in", {-3, -3, 3, 3}));
  r.pose.x = 2.0;
  r.pass(500ms, kStill, &kStill);
  r.enter("manual");
  for (; r.pose.x < 3.5; r.pose.x += 0.02) r.pass(40ms, kForward, &kForward);
  r.pass(300ms, kStill, &kStill);
  r.enter("waypoint");
  for (; r.pose.x > 2.0; r.pose.x -= 0.02) r.pass(40ms, {-0.5, 0, 0});
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
  drive_to(r, 3.0);
  EXPECT_THAT(r.broken(), ElementsAre(10)) << r.texts();
}

TEST(CheckerMotion, VelocityInHold) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, kForward);
  r.pass(100ms);
  const CommandHeard c = r.ask(1, Verb::mode, "hold");
  r.answer(c);
  r.behave("hold");
  r.pass(200ms);
  r.pass(200ms, kForward);
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
  r.pass(600ms, kForward);
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

TEST(CheckerMotion, APlanWithoutScansIsStale) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.pass(1s, kForward);
  r.seeing = false;
  r.pass(500ms, kForward);
  EXPECT_THAT(r.broken(), ElementsAre()) << r.texts();
  r.pass(200ms, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(6)) << r.texts();
}

/// A program steers r1 for so long; the agent obeys it.
void steer(Record& r, Duration how_long) {
  for (const Duration end = r.now + how_long; r.now < end;) {
    r.see(ProgramHeard{kForward});
    r.pass(50ms, kForward);
  }
}

TEST(CheckerMotion, ExternalDriveBreaksNothing) {
  Record r;
  r.take(1);
  r.see(ProgramHeard{kForward});
  r.enter("external");
  steer(r, 1s);
  r.pass(450ms, kForward);
  r.pass(100ms);
  r.behave("hold");
  r.pass(1s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerMotion, ExternalIsEnteredWithoutAProgram) {
  Record r;
  r.take(1);
  r.enter("external");
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

TEST(CheckerMotion, VelocityGoesOnWhenTheProgramFallsSilent) {
  Record r;
  r.take(1);
  r.see(ProgramHeard{kForward});
  r.enter("external");
  steer(r, 1s);
  r.pass(800ms, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(6)) << r.texts();
}

TEST(CheckerMotion, ExternalStaysWithoutItsProgram) {
  Record r;
  r.take(1);
  r.see(ProgramHeard{kForward});
  r.enter("external");
  steer(r, 500ms);
  r.pass(1s);
  EXPECT_THAT(r.broken(), ElementsAre(6)) << r.texts();
}

TEST(CheckerMotion, ExternalDrivesWithoutScans) {
  Record r;
  r.take(1);
  r.see(ProgramHeard{kForward});
  r.enter("external");
  r.seeing = false;
  steer(r, 1s);
  EXPECT_THAT(r.broken(), ElementsAre(6)) << r.texts();
}

TEST(CheckerMotion, ExternalComesBackAfterARestart) {
  Record r;
  r.take(1);
  r.see(ProgramHeard{kForward});
  r.enter("external");
  steer(r, 500ms);
  r.see(AgentDied{});
  r.see(VelocitySent{});
  r.pass(200ms);
  r.start = 10;
  ++r.epoch;
  r.see(AgentStarted{participant(101)});
  r.publish();
  r.hear_stations();
  r.behave("external");
  steer(r, 200ms);
  const auto broken = r.broken();
  EXPECT_THAT(broken, testing::Contains(7)) << r.texts();
  EXPECT_THAT(broken, testing::Contains(9)) << r.texts();
}

TEST(CheckerMotion, ManualModeUnderTheNextHolder) {
  Record r;
  drive(r);
  r.pass(100ms, kStill, &kStill);
  r.take(2);
  r.pass(300ms);
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

TEST(CheckerMotion, ManualModeGoesOnWhenTheHoldersStationRestarts) {
  Record r;
  drive(r);
  r.see(PresenceHeard{participant(11), "op1", station_id(1)});
  r.pass(200ms, kStill, &kStill);
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

TEST(CheckerMotion, FirstPresenceAfterCommandsIsNoRestart) {
  Record r;
  r.stations = false;
  r.see(AgentStarted{participant(101)});  // it has heard no station yet; op1's presences are lost
  r.publish();
  drive(r);
  r.hear_stations();
  r.pass(200ms, kStill, &kStill);
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
  r.pass(200ms, kStill, &kForward);
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
    r.see(JoystickHeard{participant(1), station_id(1), 9, r.epoch, ++r.sequence, 200'000'000, kStill});
    r.pass(50ms);
  }
  r.enter("manual");
  EXPECT_THAT(r.broken(), ElementsAre(7)) << r.texts();
}

TEST(CheckerMotion, MovedByAForeignStick) {
  Record r;
  r.pass(1s);
  r.take(1);
  r.pass(200ms, kStill, &kStill);
  r.enter("manual");
  for (int i = 0; i < 10; ++i) {
    r.push(1, kStill);
    const auto stamp = static_cast<std::uint64_t>((r.now / 100ms * 100ms - 100ms).count());
    r.see(JoystickHeard{participant(66), station_id(1), 9, r.epoch, 1000, stamp, kForward});
    r.pass(50ms, kForward);
  }
  EXPECT_THAT(r.broken(), testing::Contains(1)) << r.texts();
}

/// op1 gives r1 a place behind r0.
void join(Record& r, std::vector<std::string> order = {"r0", "r1"}) {
  CommandHeard c{participant(1), "op1",         station_id(1), r.start, r.epoch, ++r.sequence,
                 Verb::join,     order.front(), false,         {},      order};
  r.see(c);
  r.answer(c);
  r.behave("convoy_follow");
  r.pass(20ms);
}

TEST(CheckerMotion, AFollowerWithAPlaceThatHearsItsPredecessorBreaksNothing) {
  Record r;
  r.take(1);
  r.see(BeaconHeard{"r0"});
  join(r);
  r.pass(1s, kForward);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerMotion, AFollowerWithoutAPlace) {
  Record r;
  r.take(1);
  r.see(BeaconHeard{"r0"});
  r.enter("convoy_follow");
  r.pass(1s, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(8)) << r.texts();
}

TEST(CheckerMotion, AFollowerThatHearsOnlyAStranger) {
  Record r;
  r.take(1);
  r.see(BeaconHeard{"r7"});
  join(r);
  r.pass(1s, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(8)) << r.texts();
}

TEST(CheckerMotion, AFollowerWhosePredecessorIsSilent) {
  Record r;
  r.take(1);
  r.see(BeaconHeard{"r0"});
  join(r);
  r.pass(11s, kForward);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
  r.pass(2s, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(8)) << r.texts();
}

TEST(CheckerMotion, AFollowerGoesOnUnderAnotherHolder) {
  Record r;
  r.take(1);
  r.see(BeaconHeard{"r0"});
  join(r);
  r.pass(1s, kForward);
  r.take(2);
  r.pass(1s, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(7, 8)) << r.texts();
}

/// op1 allows r1 to make way, or no longer.
void allow(Record& r, const char* word) {
  CommandHeard c{participant(1), "op1", station_id(1), r.start, r.epoch, ++r.sequence, Verb::yield, word};
  r.see(c);
  r.answer(c);
}

TEST(CheckerMotion, ARobotThatMakesWayBreaksNothing) {
  Record r;
  r.take(1);
  allow(r, "on");
  r.see(BeaconHeard{"r0", {"r1"}});
  r.behave("get_out");
  r.pass(4s, kForward);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

/// op1 allows r1 to make way, stops it, allows it again and resets it, while another robot asks.
void reset_while_asked(Record& r) {
  r.take(1);
  allow(r, "on");
  r.answer(r.ask(1, Verb::stop));
  allow(r, "on");
  r.answer(r.ask(1, Verb::reset));
  r.see(BeaconHeard{"r0", {"r1"}});
  r.behave("get_out");
}

TEST(CheckerMotion, ARobotThatMakesWayAfterAReset) {
  Record r;
  reset_while_asked(r);
  r.pass(1s, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(8)) << r.texts();
}

TEST(CheckerMotion, ARobotThatMakesWayAfterARequestThatFollowsTheReset) {
  Record r;
  reset_while_asked(r);
  allow(r, "on");
  r.answer(r.ask(1, Verb::reset));  // It is not stopped.
  r.pass(1s, kForward);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerMotion, ARobotThatMakesWayAndIsNotAsked) {
  Record r;
  r.take(1);
  allow(r, "on");
  r.see(BeaconHeard{"r0", {"r2"}});
  r.behave("get_out");
  r.pass(1s, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(8)) << r.texts();
}

TEST(CheckerMotion, ARobotThatMakesWayWithoutPermission) {
  Record r;
  r.take(1);
  allow(r, "on");
  allow(r, "off");
  r.see(BeaconHeard{"r0", {"r1"}});
  r.behave("get_out");
  r.pass(1s, kForward);
  EXPECT_THAT(r.broken(), ElementsAre(8)) << r.texts();
}

}  // namespace
}  // namespace adit::sim
