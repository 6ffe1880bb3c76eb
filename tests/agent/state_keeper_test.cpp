// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/state/state_keeper.hpp"

#include <gmock/gmock.h>

#include <condition_variable>
#include <future>

#include "core/exec/live_runtime.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/store/file_disk.hpp"
#include "core/store/memory_disk.hpp"
#include "robot_agent/state/restored.hpp"
#include "tests/store/scratch_folder.hpp"

namespace adit::agent {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Snapshot with_goal(std::uint32_t id) {
  Snapshot s;
  s.behaviour.goal_known = true;
  s.behaviour.goal_id = id;
  return s;
}

class KeeperTest : public testing::Test {
 protected:
  void make(KeeperParams params = {}) {
    keeper =
        std::make_unique<StateKeeper>(params, disk, *strand, nullptr, 0,
                                      StateKeeper::Outputs{[this](bool failing, const std::string& text) {
                                        reported.push_back(failing ? "failing: " + text : "works");
                                      }});
    beat = strand->every(50ms, [this] { keeper->tick(); });
  }
  void save(std::uint32_t goal) {
    keeper->save(with_goal(goal), [] { return std::vector<StoredAnswers>{}; });
  }
  void say_when_safe(const std::string& what) {
    keeper->when_safe([this, what] { said.push_back(what); });
  }
  void run(Duration time) { scheduler.run_until(scheduler.elapsed() + time); }
  std::uint32_t on_disk() {
    const Restored r = restore_state(disk);
    return r.snapshot ? r.snapshot->behaviour.goal_id : 0;
  }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Executor> strand{machine->strand("command")};
  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::vector<std::string> said{}, reported{};
  std::unique_ptr<StateKeeper> keeper{};
  Timer beat{};
};

TEST_F(KeeperTest, AnAnswerWaitsUntilTheStateIsOnDisk) {
  make();
  save(1);
  say_when_safe("accepted");
  run(2ms);
  EXPECT_THAT(said, IsEmpty());
  EXPECT_EQ(on_disk(), 0u);
  run(2ms);
  EXPECT_THAT(said, ElementsAre("accepted"));
  EXPECT_EQ(on_disk(), 1u);
}

TEST_F(KeeperTest, AnAcceptedCommandThatChangedNothingIsWrittenToo) {
  make();
  int written = 0;
  const auto save_after = [&](std::uint64_t accepted) {
    keeper->save(
        with_goal(1),
        [&] {
          ++written;
          return std::vector<StoredAnswers>{};
        },
        accepted);
    return written;
  };
  EXPECT_EQ(save_after(1), 1);
  EXPECT_EQ(save_after(1), 1);
  EXPECT_EQ(save_after(2), 2);
}

TEST_F(KeeperTest, WithNothingToSaveAnAnswerGoesAtOnce) {
  make();
  say_when_safe("first");
  save(1);
  run(10ms);
  save(1);
  say_when_safe("second");
  EXPECT_THAT(said, ElementsAre("first", "second"));
}

TEST_F(KeeperTest, ANewerStateIsWrittenAtOnceAfterAFailedWrite) {
  make();
  disk->set_full(true);
  save(1);
  run(1ms);
  save(2);
  say_when_safe("stopped");  // its write begins when the one before has failed
  run(10ms);
  EXPECT_THAT(said, ElementsAre("stopped"));
}

TEST_F(KeeperTest, StatesThatComeWhileItWritesAreOneMoreWrite) {
  make();
  for (std::uint32_t goal = 1; goal <= 50; ++goal) {
    save(goal);
    say_when_safe(std::to_string(goal));
  }
  run(4ms);
  EXPECT_THAT(said, ElementsAre("1"));
  EXPECT_EQ(on_disk(), 1u);
  run(3ms);
  EXPECT_EQ(said.size(), 50u);
  EXPECT_EQ(said.back(), "50");
  EXPECT_EQ(on_disk(), 50u);
}

TEST_F(KeeperTest, AnAnswerNeverOvertakesTheOneBefore) {
  make();
  save(1);
  say_when_safe("changes");
  say_when_safe("repeat of it");
  EXPECT_THAT(said, IsEmpty()) << "the repeat reports what is not on disk yet";
  run(10ms);
  EXPECT_THAT(said, ElementsAre("changes", "repeat of it"));
}

TEST_F(KeeperTest, AFullDiskDelaysNothingAndIsReportedOnce) {
  make();
  save(1);
  run(10ms);
  disk->set_full(true);
  save(2);
  say_when_safe("two");
  run(10ms);
  save(3);
  say_when_safe("three");
  run(5s);
  EXPECT_THAT(said, ElementsAre("two", "three"));
  EXPECT_EQ(reported.size(), 1u);
  EXPECT_TRUE(keeper->failing());
}

TEST_F(KeeperTest, AStateThatWasNotWrittenIsNotRestoredLater) {
  make();
  save(1);
  run(10ms);
  disk->set_full(true);
  save(2);
  run(10ms);
  const Restored r = restore_state(disk);
  EXPECT_TRUE(r.lost) << "the old state would be a guess";
  EXPECT_FALSE(r.snapshot);
}

TEST_F(KeeperTest, WritesTheNewestStateOnceTheDiskHasRoomAgain) {
  make();
  disk->set_full(true);
  save(1);
  save(2);
  run(2s);
  EXPECT_EQ(on_disk(), 0u);
  disk->set_full(false);
  run(2s);
  EXPECT_EQ(on_disk(), 2u);
  EXPECT_FALSE(keeper->failing());
  EXPECT_EQ(reported.back(), "works");
  EXPECT_EQ(reported.size(), 2u);
}

TEST_F(KeeperTest, WithoutADiskNothingWaits) {
  disk.reset();
  make();
  save(1);
  say_when_safe("at once");
  EXPECT_THAT(said, ElementsAre("at once"));
  run(1s);
  EXPECT_THAT(reported, IsEmpty());
}

TEST_F(KeeperTest, IsBounded) {
  make();
  save(1);
  for (int i = 0; i < 1000; ++i) say_when_safe(std::to_string(i));
  run(10ms);
  EXPECT_EQ(said.size(), 256u);
  EXPECT_EQ(said.back(), "999");
}

TEST_F(KeeperTest, ACrashDuringAWriteLeavesTheStateOfBefore) {
  make();
  save(1);
  run(10ms);
  save(2);
  run(2ms);
  beat.cancel();
  keeper.reset();
  run(1s);
  EXPECT_EQ(on_disk(), 1u);
}

/// A disk that takes its time, as a failing card does.
class SlowDisk final : public store::Disk {
 public:
  bool let_go{false};
  std::mutex mutex{};
  std::condition_variable go{};
  Result<std::vector<std::string>> list() const override { return std::vector<std::string>{}; }
  std::uint64_t free() const override { return 1; }
  std::string where() const override { return "the slow disk"; }

 protected:
  Result<std::optional<store::Bytes>> read_file(const std::string&, std::size_t) const override {
    return std::optional<store::Bytes>{};
  }
  Result<void> write_file(const std::string&, std::span<const std::uint8_t>, bool) override {
    std::unique_lock lock(mutex);
    go.wait(lock, [this] { return let_go; });
    return {};
  }
  Result<void> rename_file(const std::string&, const std::string&) override { return {}; }
  Result<void> remove_file(const std::string&) override { return {}; }
  Result<void> sync_folder() override { return {}; }
};

TEST(KeeperLive, TheNewestStateIsWrittenAtACleanEnd) {
  const store::ScratchFolder folder;
  LiveRuntime runtime;
  const std::shared_ptr<store::Disk> disk = store::FileDisk::open(folder.path()).value();
  auto writer = runtime.strand("disk");
  auto command = runtime.strand("command");
  std::unique_ptr<StateKeeper> keeper;
  std::promise<void> given, written;
  command->post([&] {
    keeper = std::make_unique<StateKeeper>(KeeperParams{}, disk, *command, writer, 0,
                                           StateKeeper::Outputs{[](bool, const std::string&) {}});
    for (std::uint32_t goal = 1; goal <= 3; ++goal)
      keeper->save(with_goal(goal), [] { return std::vector<StoredAnswers>{}; });
    given.set_value();
  });
  given.get_future().wait();
  command->end();
  keeper->flush();
  writer->post([&] { written.set_value(); });
  ASSERT_EQ(written.get_future().wait_for(std::chrono::seconds(20)), std::future_status::ready);
  writer->end();
  const Restored r = restore_state(disk);
  ASSERT_TRUE(r.snapshot);
  EXPECT_EQ(r.snapshot->behaviour.goal_id, 3u);
}

TEST(KeeperLive, ADiskThatDoesNotAnswerHoldsUpNothing) {
  LiveRuntime runtime;
  const auto slow = std::make_shared<SlowDisk>();
  auto writer = runtime.strand("disk");
  auto command = runtime.strand("command");
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::string> log;
  const auto note = [&](const std::string& line) {
    const std::lock_guard lock(mutex);
    log.push_back(line);
    changed.notify_all();
  };
  const auto wait_for = [&](std::size_t lines) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, 60s, [&] { return log.size() >= lines; });
  };
  std::unique_ptr<StateKeeper> keeper;
  Timer beat;
  command->post([&] {
    KeeperParams params;
    params.patience = 100ms;
    keeper = std::make_unique<StateKeeper>(
        params, slow, *command, writer, 0,
        StateKeeper::Outputs{[&](bool failing, const std::string&) { note(failing ? "failing" : "works"); }});
    beat = command->every(10ms, [&] { keeper->tick(); });
    keeper->save(with_goal(1), [] { return std::vector<StoredAnswers>{}; });
    keeper->when_safe([&] { note("accepted"); });
  });
  ASSERT_TRUE(wait_for(2));
  EXPECT_THAT(log, ElementsAre("failing", "accepted"));
  {
    const std::lock_guard lock(slow->mutex);
    slow->let_go = true;
  }
  slow->go.notify_all();
  ASSERT_TRUE(wait_for(3));
  EXPECT_EQ(log.back(), "works");
  writer.reset();
  command.reset();
}

}  // namespace
}  // namespace adit::agent
