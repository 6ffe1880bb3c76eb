// SPDX-License-Identifier: Apache-2.0
// A robot's set and two stations' desks, over a link that may be away.
#include "robot_agent/findings/sync.hpp"

#include <gmock/gmock.h>

#include "basestation/findings/desk.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "tests/findings/some.hpp"

namespace adit::agent {
namespace {

using findings::some;
using testing::ElementsAre;
using testing::IsEmpty;

class Sync : public testing::Test {
 protected:
  struct Operator {
    FindingSync::StationId id{};
    std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
    std::unique_ptr<station::FindingDesk> desk{};
    bool heard{true}, answers{true};
    std::vector<std::string> trouble{};
  };
  Sync() {
    start_robot();
    for (std::size_t i = 0; i < 2; ++i) {
      ops[i].id[0] = static_cast<std::uint8_t>(i + 1);
      start(ops[i]);
    }
  }
  void start_robot() {
    sync = std::make_unique<FindingSync>(
        params, disk, *strand, nullptr,
        FindingSync::Outputs{[this](const std::string&) { ++full; }, [](bool, const std::string&) {}});
    (void)sync->load();
  }
  void start(Operator& op, std::size_t most = 100) {
    op.desk = std::make_unique<station::FindingDesk>(
        station::DeskParams{most}, op.disk, *strand,
        station::FindingDesk::Outputs{
            [this, &op](const std::string& robot, const std::vector<std::uint64_t>& ids) {
              EXPECT_EQ(robot, "r1");
              if (op.heard && op.answers) sync->acknowledged(op.id, ids, strand->now());
            },
            [](const findings::Finding&) {},
            [&op](const std::string& code, const std::string&) { op.trouble.push_back(code); }});
    (void)op.desk->load();
  }
  /// Rounds of a second each.
  void rounds(int count) {
    for (; count > 0; --count) {
      std::vector<FindingSync::StationId> heard;
      for (const Operator& op : ops)
        if (op.heard) heard.push_back(op.id);
      for (const findings::Finding* f : sync->due(heard, strand->now())) {
        sent.push_back(f->key.id);
        for (Operator& op : ops)
          if (op.heard) op.desk->hear(*f, {});
      }
      for (int i = 0; i < 10; ++i) {
        scheduler.run_until(scheduler.elapsed() + 100ms);
        for (Operator& op : ops) op.desk->tick();
      }
    }
  }
  std::uint64_t report(std::uint64_t id, std::uint8_t importance = 1) {
    const auto made = sync->report(some(id, importance));
    return made ? *made : 0;
  }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Executor> strand{machine->strand("command")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  SyncParams params{.robot = "r1", .max_findings = 8};
  std::array<Operator, 2> ops{};
  std::unique_ptr<FindingSync> sync{};
  std::vector<std::uint64_t> sent{};
  int full{};
};

TEST_F(Sync, EveryStationHasItAndThenNothingIsSent) {
  report(1);
  report(2);
  rounds(3);
  for (const Operator& op : ops) EXPECT_EQ(op.desk->all().size(), 2u);
  sent.clear();
  rounds(60);
  EXPECT_THAT(sent, IsEmpty());
}

TEST_F(Sync, NothingIsSentWhileNobodyIsHeard) {
  ops[0].heard = ops[1].heard = false;
  report(1);
  rounds(100);
  EXPECT_THAT(sent, IsEmpty());
  ops[0].heard = true;
  rounds(2);
  EXPECT_EQ(ops[0].desk->all().size(), 1u);
}

TEST_F(Sync, AfterAGapTheMostImportantComeFirstAFewInARound) {
  ops[0].heard = ops[1].heard = false;
  for (std::uint64_t id = 1; id <= 8; ++id) report(id, static_cast<std::uint8_t>(id));
  rounds(1000);
  ops[0].heard = true;
  rounds(1);
  EXPECT_THAT(sent, ElementsAre(8, 7, 6, 5)) << "whatever the length of the gap";
  rounds(1);
  EXPECT_THAT(sent, ElementsAre(8, 7, 6, 5, 4, 3, 2, 1));
}

TEST_F(Sync, WhatIsNotAcknowledgedIsRepeatedMoreAndMoreSeldom) {
  ops[0].answers = false;
  ops[1].heard = false;
  report(1);
  rounds(100);
  EXPECT_GE(sent.size(), 6u);
  EXPECT_LE(sent.size(), 12u);
  ops[0].answers = true;
  rounds(20);
  sent.clear();
  rounds(60);
  EXPECT_THAT(sent, IsEmpty());
}

TEST_F(Sync, AStationThatComesLaterGetsAllOfThem) {
  ops[1].heard = false;
  for (std::uint64_t id = 1; id <= 8; ++id) report(id);
  rounds(10);
  EXPECT_EQ(ops[0].desk->all().size(), 8u);
  ops[1].heard = true;
  rounds(40);
  EXPECT_EQ(ops[1].desk->all().size(), 8u);
}

TEST_F(Sync, AStationHeardAgainGetsAtOnceWhatWasRepeatedSeldomBefore) {
  ops[0].answers = ops[1].answers = false;  // sent into a link that is away already
  report(1);
  rounds(40);
  ops[0].heard = ops[1].heard = false;
  rounds(1);
  ops[0].answers = ops[1].answers = true;
  ops[1].heard = true;
  sent.clear();
  rounds(2);
  EXPECT_THAT(sent, ElementsAre(1));
  ops[0].heard = true;
  rounds(2);
  EXPECT_THAT(sent, ElementsAre(1, 1)) << "the other one has it, this one does not";
}

TEST_F(Sync, SurvivesARestartOfTheRobot) {
  ops[1].heard = false;
  report(1);
  rounds(10);
  report(2);
  ops[0].heard = false;
  rounds(6);
  start_robot();
  EXPECT_EQ(sync->size(), 2u);
  sent.clear();
  ops[0].heard = true;
  rounds(3);
  EXPECT_THAT(sent, ElementsAre(2)) << "the other one is known to be there";
  EXPECT_EQ(ops[0].desk->all().size(), 2u);
}

TEST_F(Sync, SurvivesARestartOfTheStation) {
  report(1);
  rounds(3);
  start(ops[0]);
  EXPECT_EQ(ops[0].desk->all().size(), 1u);
}

TEST_F(Sync, AStationAcknowledgesOnlyWhatIsOnItsDisk) {
  ops[1].heard = false;
  ops[0].disk->set_full(true);
  report(1);
  rounds(30);
  EXPECT_THAT(ops[0].trouble, ElementsAre("store_failing"));
  start(ops[0]);  // its memory is gone
  EXPECT_EQ(ops[0].desk->all().size(), 0u);
  ops[0].disk->set_full(false);
  rounds(40);
  EXPECT_EQ(ops[0].desk->all().size(), 1u) << "the robot still had it";
}

TEST_F(Sync, AFullStationLeavesItWithTheRobot) {
  ops[1].heard = false;
  start(ops[0], 2);
  for (std::uint64_t id = 1; id <= 4; ++id) report(id);
  rounds(60);
  EXPECT_EQ(ops[0].desk->all().size(), 2u);
  EXPECT_THAT(ops[0].trouble, ElementsAre("findings_full")) << "told once";
  EXPECT_EQ(sync->size(), 4u);
}

TEST_F(Sync, WhenFullWhatAStationHasIsGivenUpFirst) {
  ops[1].heard = false;
  report(1, 9);
  rounds(3);
  ops[0].heard = false;
  for (std::uint64_t id = 2; id <= 8; ++id) report(id, 1);
  EXPECT_EQ(report(9, 1), 9u);
  EXPECT_FALSE(sync->finding_store().all().contains({"r1", 1}));
  EXPECT_EQ(sync->overflowed(), 0u) << "nothing was lost: a station has it";
  EXPECT_EQ(full, 0);
}

TEST_F(Sync, WhenFullWhatMattersLeastIsGivenUpAndReported) {
  ops[0].heard = ops[1].heard = false;
  for (std::uint64_t id = 1; id <= 8; ++id) report(id, static_cast<std::uint8_t>(id));
  EXPECT_EQ(report(20, 5), 20u);
  EXPECT_FALSE(sync->finding_store().all().contains({"r1", 1}));
  EXPECT_EQ(report(21, 2), 0u) << "matters no more than what is there";
  EXPECT_EQ(report(22, 5), 22u);
  EXPECT_EQ(sync->size(), 8u);
  EXPECT_EQ(sync->overflowed(), 3u);
  EXPECT_EQ(full, 1) << "told once";
}

TEST_F(Sync, GivesAnIdToOneThatHasNone) {
  const std::uint64_t a = report(0), b = report(0);
  EXPECT_NE(a, 0u);
  EXPECT_NE(a, b);
  EXPECT_EQ(sync->size(), 2u);
}

TEST_F(Sync, RefusesWhatIsNoFinding) {
  findings::Finding f = some(1);
  f.kind.clear();
  EXPECT_EQ(sync->report(f).reason(), Reason::bad_argument);
}

TEST_F(Sync, IgnoresAcknowledgementsOfWhatItDoesNotHave) {
  const std::vector<std::uint64_t> ids{7, 8, 9};
  sync->acknowledged(ops[0].id, ids, strand->now());
  report(7);
  rounds(2);
  EXPECT_THAT(sent, ElementsAre(7));
}

}  // namespace
}  // namespace adit::agent
