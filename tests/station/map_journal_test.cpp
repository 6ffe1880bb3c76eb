// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/map_journal.hpp"

#include <gmock/gmock.h>

#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"

namespace adit::station {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class MapJournalTest : public testing::Test {
 protected:
  /// A start of the station; returns what the disk had.
  LoadedJournal restart(MapJournalParams params = {}) {
    stored.clear();
    journal.emplace(params, disk, *strand, [this](const std::string& text) { troubles.push_back(text); });
    LoadedJournal loaded = journal->load();
    if (loaded.start == 0 || loaded.unfinished)
      journal->begin(loaded.start == 0 ? ++start : loaded.start, loaded.pieces);
    else
      journal->resume(loaded.start, loaded.bytes);
    return loaded;
  }
  void add(std::uint32_t id, std::size_t bytes = 100) {
    journal->add({"r1", 1, store::Bytes(bytes, static_cast<std::uint8_t>(id))},
                 [this, id] { stored.push_back(id); });
  }
  void run(Duration span) { scheduler.run_until(scheduler.elapsed() + span); }
  static std::vector<int> contents(const LoadedJournal& loaded) {
    std::vector<int> out;
    for (const JournalPiece& piece : loaded.pieces)
      out.push_back(piece.data.empty() ? -1 : piece.data.front());
    return out;
  }
  store::Bytes file() { return disk->read(MapJournal::kFile)->value(); }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("op1", 5s)};
  std::shared_ptr<Strand> strand{machine->strand("station")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::vector<std::uint32_t> stored{};
  std::vector<std::string> troubles{};
  std::optional<MapJournal> journal{};
  std::uint32_t start{40};
};

TEST_F(MapJournalTest, APieceIsStoredOnceItIsWrittenAndIsThereAfterARestartUnderTheSameStart) {
  EXPECT_EQ(restart().start, 0U);
  add(1);
  add(2);
  EXPECT_THAT(stored, IsEmpty());
  run(1s);
  EXPECT_THAT(stored, ElementsAre(1, 2));
  add(3);
  run(1s);
  add(4);  // Not written yet when the station ends.
  const LoadedJournal loaded = restart();
  EXPECT_EQ(loaded.start, 41U);
  EXPECT_EQ(loaded.lost, "");
  EXPECT_THAT(contents(loaded), ElementsAre(1, 2, 3));
  EXPECT_EQ(loaded.pieces[0].robot, "r1");
  EXPECT_EQ(loaded.pieces[0].kind, 1);
  EXPECT_EQ(loaded.pieces[0].data.size(), 100U);
  add(5);
  run(1s);
  EXPECT_THAT(contents(restart()), ElementsAre(1, 2, 3, 5));
}

TEST_F(MapJournalTest, AWriteThatAPowerCutEndsLosesOnlyWhatWasNotAcknowledged) {
  for (std::uint64_t step = 0; step < 400; step += 7) {
    disk = std::make_shared<store::MemoryDisk>(step);
    restart();
    add(1);
    run(1s);
    disk->cut_power_after(step);
    add(2);
    run(1s);
    const bool acknowledged = stored.size() == 2;
    disk->power_up();
    const LoadedJournal loaded = restart();
    const std::vector<int> found = contents(loaded);
    ASSERT_FALSE(found.empty()) << step;
    EXPECT_EQ(found[0], 1) << step;
    if (acknowledged) {
      EXPECT_THAT(found, ElementsAre(1, 2)) << step;
    }
    add(3);
    run(1s);
    EXPECT_EQ(contents(restart()).back(), 3) << step;
  }
}

TEST_F(MapJournalTest, AByteThatIsDamagedMakesTheStartANewOne) {
  restart();
  for (const std::uint32_t id : {1U, 2U, 3U}) {
    add(id);
    run(1s);
  }
  const store::Bytes good = file();
  for (std::size_t at = 0; at < good.size(); ++at) {
    store::Bytes bad = good;
    bad[at] ^= 0x10;
    disk->plant(MapJournal::kFile, bad);
    journal.emplace(MapJournalParams{}, disk, *strand, nullptr);
    const LoadedJournal loaded = journal->load();
    EXPECT_EQ(loaded.start, 0U) << at;
    EXPECT_THAT(loaded.lost, HasSubstr("damaged")) << at;
  }
  for (std::size_t bytes = 0; bytes < good.size(); ++bytes) {
    disk->plant(MapJournal::kFile,
                store::Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(bytes)));
    journal.emplace(MapJournalParams{}, disk, *strand, nullptr);
    (void)journal->load();  // Whatever it has, it is read within its bounds.
  }
}

TEST_F(MapJournalTest, AFullDiskLeavesTheMapInMemoryAndTheNextStartIsNew) {
  restart();
  add(1);
  run(1s);
  disk->set_full(true);
  add(2);
  run(1s);
  EXPECT_THAT(stored, ElementsAre(1)) << "what was not written comes again";
  EXPECT_THAT(troubles, ElementsAre(HasSubstr("no space left")));
  add(2);
  EXPECT_THAT(stored, ElementsAre(1, 2)) << "in memory";
  disk->set_full(false);
  const LoadedJournal loaded = restart();
  EXPECT_EQ(loaded.start, 0U);
  EXPECT_THAT(loaded.pieces, IsEmpty());
}

TEST_F(MapJournalTest, AFileThatCanBeNeitherWrittenNorRemovedStoresNothing) {
  restart();
  disk->set_refused(MapJournal::kFile, true);
  add(1);
  run(3s);
  add(2);
  run(10s);
  EXPECT_THAT(stored, IsEmpty());
  EXPECT_EQ(troubles.size(), 1U) << "said once";
  disk->set_refused(MapJournal::kFile, false);
  run(10s);
  EXPECT_EQ(troubles.size(), 2U);
  add(3);
  EXPECT_THAT(stored, testing::Contains(3U));
}

TEST_F(MapJournalTest, AFileThatGrowsTooLongIsGivenUp) {
  restart({.max_bytes = 1000});
  for (std::uint32_t id = 1; id <= 20; ++id) {
    add(id);
    run(1s);
  }
  EXPECT_EQ(stored.size(), 20U);
  EXPECT_EQ(troubles.size(), 1U);
  EXPECT_EQ(restart().start, 0U);
}

TEST_F(MapJournalTest, AFileThatIsWrittenAgainAndStaysLongIsGivenUp) {
  int packed = 0;
  const auto all = [&packed] {
    ++packed;
    return [] { return std::vector<JournalPiece>(6, {"r1", 1, store::Bytes(100, 7)}); };
  };
  journal.emplace(
      MapJournalParams{.max_bytes = 1000}, disk, *strand,
      [this](const std::string& text) { troubles.push_back(text); }, all);
  (void)journal->load();
  journal->begin(41, {});
  for (std::uint32_t id = 1; id <= 30; ++id) {
    add(id);
    run(1s);
  }
  EXPECT_EQ(packed, 1);
  EXPECT_EQ(troubles.size(), 1U);
  add(31);
  EXPECT_EQ(stored.back(), 31U) << "in memory";
  EXPECT_EQ(restart().start, 0U);
}

TEST_F(MapJournalTest, AStartThatEndedIsStoredAsSuchOnce) {
  restart();
  add(1);
  journal->end_start([this] { stored.push_back(100); });
  journal->end_start([this] { stored.push_back(101); });
  EXPECT_THAT(stored, IsEmpty());
  run(1s);
  EXPECT_THAT(stored, ElementsAre(1, 100)) << "the second one comes again";
  const std::size_t bytes = file().size();
  journal->end_start([this] { stored.push_back(102); });
  EXPECT_THAT(stored, ElementsAre(1, 100, 102));
  add(2);
  run(1s);
  EXPECT_GT(file().size(), bytes);
  const LoadedJournal loaded = restart();
  EXPECT_EQ(loaded.start, 0U);
  EXPECT_EQ(loaded.lost, "");
  EXPECT_THAT(contents(loaded), ElementsAre(1, 2));
}

TEST_F(MapJournalTest, ARobotThatWasForgottenIsNotReadUntilItIsHeardAgain) {
  restart();
  add(1);
  journal->forget("r2");
  add(2);
  journal->forget("r1");
  add(3);
  run(1s);
  EXPECT_THAT(stored, ElementsAre(1, 2, 3));
  const LoadedJournal loaded = restart();
  EXPECT_EQ(loaded.start, 0U);
  EXPECT_THAT(contents(loaded), ElementsAre(3));
}

TEST_F(MapJournalTest, WhatWaitsForTheDiskIsBounded) {
  restart({.max_waiting = 1000});
  for (std::uint32_t id = 1; id <= 20; ++id) add(id);
  run(1s);
  EXPECT_EQ(stored.size(), 10U);
}

}  // namespace
}  // namespace adit::station
