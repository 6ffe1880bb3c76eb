#include "core/findings/shelf.hpp"

#include <gmock/gmock.h>

#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "tests/findings/some.hpp"

namespace adit::findings {
namespace {

using testing::ElementsAre;

class ShelfTest : public testing::Test {
 protected:
  void make(ShelfParams params = {}) {
    shelf = std::make_unique<Shelf>(params, disk, *strand, nullptr,
                                    Shelf::Outputs{[this](const Key& key) { kept.push_back(key.id); },
                                                   [this](bool failing, const std::string&) {
                                                     told.push_back(failing ? "failing" : "works");
                                                   }});
    damaged = shelf->load();
  }
  void run(Duration time) { scheduler.run_until(scheduler.elapsed() + time); }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Executor> strand{machine->strand("command")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::vector<std::uint64_t> kept{};
  std::vector<std::string> told{};
  std::unique_ptr<Shelf> shelf{};
  std::size_t damaged{};
};

TEST_F(ShelfTest, KeepsOverARestart) {
  make();
  EXPECT_TRUE(shelf->put(some(1)));
  EXPECT_TRUE(shelf->put(some(2)));
  EXPECT_FALSE(shelf->kept({"r1", 1}));
  run(20ms);
  EXPECT_THAT(kept, ElementsAre(1, 2));
  EXPECT_TRUE(shelf->kept({"r1", 2}));
  make();
  EXPECT_EQ(shelf->all().size(), 2u);
  EXPECT_EQ(shelf->all().at({"r1", 2}), some(2));
}

TEST_F(ShelfTest, IsASet) {
  make();
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(shelf->put(some(1)));
  Finding other = some(1);
  other.text = "another one under the same key";
  EXPECT_TRUE(shelf->put(other));
  EXPECT_EQ(shelf->all().size(), 1u);
  EXPECT_EQ(shelf->all().at({"r1", 1}), some(1)) << "it stays as it was first";
}

TEST_F(ShelfTest, IsBounded) {
  make({.most = 3});
  for (std::uint64_t id = 1; id <= 3; ++id) EXPECT_TRUE(shelf->put(some(id)));
  EXPECT_TRUE(shelf->full());
  EXPECT_FALSE(shelf->put(some(4)));
  EXPECT_TRUE(shelf->put(some(3))) << "it has that one";
  shelf->drop({"r1", 1});
  EXPECT_TRUE(shelf->put(some(4)));
  run(50ms);
  make({.most = 3});
  EXPECT_EQ(shelf->all().size(), 3u);
  EXPECT_FALSE(shelf->all().contains({"r1", 1})) << "its file went, too";
}

TEST_F(ShelfTest, ABurstIsWrittenInBatches) {
  make();
  for (std::uint64_t id = 1; id <= 100; ++id) EXPECT_TRUE(shelf->put(some(id)));
  run(4ms);
  EXPECT_EQ(kept.size(), 1u);
  run(4ms);
  EXPECT_EQ(kept.size(), 17u);
  run(100ms);
  EXPECT_EQ(kept.size(), 100u);
}

TEST_F(ShelfTest, RemovesWhatIsDamaged) {
  make();
  EXPECT_TRUE(shelf->put(some(1)));
  run(20ms);
  disk->plant(file_name({"r1", 2}), store::Bytes(50, 'x'));
  disk->plant(file_name({"r1", 3}), to_file(some(4)));  // in another one's place
  disk->plant("state", store::Bytes(5, 'x'));
  make();
  EXPECT_EQ(damaged, 2u);
  EXPECT_EQ(shelf->all().size(), 1u);
  make();
  EXPECT_EQ(damaged, 0u);
  EXPECT_TRUE(disk->read("state").value()) << "what is not its own stays";
}

TEST_F(ShelfTest, AFullDiskIsToldAndTriedAgain) {
  make();
  disk->set_full(true);
  EXPECT_TRUE(shelf->put(some(1)));
  run(3s);
  EXPECT_FALSE(shelf->kept({"r1", 1}));
  disk->set_full(false);
  run(2s);
  EXPECT_TRUE(shelf->kept({"r1", 1}));
  EXPECT_THAT(told, ElementsAre("failing", "works"));
}

TEST_F(ShelfTest, WithoutADiskItIsMemory) {
  disk.reset();
  make();
  EXPECT_TRUE(shelf->put(some(1)));
  EXPECT_TRUE(shelf->kept({"r1", 1}));
  EXPECT_THAT(kept, ElementsAre(1));
}

TEST_F(ShelfTest, ThatGoesDuringAWriteIsNotCalled) {
  make();
  EXPECT_TRUE(shelf->put(some(1)));
  shelf.reset();
  run(1s);
  EXPECT_TRUE(kept.empty());
}

}  // namespace
}  // namespace adit::findings
