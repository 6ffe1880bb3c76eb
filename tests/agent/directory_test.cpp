// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/discovery/directory.hpp"

#include <gmock/gmock.h>

#include "core/exec/virtual_runtime.hpp"

namespace adit::agent {
namespace {

class DirectoryTest : public testing::Test {
 protected:
  DirectoryTest() {
    seen = peers.follow(*strand, [this](const auto& list) {
      last = *list;
      ++published;
    });
  }
  Peer record(const std::string& name, std::uint8_t participant, bool station = false) {
    Peer r{};
    r.name = name;
    r.id = of(name);
    r.participant[0] = participant;
    if (station) r.kind = contract::AgentKind::station;
    return r;
  }
  Id of(const std::string& name) {
    Id id{};
    std::copy_n(name.begin(), std::min<std::size_t>(name.size(), 16), id.begin());
    return id;
  }
  wire::ParticipantId id(std::uint8_t participant) { return record("", participant).participant; }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("m", 0s)};
  std::shared_ptr<Executor> strand{machine->strand("s")};
  PeerTable peers{*strand};
  Directory directory{peers};
  Subscription seen{};
  PeerList last{};
  int published{};
  Time now{Duration{1h}};
};

TEST_F(DirectoryTest, AppearanceAndChangesArePublishedOnce) {
  directory.on_capabilities(record("r2", 1), now);
  directory.on_capabilities(record("r2", 1), now + 1s);
  EXPECT_EQ(published, 1);
  Peer better = record("r2", 1);
  better.modes = {"explore"};
  directory.on_capabilities(better, now);
  EXPECT_EQ(published, 2);
  EXPECT_THAT(last[0].modes, testing::ElementsAre("explore"));
}

TEST_F(DirectoryTest, SortedByName) {
  for (const char* name : {"r3", "op1", "r2"}) directory.on_capabilities(record(name, 1), now);
  EXPECT_EQ(last[0].name, "op1");
  EXPECT_EQ(last[2].name, "r3");
}

TEST_F(DirectoryTest, ASilentPeerIsAbsentWithinThreeSecondsUntilItsNextPresence) {
  for (const bool station : {false, true}) {
    const std::string name = station ? "op1" : "r2";
    directory.on_capabilities(record(name, 1, station), now);
    directory.on_presence(name, of(name), id(1), now + 1s);
    directory.tick(now + 3400ms);
    EXPECT_TRUE(last.back().present || station);
    directory.tick(now + 3500ms);
    const auto& listed = station ? last.front() : last.back();
    EXPECT_EQ(listed.name, name);
    EXPECT_FALSE(listed.present);
    directory.on_presence(name, of(name), id(2), now + 5s);
    const auto& again = station ? last.front() : last.back();
    EXPECT_TRUE(again.present);
    EXPECT_EQ(again.participant, id(2));
  }
}

TEST_F(DirectoryTest, GoneWithItsParticipant) {
  directory.on_capabilities(record("r2", 1), now);
  directory.on_participant({id(1), false});
  EXPECT_FALSE(last[0].present);
}

TEST_F(DirectoryTest, ReturnUnderAnotherAddressIsTheSameEntry) {
  directory.on_capabilities(record("r2", 1), now);
  directory.on_presence("r2", of("r2"), id(1), now + 1s);
  // Killed and restarted at once: its new capabilities are reported once only.
  Peer back = record("r2", 2);
  back.modes = {"explore"};
  directory.on_capabilities(back, now + 1500ms);
  EXPECT_EQ(last[0].participant, id(1)) << "it may be a forger's";
  directory.tick(now + 2300ms);
  ASSERT_EQ(last.size(), 1u);
  EXPECT_TRUE(last[0].present);
  EXPECT_EQ(last[0].participant, id(2));
  EXPECT_THAT(last[0].modes, testing::ElementsAre("explore"));
  directory.on_participant({id(1), false});
  EXPECT_TRUE(last[0].present);
}

TEST_F(DirectoryTest, ReturnAfterAGoodbyeIsAtOnce) {
  directory.on_capabilities(record("r2", 1), now);
  directory.on_participant({id(1), false});
  directory.on_capabilities(record("r2", 2), now + 100ms);
  EXPECT_TRUE(last[0].present);
  EXPECT_EQ(last[0].participant, id(2));
}

TEST_F(DirectoryTest, APresentParticipantIsNotReplaced) {
  Peer real = record("r2", 1), forged = record("r2", 2), other = record("r2", 3);
  real.modes = {"hold"};
  other.id = of("other");
  directory.on_capabilities(real, now);
  for (int i = 1; i <= 50; ++i) {
    if (i % 10 == 0) directory.on_presence("r2", of("r2"), id(1), now + i * 100ms);
    directory.on_capabilities(forged, now + i * 100ms);
    directory.on_capabilities(other, now + i * 100ms);
    directory.tick(now + i * 100ms);
    ASSERT_EQ(peers.all().size(), 1u);
    EXPECT_EQ(peers.all()[0].participant, id(1));
    EXPECT_THAT(peers.all()[0].modes, testing::ElementsAre("hold"));
  }
}

TEST_F(DirectoryTest, TheOriginalIsRestoredAfterARadioGap) {
  Peer real = record("r2", 1);
  real.modes = {"hold"};
  directory.on_capabilities(real, now);
  directory.on_capabilities(record("r2", 2), now + 2s);
  EXPECT_EQ(last[0].participant, id(2)) << "the first was not heard";
  directory.on_presence("r2", of("r2"), id(1), now + 4s);
  EXPECT_EQ(last[0].participant, id(1));
  EXPECT_THAT(last[0].modes, testing::ElementsAre("hold"));
  directory.on_presence("r2", of("r2"), id(2), now + 4500ms);
  EXPECT_EQ(last[0].participant, id(1));
}

TEST_F(DirectoryTest, ANameWithAnotherIdIsFreeAfterSilence) {
  directory.on_capabilities(record("r2", 1), now);
  Peer other = record("r2", 2);
  other.id = of("other");
  directory.on_capabilities(other, now + 1s);
  EXPECT_EQ(last[0].participant, id(1));
  directory.tick(now + 2500ms);
  EXPECT_EQ(last[0].participant, id(2));
  EXPECT_TRUE(last[0].present);
}

TEST_F(DirectoryTest, ANamesakeDoesNotTakeThePlaceOfASilentHolder) {
  directory.on_capabilities(record("op1", 1, true), now);
  peers.set_holder("op1", of("op1"));
  Peer namesake = record("op1", 2, true);
  namesake.id = of("other");
  const auto speak_until = [&](Duration end) {
    for (Duration at = 1s; at < end; at += 500ms) {
      directory.on_capabilities(namesake, now + at);
      directory.on_presence("op1", namesake.id, id(2), now + at);
      directory.tick(now + at);
    }
  };
  speak_until(60s);
  ASSERT_NE(peers.holder(), nullptr);
  EXPECT_EQ(peers.holder()->participant, id(1));
  EXPECT_EQ(peers.holder()->last_seen, now);
  directory.on_presence("op1", of("op1"), id(1), now + 60s);
  EXPECT_TRUE(peers.holder()->present);

  peers.set_holder("", Id{});  // its lock lapsed
  now += 60s;
  speak_until(5s);
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(last[0].participant, id(2));
}

TEST_F(DirectoryTest, IsBoundedAndIgnoresInvalidNames) {
  directory.on_capabilities(record("no good", 1), now);
  EXPECT_EQ(published, 0);
  for (int i = 0; i < 200; ++i) directory.on_capabilities(record("r" + std::to_string(i), 1), now);
  EXPECT_EQ(peers.all().size(), PeerTable::kCapacity);
}

}  // namespace
}  // namespace adit::agent
