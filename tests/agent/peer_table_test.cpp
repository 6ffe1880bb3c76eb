// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/discovery/peer_table.hpp"

#include <gmock/gmock.h>

#include "core/exec/virtual_runtime.hpp"
#include "robot_agent/discovery/directory.hpp"

namespace adit::agent {
namespace {

class PeerTableTest : public testing::Test {
 protected:
  static Id id_of(const std::string& name) {
    Id id{};
    std::copy_n(name.begin(), std::min<std::size_t>(name.size(), 16), id.begin());
    return id;
  }
  static wire::ParticipantId participant(int number) {
    return {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8)};
  }
  static Peer peer(const std::string& name, int number, bool station = false) {
    Peer p{};
    p.name = name;
    p.id = id_of(name);
    p.participant = participant(number);
    if (station) p.kind = contract::AgentKind::station;
    return p;
  }
  static MessageSender sender(const std::string& name, int number) {
    return {name, id_of(name), participant(number)};
  }
  const Peer* find(const std::string& name) const { return peers.find(name); }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("m", 0s)};
  std::shared_ptr<Executor> strand{machine->strand("s")};
  PeerTable peers{*strand};
  Directory directory{peers};
  Time now{Duration{1h}};
};

TEST_F(PeerTableTest, AgesCountFromTheLastSignOfLife) {
  directory.on_capabilities(peer("r2", 1), now);
  directory.on_presence("r2", id_of("r2"), participant(1), now + 2s);
  EXPECT_EQ(find("r2")->age(now + 3s), 1s);
  EXPECT_EQ(find("r2")->first_seen, now);
  directory.tick(now + 4400ms);
  EXPECT_TRUE(find("r2")->present);
  directory.tick(now + 4500ms);
  EXPECT_FALSE(find("r2")->present);
  EXPECT_EQ(find("r2")->age(now + 10s), 8s) << "its age goes on";
}

TEST_F(PeerTableTest, KeepsTheBeaconOfARobotThatIsBoundToItsName) {
  directory.on_capabilities(peer("r2", 1), now);
  directory.on_capabilities(peer("op1", 2, true), now);
  TeamBeacon beacon{.robot = "r2", .start = 5, .seq = 3};
  EXPECT_EQ(peers.hear_beacon(beacon, participant(1), now + 1s), BeaconFault::none);
  EXPECT_EQ(peers.hear_beacon(beacon, participant(1), now + 2s), BeaconFault::old) << "a repeat";
  beacon.seq = 2;
  EXPECT_EQ(peers.hear_beacon(beacon, participant(1), now + 2s), BeaconFault::old);
  beacon.seq = 7;
  EXPECT_EQ(peers.hear_beacon(beacon, participant(9), now + 2s), BeaconFault::unknown) << "a stranger";
  EXPECT_EQ(peers.hear_beacon(beacon, participant(1), now + 3s), BeaconFault::none);
  EXPECT_EQ(find("r2")->heard_beacon->period, 500ms) << "four numbers in 2 s";
  directory.on_presence("r2", id_of("r2"), participant(1), now + 3s);
  directory.on_capabilities(peer("r2", 1), now + 3s);
  EXPECT_EQ(find("r2")->heard_beacon->beacon.seq, 7u) << "a heartbeat changes no beacon";
  beacon = {.robot = "r2", .start = 6, .seq = 1};
  EXPECT_EQ(peers.hear_beacon(beacon, participant(1), now + 4s), BeaconFault::none)
      << "its agent was restarted";
  beacon.robot = "op1";
  EXPECT_EQ(peers.hear_beacon(beacon, participant(2), now + 4s), BeaconFault::unknown) << "a station";
  beacon.robot = "r9";
  EXPECT_EQ(peers.hear_beacon(beacon, participant(3), now + 4s), BeaconFault::unknown) << "never announced";
  peers.refuse_beacon(BeaconFault::malformed);
  EXPECT_EQ(peers.beacon_faults().unknown, 3u);
  EXPECT_EQ(peers.beacon_faults().total(), 6u);
  EXPECT_THAT(describe(peers, now + 5s),
              testing::HasSubstr("refused beacons: 1 malformed, 3 of unknown robots, 2 old"));
}

TEST_F(PeerTableTest, APeerThatReturnsUnderAnotherAddressIsTheSameOne) {
  directory.on_capabilities(peer("r2", 1), now);
  directory.on_participant({participant(1), false});
  EXPECT_FALSE(find("r2")->present);
  directory.on_capabilities(peer("r2", 7), now + 20s);
  ASSERT_EQ(peers.all().size(), 1U);
  EXPECT_TRUE(find("r2")->present);
  EXPECT_EQ(find("r2")->first_seen, now);
  EXPECT_EQ(peers.by_participant(participant(7)), find("r2"));
  EXPECT_EQ(peers.by_participant(participant(1)), nullptr);
}

TEST_F(PeerTableTest, AFullTableEvictsTheAbsentPeerHeardLongestAgo) {
  for (int i = 0; i < static_cast<int>(PeerTable::kCapacity); ++i)
    directory.on_capabilities(peer("r" + std::to_string(i), i), now + i * 1ms);
  directory.on_capabilities(peer("late", 500), now + 200ms);
  EXPECT_EQ(find("late"), nullptr) << "all the others are there";
  directory.on_participant({participant(9), false});
  directory.on_participant({participant(4), false});
  directory.on_capabilities(peer("late", 500), now + 300ms);
  EXPECT_NE(find("late"), nullptr);
  EXPECT_EQ(find("r4"), nullptr);
  EXPECT_NE(find("r9"), nullptr);
  EXPECT_EQ(peers.all().size(), PeerTable::kCapacity);
  // The one that had to go comes back like any other.
  directory.on_capabilities(peer("r4", 4), now + 400ms);
  EXPECT_NE(find("r4"), nullptr);
  EXPECT_EQ(find("r9"), nullptr);
}

TEST_F(PeerTableTest, TheHolderIsNeverEvicted) {
  directory.on_capabilities(peer("op1", 1000, true), now);
  peers.set_holder("op1", id_of("op1"));
  directory.on_participant({participant(1000), false});
  for (int i = 0; i < 300; ++i) {
    directory.on_capabilities(peer("r" + std::to_string(i), i), now + i * 1s);
    directory.tick(now + i * 1s);
  }
  EXPECT_EQ(peers.all().size(), PeerTable::kCapacity);
  ASSERT_NE(peers.holder(), nullptr);
  EXPECT_EQ(peers.holder()->name, "op1");
  EXPECT_EQ(peers.holder()->age(now + 300s), 300s);
}

TEST_F(PeerTableTest, TheHolderFindsRoomWhereAllOthersArePresent) {
  for (int i = 0; i < static_cast<int>(PeerTable::kCapacity); ++i)
    directory.on_capabilities(peer("r" + std::to_string(i), i), now + i * 1ms);
  peers.set_holder("op1", id_of("op1"));
  EXPECT_EQ(peers.holder(), nullptr) << "not heard yet";
  peers.accept_station(sender("op1", 500), now + 1s);
  ASSERT_NE(peers.holder(), nullptr);
  EXPECT_EQ(find("r0"), nullptr) << "it was heard longest ago";
  EXPECT_EQ(peers.all().size(), PeerTable::kCapacity);
}

TEST_F(PeerTableTest, TheHolderIsNameAndId) {
  directory.on_capabilities(peer("op1", 1, true), now);
  peers.set_holder("op1", id_of("another"));
  EXPECT_EQ(peers.holder(), nullptr);
  peers.set_holder("", {});
  EXPECT_EQ(peers.holder(), nullptr);
}

TEST_F(PeerTableTest, AStationIsKnownByItsCommandsAloneUntilItDescribesItself) {
  peers.accept_station(sender("op1", 1), now);
  ASSERT_NE(find("op1"), nullptr);
  EXPECT_TRUE(find("op1")->is_station());
  EXPECT_FALSE(find("op1")->has_capabilities);
  Peer said = peer("op1", 1, true);
  said.place = {1.0F, 2.0F, 0.0F};
  directory.on_capabilities(said, now + 1s);
  EXPECT_TRUE(find("op1")->has_capabilities);
  EXPECT_EQ(find("op1")->place, said.place);
  EXPECT_EQ(find("op1")->first_seen, now);
  peers.accept_station(sender("op1", 1), now + 2s);
  EXPECT_EQ(find("op1")->last_seen, now + 2s);
  EXPECT_EQ(find("op1")->place, said.place);
}

TEST_F(PeerTableTest, ADescriptionByAnotherParticipantDoesNotTakeAStationThatCommands) {
  peers.accept_station(sender("op1", 1), now);
  directory.on_capabilities(peer("op1", 2, true), now + 100ms);
  EXPECT_EQ(find("op1")->participant, participant(1));
  EXPECT_FALSE(find("op1")->has_capabilities);
  Peer other = peer("op1", 3, true);
  other.id = id_of("other");
  directory.on_capabilities(other, now + 200ms);
  EXPECT_EQ(find("op1")->id, id_of("op1"));
}

TEST_F(PeerTableTest, AnAbsentHolderGetsItsNameBack) {
  peers.set_holder("op1", id_of("op1"));
  Peer other = peer("op1", 2, true);
  other.id = id_of("other");
  directory.on_capabilities(other, now);
  peers.accept_station(sender("op1", 1), now + 1s);
  ASSERT_NE(peers.holder(), nullptr);
  EXPECT_EQ(peers.holder()->participant, participant(1));
  for (int i = 2; i < 20; ++i) {
    peers.accept_station(sender("op1", 1), now + i * 1s);
    directory.on_capabilities(other, now + i * 1s);
    directory.tick(now + i * 1s);
    ASSERT_NE(peers.holder(), nullptr) << i;
  }
}

TEST_F(PeerTableTest, NamesakesAreEntriesOfTheirOwnAndBounded) {
  for (int i = 0; i < 20; ++i)
    directory.on_namesake("r1", id_of(std::to_string(i)), participant(i), now + 1s);
  EXPECT_EQ(peers.all().size(), PeerTable::kNamesakes);
  EXPECT_EQ(find("r1"), nullptr) << "the name is this robot's own";
  ASSERT_NE(peers.by_participant(participant(3)), nullptr);
  EXPECT_TRUE(peers.by_participant(participant(3))->namesake);
  EXPECT_EQ(peers.by_participant(participant(3))->age(now + 4s), 3s);
  directory.on_participant({participant(3), false});
  directory.on_namesake("r1", id_of("x"), participant(99), now + 2s);
  EXPECT_EQ(peers.by_participant(participant(3)), nullptr) << "one that left makes room";
  EXPECT_NE(peers.by_participant(participant(99)), nullptr);
  EXPECT_EQ(peers.all().size(), PeerTable::kNamesakes);
}

TEST_F(PeerTableTest, IsShownToPeopleWithAgesAndPlaces) {
  EXPECT_EQ(describe(peers, now), "no peers\n");
  Peer station = peer("op1", 1, true);
  station.place = {1.0F, 2.0F, 0.5F};
  directory.on_capabilities(station, now);
  peers.set_holder("op1", id_of("op1"));
  Peer robot = peer("r2", 2);
  robot.platform = "whe\x1b[2Jeled";
  directory.on_capabilities(robot, now);
  directory.tick(now + 1s);
  const std::string text = describe(peers, now + 1s);
  EXPECT_THAT(text, testing::HasSubstr("heard 1.0 s ago, at 1.0 2.0 0.5, the holder\n"));
  EXPECT_THAT(text, testing::HasSubstr("r2 "));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("\x1b")));
}

TEST_F(PeerTableTest, AStationWithTheNameOfASilentHolderIsNotEntered) {
  peers.accept_station(sender("op1", 1), now);
  peers.set_holder("op1", id_of("op1"));
  directory.tick(now + 10s);
  ASSERT_FALSE(find("op1")->present);
  const MessageSender namesake{"op1", id_of("other"), participant(2)};
  peers.accept_station(namesake, now + 10s);
  ASSERT_NE(peers.holder(), nullptr);
  EXPECT_EQ(peers.holder()->participant, participant(1));
  peers.set_holder("op2", id_of("op2"));
  peers.accept_station(namesake, now + 11s);
  EXPECT_EQ(find("op1")->participant, participant(2));
}

}  // namespace
}  // namespace adit::agent
