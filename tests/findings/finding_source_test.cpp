// SPDX-License-Identifier: Apache-2.0
// Each station gets a robot's findings once, whatever is away, restarted or full meanwhile.
#include "tests/findings/source_bench.hpp"

namespace adit::agent {
namespace {

using findings::some;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;

TEST_F(FindingSourceTest, EveryStationHasItAndThenNothingIsSent) {
  report(1);
  report(2);
  run(3s);
  for (const Operator& op : ops) EXPECT_EQ(op.desk->all().size(), 2u);
  EXPECT_THAT(sent, ElementsAre(1, 2)) << "once for both, in one piece";
  EXPECT_EQ(kinds.size(), 1u);
  run(60s);
  EXPECT_EQ(sent.size(), 2u);
}

TEST_F(FindingSourceTest, NothingIsSentWhileNoStationIsHeard) {
  run(1s);
  gap(20s);
  report(1);
  run(100s);
  EXPECT_THAT(sent, IsEmpty());
  ops[0].heard = true;
  run(6s);
  EXPECT_EQ(ops[0].desk->all().size(), 1u);
}

TEST_F(FindingSourceTest, AfterAGapTheMostImportantComeFirst) {
  run(1s);
  gap(20s);
  for (std::uint64_t id = 1; id <= 8; ++id) report(id, static_cast<std::uint8_t>(id));
  run(1000s);
  ops[0].heard = true;
  run(6s);
  EXPECT_THAT(sent, ElementsAre(8, 7, 6, 5, 4, 3, 2, 1)) << "whatever the length of the gap";
}

TEST_F(FindingSourceTest, RepeatsUnacknowledgedFindingsAtGrowingIntervals) {
  run(1s);
  ops[0].disk->set_full(true);  // Its receipts come, but not for the finding.
  ops[1].heard = false;
  report(1);
  run(100s);
  EXPECT_GE(sent.size(), 6u);
  EXPECT_LE(sent.size(), 12u);
  ops[0].disk->set_full(false);
  run(20s);
  sent.clear();
  run(60s);
  EXPECT_THAT(sent, IsEmpty());
}

TEST_F(FindingSourceTest, AStationThatComesLaterGetsAllOfThem) {
  ops[1].heard = false;
  for (std::uint64_t id = 1; id <= 8; ++id) report(id);
  run(10s);
  EXPECT_EQ(ops[0].desk->all().size(), 8u);
  EXPECT_EQ(ops[1].desk->all().size(), 0u);
  ops[1].heard = true;
  run(10s);
  EXPECT_EQ(ops[1].desk->all().size(), 8u);
}

TEST_F(FindingSourceTest, SendsAtOnceToAStationThatIsHeardAgain) {
  run(1s);
  for (Operator& op : ops) op.disk->set_full(true);
  report(1);
  run(60s);
  gap(20s);
  for (Operator& op : ops) op.disk->set_full(false);
  start(ops[1]);
  ops[1].heard = true;
  sent.clear();
  run(6s);
  EXPECT_THAT(sent, ElementsAre(1));
  EXPECT_EQ(ops[1].desk->all().size(), 1u);
  ops[0].heard = true;
  run(6s);
  EXPECT_THAT(sent, ElementsAre(1, 1)) << "the other one has it, this one does not";
}

TEST_F(FindingSourceTest, SurvivesARestartOfTheRobot) {
  ops[1].heard = false;
  report(1);
  run(10s);
  ops[0].heard = false;
  report(2);
  run(20s);
  start_robot();
  EXPECT_EQ(source->size(), 2u);
  sent.clear();
  ops[0].heard = true;
  run(6s);
  EXPECT_THAT(sent, ElementsAre(2)) << "the other one is known to be there";
  EXPECT_EQ(ops[0].desk->all().size(), 2u);
}

TEST_F(FindingSourceTest, ARobotThatReplacesAnotherOfItsNameHasFindingsOfItsOwn) {
  const findings::Owner first{1}, second{2};
  params.owner = first;
  start_robot();
  report(7);
  run(1s);
  EXPECT_TRUE(source->update(content(7, 2)).ok());
  run(5s);
  disk = std::make_shared<store::MemoryDisk>();
  params.owner = second;
  start_robot();
  EXPECT_TRUE(source->report(content(7, 1)).ok());
  run(5s);
  const auto& there = ops[0].desk->all();
  ASSERT_EQ(there.size(), 2u);
  EXPECT_EQ(there.at({"r1", 7, first}).text, "seen 2 times");
  EXPECT_EQ(there.at({"r1", 7, second}).text, "seen 1 times");
}

TEST_F(FindingSourceTest, FindingsOfAnEarlierIdentityStayWhatTheyAre) {
  // The first was written before findings had owners; then the file with the identity was lost.
  report(1);
  run(1s);
  params.owner = {1};
  start_robot();
  report(2);
  run(1s);
  params.owner = {2};
  start_robot();
  report(1);
  report(2);
  report(3);
  EXPECT_EQ(source->size(), 3u) << "the first two are known";
  for (const std::uint64_t id : {1, 2, 3}) EXPECT_TRUE(source->update(content(id, 9)).ok());
  run(10s);
  const auto& there = ops[0].desk->all();
  ASSERT_EQ(there.size(), 3u);
  for (const auto& [key, finding] : there) EXPECT_EQ(finding.text, "seen 9 times") << key.id;
  EXPECT_TRUE(there.contains({"r1", 1, {}}));
  EXPECT_TRUE(there.contains({"r1", 2, {1}}));
  EXPECT_TRUE(there.contains({"r1", 3, {2}}));
}

TEST_F(FindingSourceTest, RestartedStationStillHasItsFindings) {
  report(1);
  run(3s);
  ops[0].heard = false;
  start(ops[0]);
  EXPECT_EQ(ops[0].desk->all().size(), 1u);
  sent.clear();
  run(3s);
  report(2);
  ops[0].heard = true;
  run(10s);
  EXPECT_EQ(ops[0].desk->all().size(), 2u);
  EXPECT_THAT(sent, Each(2u)) << "it is known by its identity";
}

TEST_F(FindingSourceTest, RepeatsFindingsInFlightToARestartedStation) {
  run(1s);
  ops[1].heard = false;
  ops[0].disk->set_full(true);
  report(1);
  run(200ms);
  EXPECT_THAT(sent, ElementsAre(1));
  ops[0].disk->set_full(false);
  start(ops[0]);  // Its memory is gone, and with it the finding.
  EXPECT_EQ(ops[0].desk->all().size(), 0u);
  run(6s);
  EXPECT_EQ(ops[0].desk->all().size(), 1u);
}

TEST_F(FindingSourceTest, StationAcknowledgesOnlyFindingsOnItsDisk) {
  ops[1].heard = false;
  ops[0].disk->set_full(true);
  report(1);
  run(30s);
  EXPECT_THAT(ops[0].trouble, ElementsAre("store_failing"));
  start(ops[0]);  // Its memory is gone.
  EXPECT_EQ(ops[0].desk->all().size(), 0u);
  ops[0].disk->set_full(false);
  run(40s);
  EXPECT_EQ(ops[0].desk->all().size(), 1u) << "the robot still had it";
}

TEST_F(FindingSourceTest, AFullStationLeavesItWithTheRobotAndAcknowledgesTheOthers) {
  ops[1].heard = false;
  start(ops[0], 2);
  for (std::uint64_t id = 1; id <= 4; ++id) report(id);
  run(60s);
  EXPECT_EQ(ops[0].desk->all().size(), 2u);
  EXPECT_THAT(ops[0].trouble, ElementsAre("findings_full")) << "reported once";
  EXPECT_EQ(source->size(), 4u);
  std::size_t most = 0;  // Those on their way are not missing.
  for (int second = 0; second < 20; ++second) {
    run(1s);
    most = std::max(most, source->missing(ops[0].id));
  }
  EXPECT_EQ(most, 2u) << "the others came alone, and are acknowledged";
  sent.clear();
  run(60s);
  EXPECT_LE(sent.size(), 9u) << "two findings, each every 16 s";
}

TEST_F(FindingSourceTest, DropsAcknowledgedFindingsFirstWhenFull) {
  ops[1].heard = false;
  report(1, 9);
  run(3s);
  ops[0].heard = false;
  for (std::uint64_t id = 2; id <= 8; ++id) report(id, 1);
  EXPECT_EQ(report(9, 1), 9u);
  EXPECT_FALSE(source->finding_store().all().contains({"r1", 1}));
  EXPECT_EQ(source->overflowed(), 0u) << "nothing was lost: a station has it";
  EXPECT_EQ(full, 0);
}

TEST_F(FindingSourceTest, DropsTheLeastImportantFindingWhenFullAndReportsIt) {
  ops[0].heard = ops[1].heard = false;
  for (std::uint64_t id = 1; id <= 8; ++id) report(id, static_cast<std::uint8_t>(id));
  EXPECT_EQ(report(20, 5), 20u);
  EXPECT_FALSE(source->finding_store().all().contains({"r1", 1}));
  EXPECT_EQ(report(21, 2), 0u) << "matters no more than what is there";
  EXPECT_EQ(report(22, 5), 22u);
  EXPECT_EQ(source->size(), 8u);
  EXPECT_EQ(source->overflowed(), 3u);
  EXPECT_EQ(full, 1) << "reported once";
  ops[0].heard = true;
  run(6s);
  EXPECT_EQ(ops[0].desk->robots().at("r1").stored, 8u);
  EXPECT_EQ(ops[0].desk->robots().at("r1").overflowed, 3u);
}

TEST_F(FindingSourceTest, AFindingThatIsDiscardedOnItsWayHarmsNothing) {
  run(1s);
  ops[0].answers = ops[1].answers = false;
  for (std::uint64_t id = 1; id <= 8; ++id) report(id, 1);
  run(200ms);
  EXPECT_EQ(report(20, 5), 20u);
  ops[0].answers = ops[1].answers = true;
  run(20s);
  EXPECT_EQ(source->missing(ops[0].id), 0u);
  EXPECT_TRUE(ops[0].desk->all().contains({"r1", 20}));
}

TEST_F(FindingSourceTest, GivesAnIdToOneThatHasNone) {
  const std::uint64_t a = report(0), b = report(0);
  EXPECT_NE(a, 0u);
  EXPECT_NE(a, b);
  EXPECT_EQ(source->size(), 2u);
}

TEST_F(FindingSourceTest, RefusesAnInvalidFinding) {
  findings::Finding f = some(1);
  f.kind.clear();
  EXPECT_EQ(source->report(f).reason(), Reason::bad_argument);
}

TEST_F(FindingSourceTest, IgnoresReceiptsOfFindingsThatItDidNotSend) {
  run(1s);
  sender->acknowledged({ops[0].id, ops[0].start, {session, 50, {~std::uint64_t{0}, 0}}}, strand->now());
  report(7);
  run(2s);
  EXPECT_THAT(sent, ElementsAre(7));
}

}  // namespace
}  // namespace adit::agent
