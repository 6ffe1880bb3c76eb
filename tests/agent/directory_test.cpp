#include "robot_agent/discovery/directory.hpp"

#include <gmock/gmock.h>

#include "core/exec/virtual_runtime.hpp"

namespace adit::agent {
namespace {

class DirectoryTest : public testing::Test {
 protected:
  DirectoryTest() {
    seen = directory.list().subscribe(*strand, [this](const auto& list) {
      last = *list;
      ++published;
    });
  }
  AgentRecord record(const std::string& name, std::uint8_t participant, bool station = false) {
    AgentRecord r{};
    r.name = name;
    r.participant[0] = participant;
    r.station = station;
    return r;
  }
  wire::ParticipantId id(std::uint8_t participant) { return record("", participant).participant; }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("m", 0s)};
  std::shared_ptr<Executor> strand{machine->strand("s")};
  Directory directory{*strand};
  Subscription seen{};
  AgentList last{};
  int published{};
  Time now{Duration{1h}};
};

TEST_F(DirectoryTest, AppearanceAndChangesArePublishedOnce) {
  directory.capabilities(record("r2", 1), now);
  directory.capabilities(record("r2", 1), now + 1s);
  EXPECT_EQ(published, 1);
  AgentRecord better = record("r2", 1);
  better.modes = {"explore"};
  directory.capabilities(better, now);
  EXPECT_EQ(published, 2);
  EXPECT_THAT(last[0].modes, testing::ElementsAre("explore"));
}

TEST_F(DirectoryTest, SortedByName) {
  for (const char* name : {"r3", "op1", "r2"}) directory.capabilities(record(name, 1), now);
  EXPECT_EQ(last[0].name, "op1");
  EXPECT_EQ(last[2].name, "r3");
}

TEST_F(DirectoryTest, SilentStationIsGoneAfterThreeSecondsAndBackWithItsPresence) {
  directory.capabilities(record("op1", 1, true), now);
  directory.presence("op1", id(1), now + 1s);
  directory.tick(now + 3700ms);
  EXPECT_TRUE(last[0].present);
  directory.tick(now + 3800ms);
  EXPECT_FALSE(last[0].present);
  directory.presence("op1", id(2), now + 5s);
  EXPECT_TRUE(last[0].present);
  EXPECT_EQ(last[0].participant, id(2));
}

TEST_F(DirectoryTest, RobotIsGoneWithItsParticipant) {
  directory.capabilities(record("r2", 1), now);
  directory.tick(now + 100s);
  EXPECT_TRUE(last[0].present);
  directory.participant({id(1), false}, now + 100s);
  EXPECT_FALSE(last[0].present);
}

TEST_F(DirectoryTest, ReturnUnderAnotherAddressIsTheSameEntry) {
  directory.capabilities(record("r2", 1), now);
  directory.capabilities(record("r2", 2), now + 1s);
  directory.participant({id(1), false}, now + 2s);
  ASSERT_EQ(last.size(), 1u);
  EXPECT_TRUE(last[0].present);
  EXPECT_EQ(last[0].participant, id(2));
}

TEST_F(DirectoryTest, BoundedAndPicky) {
  directory.capabilities(record("no good", 1), now);
  EXPECT_EQ(published, 0);
  for (int i = 0; i < 200; ++i) directory.capabilities(record("r" + std::to_string(i), 1), now);
  EXPECT_EQ(directory.agents().size(), Directory::kCapacity);
}

}  // namespace
}  // namespace adit::agent
