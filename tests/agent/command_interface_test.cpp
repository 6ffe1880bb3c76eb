// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/agent/command_bench.hpp"

namespace adit::agent {
namespace {

TEST(CommandInterface, RepeatGetsTheFirstAnswerAndHasNoSecondEffect) {
  CommandBench bench;
  const Command take = bench.command("op1", "take");
  const Answer first = bench.send(take);
  bench.say("op2", "take");
  const Answer again = bench.send(take);
  EXPECT_EQ(again.holder, "op1");
  EXPECT_EQ(again.epoch, first.epoch);
  EXPECT_EQ(bench.interface().authority().holder_name(), "op2");
}

TEST(CommandInterface, EveryChangeOfHolderRaisesTheEpoch) {
  CommandBench bench;
  const auto counter = [&] { return bench.interface().authority().epoch().counter; };
  const auto start = counter();
  bench.say("op1", "take");
  EXPECT_EQ(counter(), start + 1);
  bench.say("op1", "take");
  bench.say("op1", "lock");
  EXPECT_EQ(counter(), start + 1);
  bench.say("op1", "grant op2");
  EXPECT_EQ(counter(), start + 2);
  bench.say("op2", "release");
  EXPECT_EQ(counter(), start + 3);
}

TEST(CommandInterface, OldEpochIsRefused) {
  CommandBench bench;
  bench.say("op1", "take");
  Command old = bench.command("op1", "mode hold");
  bench.say("op2", "take");
  bench.say("op1", "take");
  EXPECT_EQ(bench.send(old).reason, Reason::stale_epoch);
  Command other_start = bench.command("op1", "mode hold");
  other_start.epoch.start += 1;
  EXPECT_EQ(bench.send(other_start).reason, Reason::stale_epoch);
  EXPECT_THAT(bench.requests.calls, testing::Not(testing::Contains("mode hold")));
}

TEST(CommandInterface, OlderThanRememberedIsStale) {
  CommandBench bench;
  const Command first = bench.command("op1", "take");
  bench.send(first);
  for (int i = 0; i < 63; ++i) bench.say("op1", "lock");
  EXPECT_TRUE(bench.send(first).accepted());
  bench.say("op1", "lock");
  EXPECT_EQ(bench.send(first).reason, Reason::stale_sequence);
}

TEST(CommandInterface, ACommandOvertakenByAStopDoesNotMoveTheRobot) {
  CommandBench bench;
  bench.say("op1", "take");
  const Command late_reset = bench.command("op1", "reset");
  const Command late_lock = bench.command("op1", "lock");
  bench.say("op1", "stop");
  EXPECT_EQ(bench.send(late_reset).reason, Reason::stale_sequence);
  EXPECT_TRUE(bench.interface().stops().any());
  EXPECT_TRUE(bench.send(late_lock).accepted());
}

TEST(CommandInterface, LateStopStillStops) {
  CommandBench bench;
  bench.say("op1", "take");
  const Command late_stop = bench.command("op1", "stop");
  bench.say("op1", "mode hold");
  EXPECT_TRUE(bench.send(late_stop).accepted());
  EXPECT_TRUE(bench.interface().stops().any());
}

TEST(CommandInterface, RefusesBadNamesNumbersAndAddresses) {
  CommandBench bench;
  Command c = bench.command("op1", "take");
  c.robot = "r2";
  EXPECT_EQ(bench.send(c).reason, Reason::wrong_robot);
  for (const char* bad : {"", "op 1", "a;b", "123456789012345678901234567890123", "\xc3\xa4"}) {
    Command named = bench.command("op3", "take");
    named.from.name = bad;
    EXPECT_EQ(bench.send(named).reason, Reason::bad_argument) << bad;
  }
  Command zero = bench.command("op2", "take");
  zero.seq = 0;
  EXPECT_EQ(bench.send(zero).reason, Reason::bad_argument);
}

TEST(CommandInterface, OtherProtocolIsRefusedButMayStop) {
  CommandBench bench;
  bench.interface().hear(bench.station("op1").sender, 2, bench.now);
  EXPECT_EQ(bench.say("op1", "take").reason, Reason::wrong_protocol);
  EXPECT_TRUE(bench.say("op1", "stop").accepted());
}

TEST(CommandInterface, HandoverReachesTheBehaviour) {
  CommandBench bench;
  bench.say("op1", "take");
  bench.requests.calls.clear();
  bench.say("op2", "take");
  EXPECT_THAT(bench.requests.calls, testing::ElementsAre("holder"));
}

TEST(CommandInterface, ALapsedLockIsReportedToAllStations) {
  CommandParams params{};
  params.lock_lease = 5s;
  CommandBench bench(params);
  bench.say("op1", "take");
  bench.say("op1", "lock");
  bench.kill("op1");
  bench.wait(4s);
  EXPECT_TRUE(bench.interface().authority().locked());
  EXPECT_NEAR(bench.interface().authority().lease_left(bench.now), 1.0, 0.6);
  bench.wait(2s);
  EXPECT_FALSE(bench.interface().authority().locked());
  EXPECT_EQ(bench.interface().authority().holder_name(), "op1");
  ASSERT_FALSE(bench.notices.empty());
  EXPECT_EQ(bench.notices.back().code, "lock_lapsed");
  EXPECT_EQ(bench.notices.back().operator_name, "");
}

TEST(CommandInterface, LeaseZeroNeverLapses) {
  CommandParams params{};
  params.lock_lease = 0s;
  CommandBench bench(params);
  bench.say("op1", "take");
  bench.say("op1", "lock");
  bench.kill("op1");
  bench.wait(1000s);
  EXPECT_TRUE(bench.interface().authority().locked());
  EXPECT_LT(bench.interface().authority().lease_left(bench.now), 0.0);
}

TEST(CommandInterface, ConsoleEndsALock) {
  CommandBench bench;
  EXPECT_FALSE(bench.interface().unlock_at_console());
  bench.say("op1", "take");
  bench.say("op1", "lock");
  EXPECT_TRUE(bench.interface().unlock_at_console());
  EXPECT_TRUE(bench.say("op2", "take").accepted());
}

TEST(CommandInterface, SeventeenthStopperSharesALatch) {
  CommandBench bench;
  bench.say("op1", "take");
  for (int i = 0; i < 17; ++i) EXPECT_TRUE(bench.say("stopper" + std::to_string(i), "stop").accepted());
  EXPECT_EQ(bench.interface().stops().all().size(), 16u);
  EXPECT_EQ(bench.interface().stops().all().back().name, "others");
  EXPECT_EQ(bench.say("op1", "reset").reason, Reason::stop_of_another);
  EXPECT_TRUE(bench.say("op1", "reset --override").accepted());
  EXPECT_FALSE(bench.interface().stops().any());
}

TEST(CommandInterface, TwoParticipantsWithOneIdentityAreReported) {
  CommandBench bench;
  bench.say("op1", "take");
  bench.wait(1s);
  // A forger announces himself as a restarted op1, who is alive and goes on announcing himself.
  const MessageSender forger = bench.station("forger:op1").sender;
  bench.interface().hear(forger, 1, bench.now);
  bench.notices.clear();
  bench.wait(2s);
  ASSERT_FALSE(bench.notices.empty());
  EXPECT_EQ(bench.notices.front().code, "intruder");
  const std::string first_bytes = "participant 04";  // the forger's: three stations came before it
  EXPECT_THAT(bench.notices.front().text, testing::HasSubstr(first_bytes));
  bench.interface().hear(forger, 1, bench.now);
  EXPECT_EQ(bench.say("forger:op1", "release").reason, Reason::identity_mismatch);
  EXPECT_TRUE(bench.say("op1", "lock").accepted());
}

TEST(CommandInterface, AForgedPresenceOfALivingHolderMovesNothing) {
  CommandBench bench;
  bench.say("op1", "take");
  bench.requests.calls.clear();
  const MessageSender forger = bench.station("forger:op1").sender;
  int reported = 0;
  for (int i = 0; i < 40; ++i) {  // the holder's presence comes each second, the forger's ten times
    bench.now += 100ms;
    if (i % 10 == 9) bench.interface().hear(bench.station("op1").sender, 1, bench.now);
    bench.interface().hear(forger, 1, bench.now);
    for (const char* line : {"release", "mode waypoint", "goto 1 0", "reset", "lock", "grant op2", "take"})
      EXPECT_EQ(bench.say("forger:op1", line).reason, Reason::identity_mismatch) << line << " at " << i;
    (void)bench.interface().handle(bench.stick("forger:op1", {1.0, 0.0, 0.0}), bench.now);
  }
  for (const Notice& notice : bench.notices) reported += notice.code == "intruder";
  EXPECT_GE(reported, 1);
  EXPECT_EQ(bench.interface().authority().holder_name(), "op1");
  EXPECT_EQ(bench.requests.calls, std::vector<std::string>{"restarted"}) << "a manual mode ends, no more";
  EXPECT_TRUE(bench.say("op1", "lock").accepted());
}

TEST(CommandInterface, AClaimByCommandDoesNotReplaceTheHolder) {
  CommandBench bench;
  bench.say("op1", "take");
  EXPECT_EQ(bench.say("forger:op2", "take").reason, Reason::identity_mismatch);
  EXPECT_TRUE(bench.say("op1", "grant op2").accepted());
  bench.kill("op2");  // or one of its signs of life is lost
  bench.now += 1400ms;
  EXPECT_EQ(bench.say("forger:op2", "release").reason, Reason::identity_mismatch);
}

TEST(CommandInterface, AKilledStationReturnsOnceItsLastSampleTimedOut) {
  CommandBench bench;
  bench.say("op1", "take");
  bench.wait(1s);
  bench.kill("op1");
  bench.notices.clear();
  // The new process announces itself a moment after the kill; its commands are repeated until they count.
  const MessageSender again = bench.station("forger:op1").sender;
  bench.now += 300ms;
  bench.interface().hear(again, 1, bench.now);
  EXPECT_EQ(bench.say("forger:op1", "mode hold").reason, Reason::identity_mismatch);
  bench.now += 1s;
  EXPECT_TRUE(bench.say("forger:op1", "mode hold").accepted());
  EXPECT_TRUE(bench.notices.empty()) << "nobody is an intruder";
}

TEST(CommandInterface, ARestartDoesNotBindTheHolderToTheFirstSender) {
  CommandBench bench;
  bench.say("op1", "take");
  bench.restart();
  for (int i = 0; i < 30; ++i) {  // the real one's presence is due within a second
    for (const char* line : {"mode waypoint", "goto 1 0", "release"})
      EXPECT_EQ(bench.say("forger:op1", line).reason, Reason::identity_mismatch) << line << " at " << i;
    if (i % 10 == 9) bench.interface().hear(bench.station("op1").sender, 1, bench.now);
    bench.now += 100ms;
  }
  EXPECT_TRUE(bench.say("op1", "lock").accepted()) << "and the real one needs no presence";
}

TEST(CommandInterface, ARestartDoesNotMakeAForgersBindingPermanent) {
  CommandBench bench;
  bench.say("op1", "take");
  bench.now += Binding::kHeartbeatTimeout;  // the holder's words are lost for a moment
  const MessageSender forger = bench.station("forger:op1").sender;
  bench.interface().hear(forger, 1, bench.now);
  bench.restart();
  bench.now += Binding::kGrace;
  bench.interface().hear(bench.station("op1").sender, 1, bench.now);
  EXPECT_EQ(bench.say("forger:op1", "release").reason, Reason::identity_mismatch);
  EXPECT_TRUE(bench.say("op1", "lock").accepted());
}

TEST(CommandInterface, ARejectedParticipantIsStillRejectedAfterARestart) {
  CommandBench bench;
  bench.say("op1", "take");
  const MessageSender forger = bench.station("forger:op1").sender;
  bench.interface().hear(forger, 1, bench.now);
  bench.now += Binding::kGrace;
  bench.interface().hear(bench.station("op1").sender, 1, bench.now);  // both live: he is found out
  bench.restart();
  bench.now += Binding::kHeartbeatTimeout;  // a presence of the real one is lost
  bench.interface().hear(forger, 1, bench.now);
  EXPECT_EQ(bench.say("forger:op1", "grant op2").reason, Reason::identity_mismatch);
}

TEST(CommandInterface, AStationRestartedTogetherWithTheRobotIsBackByItsPresence) {
  CommandBench bench;
  bench.say("op1", "take");
  bench.kill("op1");
  bench.restart();
  const MessageSender again = bench.station("forger:op1").sender;
  bench.interface().hear(again, 1, bench.now);
  EXPECT_EQ(bench.say("forger:op1", "mode hold").reason, Reason::identity_mismatch);
  bench.now += Binding::kHeartbeatTimeout;
  EXPECT_TRUE(bench.say("forger:op1", "mode hold").accepted());
}

TEST(CommandInterface, AStationThatLeftIsBackAtOnce) {
  CommandBench bench;
  bench.say("op1", "take");
  bench.interface().departed(bench.station("op1").sender.participant);
  const MessageSender again = bench.station("forger:op1").sender;
  bench.interface().hear(again, 1, bench.now);
  EXPECT_TRUE(bench.say("forger:op1", "mode hold").accepted());
}

TEST(CommandInterface, TakeInTheNameOfAPresentStationIsRefused) {
  CommandBench bench;
  bench.say("op1", "take");
  EXPECT_EQ(bench.say("forger:op2", "take").reason, Reason::identity_mismatch);
  EXPECT_EQ(bench.interface().authority().holder_name(), "op1");
  EXPECT_TRUE(bench.say("op2", "take").accepted());
}

TEST(CommandInterface, AnOlderAuthorityCommandDoesNotUndoANewerOne) {
  CommandBench bench;
  bench.say("op1", "take");
  const Command lock = bench.command("op1", "lock"), unlock = bench.command("op1", "unlock");
  EXPECT_TRUE(bench.send(unlock).accepted());
  EXPECT_EQ(bench.send(lock).reason, Reason::stale_sequence) << "it was under way for long";
  EXPECT_FALSE(bench.interface().authority().locked());
  const Command take = bench.command("op1", "take");
  EXPECT_TRUE(bench.say("op1", "release").accepted());
  EXPECT_EQ(bench.send(take).reason, Reason::stale_sequence);
  EXPECT_FALSE(bench.interface().authority().holder());
  // A stop and what concerns authority do not wait for each other.
  const Command late = bench.command("op1", "take");
  EXPECT_TRUE(bench.say("op1", "stop").accepted());
  EXPECT_TRUE(bench.send(late).accepted());
}

TEST(CommandInterface, StopOfAStationThatCameBackNeedsNoPresence) {
  CommandBench bench;
  bench.say("op1", "take");
  // His station was killed; the next one's first word is a stop, before the robot knows its participant.
  const Answer answer = bench.say("forger:op1", "stop");
  EXPECT_TRUE(answer.accepted());
  EXPECT_TRUE(bench.requests.stopped);
  EXPECT_EQ(bench.say("forger:op1", "mode hold").reason, Reason::identity_mismatch);
}

TEST(CommandInterface, ARestartOfTheHoldersStationReachesTheBehaviour) {
  CommandBench bench;
  bench.say("op1", "take");
  bench.requests.calls.clear();
  bench.wait(2s);
  bench.start("op2");
  EXPECT_TRUE(bench.requests.calls.empty());
  bench.start("op1");
  EXPECT_EQ(bench.requests.calls, std::vector<std::string>{"restarted"});
}

TEST(CommandInterface, LockThatLapsedDoesNotWaitForTheNextTick) {
  CommandParams params{};
  params.lock_lease = 10s;
  CommandBench bench(params);
  bench.say("op1", "take");
  bench.say("op1", "lock");
  bench.now += 9900ms;
  EXPECT_EQ(bench.say("op2", "take").reason, Reason::locked);
  bench.now += 100ms;
  EXPECT_TRUE(bench.say("op2", "take").accepted());
}

TEST(CommandInterface, JoystickIsASignOfLife) {
  CommandParams params{};
  params.lock_lease = 10s;
  CommandBench bench(params);
  bench.say("op1", "take");
  bench.say("op1", "lock");
  for (int i = 0; i < 12; ++i) {
    bench.now += 1s;
    EXPECT_FALSE(bench.interface().handle(bench.stick("op1"), bench.now));
  }
  EXPECT_EQ(bench.say("op2", "take").reason, Reason::locked);
  EXPECT_EQ(bench.say("impostor:op1", "take").reason, Reason::identity_mismatch);
}

TEST(CommandInterface, HolderGetsHisNameBack) {
  CommandBench bench;
  bench.say("op1", "take");
  bench.kill("op1");
  bench.wait(4s);
  EXPECT_EQ(bench.say("impostor:op1", "mode hold").reason, Reason::not_holder);
  bench.start("op1");
  EXPECT_TRUE(bench.say("op1", "mode hold").accepted());
  EXPECT_EQ(bench.say("impostor:op1", "mode hold").reason, Reason::identity_mismatch);
}

TEST(CommandInterface, AStopUnderANameThatAnotherStationHasIsObeyed) {
  CommandBench bench;
  bench.say("op1", "take");
  EXPECT_TRUE(bench.say("impostor:op1", "stop").accepted()) << "two laptops with one name";
  EXPECT_TRUE(bench.requests.stopped);
  EXPECT_EQ(bench.say("op1", "reset").reason, Reason::stop_of_another);
  EXPECT_TRUE(bench.requests.stopped) << "only who stopped it, or an override, clears it";
  EXPECT_TRUE(bench.say("op1", "reset --override").accepted());
  EXPECT_FALSE(bench.requests.stopped);
}

TEST(CommandInterface, StrangersDoNotEmptyTheMemoryOfTheHoldersAnswers) {
  CommandBench bench;
  bench.say("op1", "take");
  const Command go = bench.command("op1", "goto 5 0");
  const Answer first = bench.send(go);
  ASSERT_TRUE(first.accepted());
  bench.requests.calls.clear();
  for (const char* line : {"mode hold", "stop"})
    for (int i = 0; i < 65; ++i) {
      bench.now += 1ms;
      bench.say("s" + std::to_string(i) + line, line);
    }
  const Answer again = bench.send(go);
  EXPECT_EQ(again.reason, Reason::none);
  EXPECT_EQ(std::count(bench.requests.calls.begin(), bench.requests.calls.end(), "goal"), 0)
      << "it was carried out once";
}

TEST(CommandInterface, TableOfStationsIsBounded) {
  CommandBench bench;
  for (int i = 0; i < 61; ++i) EXPECT_TRUE(bench.say("s" + std::to_string(i), "stop").accepted());
  EXPECT_EQ(bench.say("one_more", "take").reason, Reason::unknown_station);
  EXPECT_TRUE(bench.say("one_more", "stop").accepted()) << "a stop needs no place in the table";
  EXPECT_EQ(bench.interface().stations().size(), StationTable::kCapacity);
}

// Others could take its name and id while it is silent, and it would be shut out.
TEST(CommandInterface, NoNumberOfStationsEvictsTheHolder) {
  CommandBench bench;
  bench.say("op1", "take");
  bench.say("op1", "lock");
  bench.kill("op1");
  bench.wait(4s);
  for (int i = 0; i < 100; ++i) bench.say("s" + std::to_string(i), "take");
  ASSERT_TRUE(bench.interface().stored().speaker);
  EXPECT_EQ(bench.interface().stored().speaker->participant, bench.station("op1").sender.participant);
  EXPECT_EQ(bench.interface().stations().size(), StationTable::kCapacity);
  EXPECT_FALSE(bench.interface().handle(bench.stick("op1"), bench.now)) << "no refusal";
}

TEST(CommandInterface, HomeIsAGoalAtTheStart) {
  CommandParams params{};
  params.home = {3.0, -2.0, std::nan("")};
  CommandBench bench(params);
  EXPECT_EQ(bench.say("op1", "home").reason, Reason::nobody_holds);
  bench.say("op1", "take");
  EXPECT_EQ(bench.say("op1", "home").reason, Reason::none);
  EXPECT_EQ(bench.requests.goal.head<2>(), Eigen::Vector2d(3.0, -2.0));
  EXPECT_TRUE(std::isnan(bench.requests.goal.z()));
  bench.say("op2", "stop");
  EXPECT_EQ(bench.say("op1", "home").reason, Reason::stopped);
}

// Rule 4: a stop is obeyed whatever else its message holds.
TEST(CommandInterface, AStopWithWrongArgumentsStops) {
  CommandBench bench;
  Command stop = bench.command("op1", "stop");
  stop.invalid = Error{Reason::bad_argument, "it came with arguments that do not fit"};
  EXPECT_EQ(bench.send(stop).reason, Reason::none);
  EXPECT_TRUE(bench.requests.stopped);
  Command take = bench.command("op1", "take");
  take.invalid = stop.invalid;
  EXPECT_EQ(bench.send(take).reason, Reason::bad_argument);
  EXPECT_FALSE(bench.interface().authority().holder());
}

TEST(CommandInterface, PoseIsSetByTheHolderWhereTheBehaviourAllowsIt) {
  CommandBench bench;
  EXPECT_EQ(bench.say("op1", "pose 1 2 0.5").reason, Reason::nobody_holds);
  bench.say("op1", "take");
  EXPECT_EQ(bench.say("op1", "pose 1 2 0.5").reason, Reason::none);
  EXPECT_EQ(bench.requests.pose.x, 1.0);
  EXPECT_EQ(bench.requests.pose.y, 2.0);
  EXPECT_EQ(bench.requests.pose.yaw, 0.5);
  bench.requests.holds = false;
  EXPECT_EQ(bench.say("op1", "pose 3 4 0").reason, Reason::wrong_mode);
  EXPECT_EQ(bench.requests.pose.x, 1.0);
}

TEST(CommandInterface, AreasReachTheRobotAsTheyWereTyped) {
  CommandBench bench;
  EXPECT_EQ(bench.say("op1", "area add shaft keep_out 0 0 4 2").reason, Reason::nobody_holds);
  ASSERT_TRUE(bench.say("op1", "take").accepted());
  EXPECT_EQ(bench.say("op1", "area add shaft prefer 0 0 4 0 4 4 --z -1 2.5 --weight 3").reason, Reason::none);
  const nav::Area& area = bench.requests.area;
  EXPECT_EQ(area.name, "shaft");
  EXPECT_EQ(area.kind, nav::AreaKind::prefer);
  EXPECT_EQ(area.corners, (std::vector<Eigen::Vector2d>{{0, 0}, {4, 0}, {4, 4}}));
  EXPECT_EQ(area.z_min, -1.0);
  EXPECT_EQ(area.z_max, 2.5);
  EXPECT_EQ(area.weight, 3.0);
  EXPECT_EQ(bench.say("op1", "area add b keep_in 0 0 1 1").reason, Reason::none);
  EXPECT_EQ(area.kind, nav::AreaKind::keep_in);
  EXPECT_EQ(area.weight, 1.0);
  EXPECT_FALSE(std::isfinite(area.z_min) || std::isfinite(area.z_max));
  EXPECT_EQ(bench.say("op1", "area remove b").reason, Reason::none);
  EXPECT_EQ(bench.requests.calls.back(), "no area b");
}

}  // namespace
}  // namespace adit::agent
