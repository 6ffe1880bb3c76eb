// SPDX-License-Identifier: Apache-2.0
// Findings that change: each station gets the newest revision, and no revision has two contents.
#include <future>

#include "core/exec/live_runtime.hpp"
#include "core/store/file_disk.hpp"
#include "tests/findings/source_bench.hpp"
#include "tests/store/scratch_folder.hpp"

namespace adit::agent {
namespace {

using findings::some;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

TEST_F(FindingSourceTest, AChangedFindingReplacesTheOldOneAtEachStation) {
  report(1);
  run(3s);
  sent.clear();
  ASSERT_TRUE(source->update(content(1, 2)).ok());
  run(3s);
  for (const Operator& op : ops) {
    EXPECT_EQ(at(op, 1).text, "seen 2 times");
    EXPECT_EQ(at(op, 1).revision, 1U);
    EXPECT_THAT(op.changes, ElementsAre(Pair(1, 1)));
    EXPECT_EQ(op.found, 1U) << "it is new once";
  }
  run(60s);
  EXPECT_THAT(sent, ElementsAre(1));
}

TEST_F(FindingSourceTest, AnUpdateThatChangesNothingIsNoRevision) {
  report(1);
  run(3s);
  sent.clear();
  ASSERT_TRUE(source->update(some(1)).ok());
  ASSERT_TRUE(source->update(content(1, 2)).ok());
  ASSERT_TRUE(source->update(some(1)).ok()) << "and back before it had a revision";
  run(10s);
  EXPECT_THAT(sent, IsEmpty());
}

TEST_F(FindingSourceTest, RefusesAnUpdateOfNothingOrWithoutAKind) {
  EXPECT_EQ(source->update(some(1)).reason(), Reason::bad_argument);
  EXPECT_EQ(source->withdraw(1).reason(), Reason::bad_argument);
  report(1);
  findings::Finding f = some(1);
  f.kind.clear();
  EXPECT_EQ(source->update(f).reason(), Reason::bad_argument);
  EXPECT_EQ(report(1), 1U);
  ASSERT_TRUE(source->report(content(1, 9)).ok());
  run(3s);
  EXPECT_EQ(at(ops[0], 1), some(1)) << "a report of an id that is there leaves it";
}

TEST_F(FindingSourceTest, AWithdrawnFindingStaysAndMayComeBack) {
  report(1);
  run(3s);
  ASSERT_TRUE(source->withdraw(1).ok());
  run(3s);
  EXPECT_TRUE(at(ops[0], 1).withdrawn);
  EXPECT_EQ(at(ops[0], 1).text, some(1).text);
  start(ops[0]);
  EXPECT_TRUE(at(ops[0], 1).withdrawn) << "over a restart of the station";
  start_robot();
  run(3s);
  ASSERT_TRUE(source->update(content(1, 2)).ok());
  run(3s);
  for (const Operator& op : ops) {
    EXPECT_FALSE(at(op, 1).withdrawn);
    EXPECT_EQ(at(op, 1).revision, 2U);
  }
}

TEST_F(FindingSourceTest, AWithdrawalHasTheNewestContent) {
  report(1);
  run(3s);
  ASSERT_TRUE(source->update(content(1, 2)).ok());
  ASSERT_TRUE(source->withdraw(1).ok());
  run(3s);
  EXPECT_TRUE(at(ops[0], 1).withdrawn);
  EXPECT_EQ(at(ops[0], 1).text, "seen 2 times");
}

TEST_F(FindingSourceTest, ChangesTenTimesASecondAreOneRevisionEachTwoSeconds) {
  report(1);
  run(3s);
  sent.clear();
  const auto steps_of_one = [this] {
    const auto before = disk->steps();
    EXPECT_TRUE(disk->replace("probe", findings::to_file(some(1))).ok());
    return disk->steps() - before;
  }();
  const auto before = disk->steps();
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(source->update(content(1, i)).ok());
    run(100ms);
  }
  EXPECT_GE(sent.size(), 9U);
  EXPECT_LE(sent.size(), 11U);
  EXPECT_LE(disk->steps() - before, 25 * steps_of_one) << "of findings-known, too";
  run(5s);
  EXPECT_EQ(at(ops[0], 1).text, "seen 199 times") << "the last one counts";
}

TEST_F(FindingSourceTest, ManyThatChangeStarveNoNewOneOnAThinLink) {
  const wire::LinkProfile thin{.name = "thin", .bandwidth = 100e3};
  link.link = &thin;
  params.max_findings = 128;
  start_robot();
  run(1s);
  for (std::uint64_t id = 1; id <= 100; ++id) report(id);
  run(30s);
  EXPECT_EQ(ops[0].desk->all().size(), 100U);
  std::map<std::uint64_t, int> times;
  on_sent = [&times](std::uint32_t, const findings::FindingPiece& piece) {
    for (const findings::Finding& f : piece.findings) ++times[f.key.id];
  };
  for (int i = 0; i < 150; ++i) {
    for (std::uint64_t id = 1; id <= 100; ++id) {
      findings::Finding f = content(id, i);
      f.data.resize(300);
      ASSERT_TRUE(source->update(f).ok());
    }
    if (i == 100) report(1000);
    if (i == 110) {
      EXPECT_TRUE(ops[0].desk->all().contains({"r1", 1000}));
    }
    run(300ms);
  }
  const auto [least, most] =
      std::minmax_element(times.begin(), times.end(), [](auto& a, auto& b) { return a.second < b.second; });
  EXPECT_EQ(times.size(), 101U);
  EXPECT_LT(most->second, 40) << "none is sent more often than it may";
  EXPECT_GE(std::prev(times.end())->first, 1000U);
  times.erase(1000);
  EXPECT_GE(std::min_element(times.begin(), times.end(), [](auto& a, auto& b) { return a.second < b.second; })
                    ->second +
                3,
            most->second)
      << "they take turns; the least: " << least->second;
}

TEST_F(FindingSourceTest, OneThatChangesOnItsWayGoesAgain) {
  report(9);  // Once something arrived, a sender waits for acknowledgements for 3 s.
  run(3s);
  revisions_sent.clear();
  ops[0].answers = ops[1].answers = false;
  report(1);
  run(100ms);
  EXPECT_THAT(revisions_sent, ElementsAre(0));
  ASSERT_TRUE(source->update(content(1, 2)).ok());
  run(2100ms);
  EXPECT_THAT(revisions_sent, ElementsAre(0, 1)) << "the first one is still on its way";
  ops[0].answers = ops[1].answers = true;
  run(10s);
  EXPECT_EQ(source->missing(ops[0].id), 0U);
  EXPECT_EQ(at(ops[0], 1).revision, 1U);
}

TEST_F(FindingSourceTest, ALateAcknowledgementOfAnOlderRevisionDoesNotCountForTheNewer) {
  ops[1].heard = false;
  report(9);
  run(15s);
  revisions_sent.clear();
  ops[0].answers = false;
  report(1);
  run(200ms);
  ASSERT_TRUE(source->update(content(1, 2)).ok());
  ops[0].heard = false;  // The newer one does not arrive.
  run(2100ms);
  ASSERT_THAT(revisions_sent, ElementsAre(0, 1));
  const auto first = transfer::Receipt{session, 2, {3, 0}};
  sender->acknowledged({ops[0].id, ops[0].start, first}, strand->now());
  EXPECT_EQ(at(ops[0], 1).revision, 0U);
  ops[0].heard = ops[0].answers = true;
  run(15s);
  EXPECT_EQ(at(ops[0], 1).revision, 1U);
}

TEST_F(FindingSourceTest, AStationThatHasAnOlderRevisionGetsTheNewerAfterARestartOfTheRobot) {
  ops[1].heard = false;
  report(1);
  run(10s);  // The table of what stations have is written.
  ops[0].heard = false;
  ASSERT_TRUE(source->update(content(1, 2)).ok());
  run(20s);
  start_robot();
  ops[0].heard = true;
  run(6s);
  EXPECT_EQ(at(ops[0], 1).revision, 1U);
  sent.clear();
  run(10s);
  start_robot();
  run(20s);
  EXPECT_THAT(sent, IsEmpty()) << "and once";
}

TEST_F(FindingSourceTest, ARevisionThatACrashLosesWasNotSent) {
  report(1);
  run(3s);
  disk->set_full(true);
  ASSERT_TRUE(source->update(content(1, 2)).ok());
  run(10s);
  EXPECT_THAT(revisions_sent, Each(0)) << "it is not on the disk";
  start_robot();
  disk->set_full(false);
  EXPECT_EQ(source->finding_store().all().at({"r1", 1}).revision, 0U);
  run(3s);
  ASSERT_TRUE(source->update(content(1, 3)).ok());
  run(3s);
  for (const Operator& op : ops) EXPECT_EQ(at(op, 1).text, "seen 3 times");
}

TEST_F(FindingSourceTest, WhileTheDiskFailsTheRevisionBeforeGoesToStationsThatComeLater) {
  ops[1].heard = false;
  report(1);
  run(3s);
  disk->set_full(true);
  ASSERT_TRUE(source->update(content(1, 2)).ok());
  report(2);
  ops[1].heard = true;
  run(10s);
  EXPECT_EQ(at(ops[1], 1), some(1));
  EXPECT_EQ(at(ops[1], 2), some(2)) << "what is new is not held back";
  disk->set_full(false);
  run(5s);
  for (const Operator& op : ops) EXPECT_EQ(at(op, 1).revision, 1U);
}

TEST_F(FindingSourceTest, AnIdThatWasDroppedAndComesBackIsNewerThanWhatStationsHave) {
  ops[1].heard = false;
  report(1, 1);
  run(3s);
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(source->update(content(1, i)).ok());
    run(3s);
  }
  EXPECT_EQ(at(ops[0], 1).revision, 3U);
  for (std::uint64_t id = 2; id <= 9; ++id) report(id, 5);
  ASSERT_FALSE(source->has(1));
  run(3s);
  start_robot();
  findings::Finding again = content(1, 7);
  again.importance = 9;
  ASSERT_TRUE(source->report(again).ok());
  const std::uint64_t drawn = report(0, 9);
  EXPECT_EQ(source->finding_store().all().at({"r1", drawn}).revision, 0U) << "no station can have that id";
  run(6s);
  EXPECT_EQ(at(ops[0], 1).text, "seen 7 times");
  EXPECT_GT(at(ops[0], 1).revision, 3U);
}

TEST_F(FindingSourceTest, AStationThatCannotStoreAChangingFindingGetsTheOthers) {
  ops[1].heard = false;
  report(1, 9);
  run(3s);
  ops[0].disk->set_refused(findings::file_name({"r1", 1}), true);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(source->update(content(1, i)).ok());
    if (i == 50)
      for (std::uint64_t id = 2; id <= 6; ++id) report(id);
    run(300ms);
  }
  EXPECT_LE(source->missing(ops[0].id) + sender->in_flight(), 2U) << "the others are acknowledged";
  EXPECT_LE(revisions_sent.size(), 30U);
  ops[0].disk->set_refused(findings::file_name({"r1", 1}), false);
  run(20s);
  EXPECT_EQ(at(ops[0], 1).text, "seen 99 times");
  EXPECT_EQ(source->missing(ops[0].id), 0U);
}

TEST_F(FindingSourceTest, OneThatAStationCannotStoreGoesSeldomHoweverOftenItChanges) {
  ops[1].heard = false;
  latency = 2s;  // A loss is noticed only after the next change.
  report(1);
  run(20s);
  ops[0].disk->set_refused(findings::file_name({"r1", 1}), true);
  sent.clear();
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(source->update(content(1, i)).ok());
    run(1s);
  }
  EXPECT_GE(sent.size(), 10U);
  EXPECT_LE(sent.size(), 25U);
}

TEST_F(FindingSourceTest, AStationAcknowledgesARevisionOnceItOrANewerOneIsOnItsDisk) {
  int acknowledged = 0;
  const auto hear = [&](std::uint32_t revision) {
    findings::Finding f = content(1, static_cast<int>(revision));
    f.revision = revision;
    EXPECT_TRUE(ops[0].desk->hear("r1", findings::encode({"r1", 1, 0, {f}}), [&] { ++acknowledged; }).ok());
  };
  const auto wait = [this](Duration time) { scheduler.run_until(scheduler.elapsed() + time); };
  hear(3);
  EXPECT_EQ(acknowledged, 0);
  wait(10ms);
  EXPECT_EQ(acknowledged, 1);
  hear(2);
  EXPECT_EQ(acknowledged, 2) << "a newer one is there";
  ops[0].disk->set_full(true);
  hear(4);
  hear(5);
  wait(5s);
  EXPECT_EQ(acknowledged, 2);
  ops[0].disk->set_full(false);
  wait(2s);
  EXPECT_EQ(acknowledged, 4);
  start(ops[0]);
  EXPECT_EQ(at(ops[0], 1).revision, 5U);
  hear(6);
  wait(1ms);  // It is being written.
  hear(7);
  wait(2500us);
  EXPECT_EQ(acknowledged, 5) << "revision 7 is not on the disk";
  wait(10ms);
  EXPECT_EQ(acknowledged, 6);
  EXPECT_THAT(ops[0].changes, SizeIs(4));
}

TEST_F(FindingSourceTest, AStationThatGetsOtherContentOfARevisionKeepsWhatItHas) {
  run(1s);
  for (int i = 1; i <= 2; ++i) {
    findings::Finding f = content(1, i);
    f.revision = 4;
    EXPECT_TRUE(ops[0].desk->hear("r1", findings::encode({"r1", 1, 0, {f}}), [] {}).ok());
    scheduler.run_until(scheduler.elapsed() + 10ms);
  }
  EXPECT_EQ(at(ops[0], 1).text, "seen 1 times");
  EXPECT_THAT(ops[0].changes, IsEmpty());
}

TEST(FindingSourceLive, AChangeThatWaitsIsWrittenAtACleanEnd) {
  const store::ScratchFolder folder;
  LiveRuntime runtime;
  auto writer = runtime.strand("disk");
  auto home = runtime.strand("home");
  const std::shared_ptr<store::Disk> files = store::FileDisk::open(folder.path()).value();
  std::unique_ptr<FindingSource> robot;
  std::promise<void> changed, written;
  home->post([&] {
    robot = std::make_unique<FindingSource>(
        FindingParams{.robot = "r1"}, files, *home, writer,
        FindingSource::Outputs{[](const std::string&) {}, [](bool, const std::string&) {}});
    EXPECT_TRUE(robot->report(some(1)).ok());
    findings::Finding f = some(1);
    f.text = "nearer";
    EXPECT_TRUE(robot->update(f).ok());
    changed.set_value();
  });
  changed.get_future().wait();
  home->end();
  robot->flush();
  writer->post([&] { written.set_value(); });
  ASSERT_EQ(written.get_future().wait_for(20s), std::future_status::ready);
  writer->end();
  const auto finding = findings::from_file(files->read(findings::file_name({"r1", 1})).value().value());
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->text, "nearer");
  EXPECT_EQ(finding->revision, 1U);
}

}  // namespace
}  // namespace adit::agent
