// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rehearsal/record.hpp"

namespace adit::sim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(CheckerAuthority, HealthyHandOverBreaksNothing) {
  Record r;
  r.pass(1s);
  r.take(1);
  r.lock(1);
  const CommandHeard refused = r.ask(2, Verb::take);
  r.answer(refused, Reason::locked);
  r.see(NotificationSent{"asked", "op1", 1});
  r.pass(1s);
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerAuthority, ChangeOfHolderWithoutNewEpoch) {
  Record r;
  r.take(1);
  const CommandHeard c = r.ask(2, Verb::take);
  r.authority.holder = "op2";
  r.authority.holder_id = station_id(2);
  r.answer(c);
  r.publish();
  r.see(NotificationSent{"taken", "op1", 1});
  EXPECT_THAT(r.broken(), ElementsAre(1)) << r.texts();
}

TEST(CheckerAuthority, CommandOfAnOldEpoch) {
  Record r;
  r.take(1);
  r.see(CommandHeard{participant(1), "op1", station_id(1), 9, r.epoch - 1, 50, Verb::lock, {}, false, {}});
  r.authority.locked = true;
  r.see(AckSent{"op1", station_id(1), 50, true, Reason::none, "", "op1", 9, r.epoch});
  r.publish();
  EXPECT_THAT(r.broken(), ElementsAre(1)) << r.texts();
}

TEST(CheckerAuthority, CommandOfAStationThatIsNotTheHolder) {
  Record r;
  r.take(1);
  r.enter("waypoint");
  r.answer(r.ask(2, Verb::mode, "hold"));
  EXPECT_THAT(r.broken(), ElementsAre(1)) << r.texts();
}

TEST(CheckerAuthority, CommandOfAForeignParticipantInTheHoldersName) {
  Record r;
  r.take(1);
  r.see(CommandHeard{participant(66), "op1", station_id(1), 9, r.epoch, 50, Verb::go_to, {}, false, {}});
  r.see(AckSent{"op1", station_id(1), 50, true, Reason::none, "", "op1", 9, r.epoch});
  EXPECT_THAT(r.broken(), ElementsAre(1)) << r.texts();
}

TEST(CheckerAuthority, RestartedStationOfTheSameIdIsTheHolder) {
  Record r;
  r.take(1);
  r.see(PresenceHeard{participant(11), "op1", station_id(1)});
  r.see(CommandHeard{participant(11), "op1", station_id(1), 9, r.epoch, 1, Verb::lock, {}, false, {}});
  r.authority.locked = true;
  r.see(AckSent{"op1", station_id(1), 1, true, Reason::none, "", "op1", 9, r.epoch});
  r.publish();
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerAuthority, TakeOfARestartedStationShowsItsParticipant) {
  Record r;
  r.stations = false;
  // op1 came back as participant 11; nothing but his commands got through.
  CommandHeard c{participant(11), "op1", station_id(1), 9, r.epoch, 1, Verb::take, {}, false, {}};
  r.see(c);
  r.authority.holder = "op1";
  r.authority.holder_id = station_id(1);
  ++r.epoch;
  r.answer(c);
  r.publish();
  r.pass(100ms);
  c.seq = 2;
  c.counter = r.epoch;
  c.verb = Verb::lock;
  r.see(c);
  r.authority.locked = true;
  r.answer(c);
  r.publish();
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerAuthority, StreamsOfTwoParticipantsUnderOneIdAreAnsweredEach) {
  Record r;
  r.take(2);
  for (int from : {1, 11}) {
    const Duration stamp = r.now / 100ms * 100ms;
    r.see(JoystickHeard{participant(from),
                        station_id(1),
                        9,
                        r.epoch,
                        ++r.sequence,
                        static_cast<std::uint64_t>(stamp.count()),
                        {}});
    r.see(AckSent{"op1", station_id(1), 0, false, Reason::not_holder, "no", "op2", 9, r.epoch});
    r.pass(300ms);
  }
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerAuthority, RepeatWithAnotherAnswer) {
  Record r;
  r.take(1);
  const CommandHeard c = r.ask(1, Verb::unlock);
  r.answer(c);
  r.see(c);
  r.answer(c, Reason::stale_sequence);
  EXPECT_THAT(r.broken(), ElementsAre(1)) << r.texts();
}

TEST(CheckerAuthority, AuthorityThatNobodyChanged) {
  Record r;
  r.take(1);
  r.pass(500ms);
  r.authority.holder = "op2";
  ++r.epoch;
  r.publish();
  EXPECT_THAT(r.broken(), ElementsAre(1)) << r.texts();
}

TEST(CheckerAuthority, LockedRobotTaken) {
  Record r;
  r.take(1);
  r.lock(1);
  r.take(2);
  EXPECT_THAT(r.broken(), ElementsAre(2)) << r.texts();
}

TEST(CheckerAuthority, FormerHolderNotNotified) {
  Record r;
  r.take(1);
  const CommandHeard c = r.ask(2, Verb::take);
  r.authority.holder = "op2";
  r.authority.holder_id = station_id(2);
  ++r.epoch;
  r.answer(c);
  r.publish();
  r.pass(500ms);
  EXPECT_THAT(r.broken(), ElementsAre(2)) << r.texts();
}

TEST(CheckerAuthority, LockLapsesWhenItsHolderIsSilentForTheLease) {
  Record r;
  r.take(1);
  r.lock(1);
  r.stations = false;
  r.pass(21s);
  r.authority.locked = false;
  r.publish();
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerAuthority, TakenInTheInstantInWhichTheLockLapses) {
  Record r;
  r.take(1);
  r.lock(1);
  r.stations = false;
  r.pass(20s);
  r.take(2);  // its unlocked state and the new holder are published at once
  EXPECT_THAT(r.broken(), IsEmpty()) << r.texts();
}

TEST(CheckerAuthority, LockLapsesTooEarly) {
  Record r;
  r.take(1);
  r.lock(1);
  r.stations = false;
  r.pass(10s);
  r.authority.locked = false;
  r.publish();
  EXPECT_THAT(r.broken(), ElementsAre(2)) << r.texts();
}

TEST(CheckerAuthority, CommandNotAnswered) {
  Record r;
  r.take(1);
  r.ask(2, Verb::go_to);
  r.pass(500ms);
  EXPECT_THAT(r.broken(), ElementsAre(3)) << r.texts();
}

TEST(CheckerAuthority, RefusalWithoutReason) {
  Record r;
  const CommandHeard c = r.ask(2, Verb::lock);
  r.see(AckSent{c.station, c.id, c.seq, false, Reason::none, "", "", 9, r.epoch});
  EXPECT_THAT(r.broken(), ElementsAre(3)) << r.texts();
}

TEST(CheckerAuthority, StrangersJoystickRefusedInSilence) {
  Record r;
  r.take(1);
  for (int i = 0; i < 30; ++i) {
    r.push(2, kForward);
    r.pass(50ms);
  }
  EXPECT_THAT(r.broken(), ElementsAre(3)) << r.texts();
}

TEST(CheckerAuthority, StreamAnsweredMoreThanOnceASecond) {
  Record r;
  r.take(1);
  for (int i = 0; i < 2; ++i) {
    r.push(2, kForward);
    r.see(AckSent{"op2", station_id(2), 0, false, Reason::not_holder, "no", "op1", 9, r.epoch});
    r.pass(500ms);
  }
  EXPECT_THAT(r.broken(), ElementsAre(3)) << r.texts();
}

TEST(CheckerAuthority, ANamesakeThatObeysTheSameCommand) {
  Record r;
  r.take(1);
  const CommandHeard lock = r.ask(1, Verb::lock);
  r.see(NamesakeAnswered{lock.id, lock.seq, false});
  r.authority.locked = true;
  r.answer(lock);
  r.publish();
  const CommandHeard stop = r.ask(1, Verb::stop);
  r.answer(stop);
  r.see(NamesakeAnswered{stop.id, stop.seq, true});
  r.stops = {{"op1", station_id(1)}};
  r.publish();
  r.behave("hold", true);
  EXPECT_THAT(r.broken(), ElementsAre()) << r.texts();
  r.pass(20ms);
  r.see(NamesakeAnswered{lock.id, lock.seq, true});
  EXPECT_THAT(r.broken(), ElementsAre(1)) << r.texts();
}

TEST(CheckerAuthority, RestartOrPolicyOfAStationThatIsNotTheHolder) {
  for (const Verb verb : {Verb::restart, Verb::policy}) {
    Record r;
    r.pass(1s);
    r.take(1);
    const CommandHeard c = r.ask(2, verb, "planner");
    r.answer(c);
    r.pass(100ms);
    EXPECT_THAT(r.broken(), testing::ElementsAre(1)) << r.texts();
  }
}

TEST(CheckerAuthority, TheHoldersRestartOfTheCommandComponentBreaksNothing) {
  Record r;
  r.pass(1s);
  r.take(1);
  const CommandHeard c = r.ask(1, Verb::restart, "command");
  r.answer(c);
  r.pass(50ms);
  r.start = 10;
  ++r.epoch;
  r.publish();
  r.behave("hold");
  r.pass(1s);
  EXPECT_TRUE(r.broken().empty()) << r.texts();
}

TEST(CheckerAuthority, AnyoneMayAskForAPlan) {
  Record r;
  r.pass(1s);
  r.take(1);
  r.answer(r.ask(2, Verb::plan));
  r.pass(100ms);
  EXPECT_TRUE(r.broken().empty()) << r.texts();
}

}  // namespace
}  // namespace adit::sim
