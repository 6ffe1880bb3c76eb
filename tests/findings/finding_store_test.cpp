// SPDX-License-Identifier: Apache-2.0
#include "core/findings/finding_store.hpp"

#include <gmock/gmock.h>

#include <future>
#include <thread>

#include "core/exec/live_runtime.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/store/file_disk.hpp"
#include "core/store/memory_disk.hpp"
#include "core/store/state_file.hpp"
#include "tests/findings/some.hpp"
#include "tests/store/scratch_folder.hpp"

namespace adit::findings {
namespace {

using testing::ElementsAre;

class FindingStoreTest : public testing::Test {
 protected:
  void make(FindingStoreParams params = {}) {
    finding_store = std::make_unique<FindingStore>(
        params, disk, *strand, nullptr,
        FindingStore::Outputs{
            [this](const Key& key, std::uint32_t revision) {
              stored.push_back(key.id);
              revisions.push_back(revision);
            },
            [this](bool failing, const std::string&) { reported.push_back(failing ? "failing" : "works"); }});
    loaded = finding_store->load();
  }
  void run(Duration time) { scheduler.run_until(scheduler.elapsed() + time); }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Executor> strand{machine->strand("command")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::vector<std::uint64_t> stored{};
  std::vector<std::uint32_t> revisions{};
  std::vector<std::string> reported{};
  std::unique_ptr<FindingStore> finding_store{};
  LoadReport loaded{};
};

TEST_F(FindingStoreTest, KeepsOverARestart) {
  make();
  EXPECT_TRUE(finding_store->put(some(1)));
  EXPECT_TRUE(finding_store->put(some(2)));
  EXPECT_FALSE(finding_store->is_stored({"r1", 1}));
  run(20ms);
  EXPECT_THAT(stored, ElementsAre(1, 2));
  EXPECT_TRUE(finding_store->is_stored({"r1", 2}));
  make();
  EXPECT_EQ(finding_store->all().size(), 2u);
  EXPECT_EQ(finding_store->all().at({"r1", 2}), some(2));
}

TEST_F(FindingStoreTest, HasOneFindingOfAKeyAndOneContentOfARevision) {
  make();
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(finding_store->put(some(1)));
  Finding other = some(1);
  other.text = "another one under the same key";
  EXPECT_TRUE(finding_store->put(other));
  EXPECT_EQ(finding_store->all().size(), 1u);
  EXPECT_EQ(finding_store->all().at({"r1", 1}), some(1)) << "it stays as it was first";
}

Finding revised(std::uint64_t id, std::uint32_t revision) {
  Finding f = some(id);
  f.revision = revision;
  f.text = "revision " + std::to_string(revision);
  return f;
}

TEST_F(FindingStoreTest, TheNewestRevisionReplacesOlderOnesAlsoOnTheDisk) {
  make();
  for (const std::uint32_t revision : {0, 3, 2, 5, 4, 5, 0}) {
    EXPECT_TRUE(finding_store->put(revised(1, revision)));
    run(20ms);
  }
  EXPECT_EQ(finding_store->all().at({"r1", 1}), revised(1, 5));
  EXPECT_THAT(revisions, ElementsAre(0, 3, 5));
  make();
  EXPECT_EQ(finding_store->all().at({"r1", 1}), revised(1, 5));
  EXPECT_TRUE(finding_store->put(revised(1, 4)));
  run(20ms);
  make();
  EXPECT_EQ(finding_store->all().at({"r1", 1}), revised(1, 5)) << "nor over a restart";
}

TEST_F(FindingStoreTest, ARevisionThatComesDuringAWriteIsWrittenNext) {
  make();
  EXPECT_TRUE(finding_store->put(revised(1, 1)));
  run(1ms);
  EXPECT_TRUE(finding_store->put(revised(1, 2)));
  run(3ms);
  EXPECT_THAT(revisions, ElementsAre(1)) << "the batch had the revision before";
  EXPECT_FALSE(finding_store->is_stored({"r1", 1}));
  run(20ms);
  EXPECT_THAT(revisions, ElementsAre(1, 2));
  EXPECT_TRUE(finding_store->is_stored({"r1", 1}));
  make();
  EXPECT_EQ(finding_store->all().at({"r1", 1}), revised(1, 2));
}

TEST_F(FindingStoreTest, FindingsThatChangeAllTheTimeDelayNoOther) {
  make();
  for (std::uint64_t id = 1; id <= 40; ++id) EXPECT_TRUE(finding_store->put(revised(id, 1)));
  EXPECT_TRUE(finding_store->put(some(100)));
  for (std::uint32_t revision = 2; revision < 12; ++revision) {
    for (std::uint64_t id = 1; id <= 40; ++id) EXPECT_TRUE(finding_store->put(revised(id, revision)));
    run(4ms);
  }
  EXPECT_TRUE(finding_store->is_stored({"r1", 100}));
}

TEST_F(FindingStoreTest, AFullStoreTakesNewRevisions) {
  make({.max_findings = 1});
  EXPECT_TRUE(finding_store->put(revised(1, 0)));
  EXPECT_TRUE(finding_store->put(revised(1, 1)));
  EXPECT_FALSE(finding_store->put(some(2)));
  EXPECT_EQ(finding_store->all().at({"r1", 1}), revised(1, 1));
}

TEST_F(FindingStoreTest, ReadsFilesOfVersion1AndReplacesThem) {
  disk->plant(file_name({"r1", 7}), file_of_version(1, some(7)));
  make();
  EXPECT_EQ(loaded, LoadReport{});
  EXPECT_EQ(finding_store->all().at({"r1", 7}), some(7));
  EXPECT_TRUE(finding_store->put(revised(7, 1)));
  run(20ms);
  make();
  EXPECT_EQ(finding_store->all().at({"r1", 7}), revised(7, 1));
}

TEST_F(FindingStoreTest, IsBounded) {
  make({.max_findings = 3});
  for (std::uint64_t id = 1; id <= 3; ++id) EXPECT_TRUE(finding_store->put(some(id)));
  EXPECT_TRUE(finding_store->full());
  EXPECT_FALSE(finding_store->put(some(4)));
  EXPECT_TRUE(finding_store->put(some(3))) << "it has that one";
  finding_store->drop({"r1", 1});
  EXPECT_TRUE(finding_store->put(some(4)));
  run(50ms);
  make({.max_findings = 3});
  EXPECT_EQ(finding_store->all().size(), 3u);
  EXPECT_FALSE(finding_store->all().contains({"r1", 1})) << "its file went, too";
}

TEST_F(FindingStoreTest, ABurstIsWrittenInBatches) {
  make();
  for (std::uint64_t id = 1; id <= 100; ++id) EXPECT_TRUE(finding_store->put(some(id)));
  run(4ms);
  EXPECT_EQ(stored.size(), 1u);
  run(4ms);
  EXPECT_EQ(stored.size(), 17u);
  run(100ms);
  EXPECT_EQ(stored.size(), 100u);
}

TEST_F(FindingStoreTest, DamagedFilesAreStoredUnderAnotherName) {
  make();
  EXPECT_TRUE(finding_store->put(some(1)));
  run(20ms);
  disk->plant(file_name({"r1", 2}), store::Bytes(50, 'x'));
  disk->plant(file_name({"r1", 3}), to_file(some(4)));  // in another one's place
  disk->plant("state", store::Bytes(5, 'x'));
  make();
  EXPECT_EQ(loaded.damaged, 2u);
  EXPECT_EQ(finding_store->all().size(), 1u);
  EXPECT_EQ(disk->read(file_name({"r1", 2}) + ".bad").value(), store::Bytes(50, 'x'));
  EXPECT_EQ(disk->read(file_name({"r1", 3}) + ".bad").value(), to_file(some(4)));
  make();
  EXPECT_EQ(loaded, LoadReport{}) << "reported once";
  EXPECT_TRUE(disk->read("state").value()) << "what is not its own stays";
}

TEST_F(FindingStoreTest, FilesOfANewerVersionStayAsTheyAre) {
  const store::Bytes newer = store::encode_envelope({{'F', 'I', 'N', 'D'}, 4, 1024}, 0, store::Bytes(40, 1));
  disk->plant(file_name({"r1", 2}), newer);
  make();
  EXPECT_EQ(loaded.newer, 1u);
  EXPECT_TRUE(finding_store->all().empty());
  EXPECT_EQ(disk->read(file_name({"r1", 2})).value(), newer);
  EXPECT_TRUE(finding_store->put(some(2)));
  run(20ms);
  EXPECT_EQ(disk->read(file_name({"r1", 2})).value(), to_file(some(2)));
  EXPECT_EQ(disk->read(file_name({"r1", 2}) + ".aside").value(), newer) << "not overwritten either";
}

TEST_F(FindingStoreTest, FilesThatCannotBeReadNowAreThereLater) {
  make();
  EXPECT_TRUE(finding_store->put(some(1)));
  EXPECT_TRUE(finding_store->put(some(2)));
  run(20ms);
  disk->set_refused(file_name({"r1", 1}), true);
  make();
  EXPECT_EQ(loaded.unreadable, 1u);
  EXPECT_EQ(finding_store->all().size(), 1u);
  disk->set_refused(file_name({"r1", 1}), false);
  make();
  EXPECT_EQ(finding_store->all().size(), 2u);
}

TEST_F(FindingStoreTest, WithALowerBoundTheMostImportantAreLoadedAndNoneIsDeleted) {
  make();
  for (std::uint64_t id = 1; id <= 6; ++id)
    EXPECT_TRUE(finding_store->put(some(id, static_cast<std::uint8_t>(id))));
  for (const std::uint32_t revision : {7, 3}) {
    Finding f = some(revision == 7 ? 2 : 3, revision == 7 ? 2 : 3);
    f.revision = revision;
    EXPECT_TRUE(finding_store->put(f));
  }
  run(50ms);
  make({.max_findings = 2});
  EXPECT_EQ(loaded.surplus, 4u);
  EXPECT_EQ(loaded.surplus_revision, 7u);
  EXPECT_EQ(finding_store->all().size(), 2u);
  EXPECT_TRUE(finding_store->all().contains({"r1", 6}));
  EXPECT_TRUE(finding_store->all().contains({"r1", 5}));
  make();
  EXPECT_EQ(finding_store->all().size(), 6u);
}

TEST_F(FindingStoreTest, TheNumberOfDamagedFilesIsBounded) {
  make();
  for (std::uint64_t id = 1; id <= 200; ++id) disk->plant(file_name({"r1", id}), store::Bytes(9, 'x'));
  make();
  EXPECT_EQ(loaded.damaged, 200u);
  const auto names = disk->list().value();
  EXPECT_EQ(names.size(), 200u) << "nothing is deleted";
  EXPECT_EQ(
      std::count_if(names.begin(), names.end(), [](const std::string& n) { return n.ends_with(".bad"); }),
      64);
}

TEST_F(FindingStoreTest, OneFileThatCannotBeWrittenBlocksNoOther) {
  make();
  disk->set_refused(file_name({"r1", 1}), true);
  for (std::uint64_t id = 1; id <= 40; ++id) EXPECT_TRUE(finding_store->put(some(id)));
  run(1500ms);
  EXPECT_EQ(stored.size(), 39u);
  EXPECT_FALSE(finding_store->is_stored({"r1", 1}));
  EXPECT_THAT(reported, ElementsAre("failing"));
  disk->set_refused(file_name({"r1", 1}), false);
  run(2s);
  EXPECT_TRUE(finding_store->is_stored({"r1", 1}));
  EXPECT_THAT(reported, ElementsAre("failing", "works"));
}

TEST_F(FindingStoreTest, AFullDiskIsTriedOnceARound) {
  make();
  disk->set_full(true);
  for (std::uint64_t id = 1; id <= 64; ++id) EXPECT_TRUE(finding_store->put(some(id)));
  run(100ms);
  const auto before = disk->steps();
  run(800ms);
  EXPECT_EQ(disk->steps(), before) << "no batch follows a batch of which nothing could be written";
  EXPECT_THAT(reported, ElementsAre("failing"));
}

TEST(FindingStoreLive, WritesUnsavedFindingsAtACleanEnd) {
  const store::ScratchFolder folder;
  LiveRuntime runtime;
  auto writer = runtime.strand("disk");
  auto home = runtime.strand("home");
  const std::shared_ptr<store::Disk> disk = store::FileDisk::open(folder.path()).value();
  std::unique_ptr<FindingStore> finding_store;
  std::promise<void> reported, written;
  home->post([&] {
    finding_store = std::make_unique<FindingStore>(
        FindingStoreParams{}, disk, *home, writer,
        FindingStore::Outputs{[](const Key&, std::uint32_t) {}, [](bool, const std::string&) {}});
    for (std::uint64_t id = 1; id <= 100; ++id) EXPECT_TRUE(finding_store->put(some(id)));
    reported.set_value();
  });
  reported.get_future().wait();
  home->end();
  finding_store->flush();
  writer->post([&] { written.set_value(); });
  ASSERT_EQ(written.get_future().wait_for(std::chrono::seconds(20)), std::future_status::ready);
  writer->end();
  EXPECT_EQ(disk->list().value().size(), 100u);
}

// A strand that is flooded drops posts, also the one that says that a batch was written.
TEST(FindingStoreLive, ALostCompletionDoesNotEndItsWrites) {
  const store::ScratchFolder folder;
  LiveParams params;
  params.queue = 1;
  LiveRuntime runtime(params);
  auto writer = runtime.strand("disk");
  auto home = runtime.strand("home");
  const std::shared_ptr<store::Disk> disk = store::FileDisk::open(folder.path()).value();
  std::promise<void> began, go, saved;
  std::unique_ptr<FindingStore> finding_store;
  home->post([&] {
    finding_store = std::make_unique<FindingStore>(
        FindingStoreParams{.retry = 50ms}, disk, *home, writer,
        FindingStore::Outputs{[&](const Key&, std::uint32_t) { saved.set_value(); },
                              [](bool, const std::string&) {}});
    EXPECT_TRUE(finding_store->put(some(1)));
    began.set_value();
    go.get_future().wait();
  });
  began.get_future().wait();
  home->post([] {});  // fills the queue: the completion has no place
  while (!disk->read(file_name({"r1", 1})).value()) std::this_thread::yield();
  std::promise<void> written;
  writer->post([&] { written.set_value(); });  // comes after the batch, which runs now or has run
  written.get_future().wait();
  go.set_value();
  EXPECT_EQ(saved.get_future().wait_for(std::chrono::seconds(60)), std::future_status::ready);
  std::promise<void> gone;
  home->post([&] {
    finding_store.reset();
    gone.set_value();
  });
  gone.get_future().wait();
}

TEST_F(FindingStoreTest, ReportsAFullDiskAndTriesAgain) {
  make();
  disk->set_full(true);
  EXPECT_TRUE(finding_store->put(some(1)));
  run(3s);
  EXPECT_FALSE(finding_store->is_stored({"r1", 1}));
  disk->set_full(false);
  run(2s);
  EXPECT_TRUE(finding_store->is_stored({"r1", 1}));
  EXPECT_THAT(reported, ElementsAre("failing", "works"));
}

TEST_F(FindingStoreTest, WithoutADiskItIsMemory) {
  disk.reset();
  make();
  EXPECT_TRUE(finding_store->put(some(1)));
  EXPECT_TRUE(finding_store->is_stored({"r1", 1}));
  EXPECT_THAT(stored, ElementsAre(1));
}

TEST_F(FindingStoreTest, ThatGoesDuringAWriteIsNotCalled) {
  make();
  EXPECT_TRUE(finding_store->put(some(1)));
  finding_store.reset();
  run(1s);
  EXPECT_TRUE(stored.empty());
}

}  // namespace
}  // namespace adit::findings
