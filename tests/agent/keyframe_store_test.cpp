// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/keyframe_store.hpp"

#include <gtest/gtest.h>

#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "core/store/state_file.hpp"

namespace adit::agent {
namespace {

class KeyframeStoreTest : public testing::Test {
 protected:
  std::unique_ptr<KeyframeStore> made() {
    auto frames = std::make_unique<KeyframeStore>(disk, *strand, nullptr);
    frames->load();
    return frames;
  }
  static void drive(KeyframeStore& frames, double from, double to, std::uint32_t epoch = 0) {
    PointCloud points;
    for (float y = -5; y < 5; y += 0.1f) points.emplace_back(4.0f, y, 1.0f);
    for (double x = from; x <= to; x += 0.25)
      if (frames.wants({x, 0, 0}, epoch))
        frames.add(perception::make_keyframe(points, Pose3::level({x, 0, 0}, 0), epoch));
  }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 5s)};
  std::shared_ptr<Strand> strand{machine->strand("command")};
  std::shared_ptr<store::MemoryDisk> disk = std::make_shared<store::MemoryDisk>();
};

TEST_F(KeyframeStoreTest, KeepsOneAMetreOverARestart) {
  drive(*made(), 0, 5);
  const auto again = made();
  EXPECT_EQ(again->of(0).size(), 6U);
  EXPECT_EQ(again->lost(), 0U);
  EXPECT_TRUE(again->of(1).empty());
}

TEST_F(KeyframeStoreTest, IsBoundedAndKeepsTheNewest) {
  auto frames = made();
  drive(*frames, 0, 100);
  frames = made();
  drive(*frames, 101, 110);
  const auto stored = made()->of(0);
  ASSERT_EQ(stored.size(), KeyframeStore::kMax);
  for (const auto& each : stored) EXPECT_GT(each.T_odom_base.position.x(), 45.0);
}

TEST_F(KeyframeStoreTest, ReplacesWhatItSawAtTheSamePlace) {
  auto frames = made();
  for (int round = 0; round < 20; ++round) drive(*frames, 0, 5);
  EXPECT_LE(frames->of(0).size(), 12U);
}

TEST_F(KeyframeStoreTest, LeavesOutDamagedFilesAndSetsThemAside) {
  drive(*made(), 0, 5);
  auto flipped = **disk->read("keyframe-02");
  flipped[40] ^= 1;
  disk->plant("keyframe-02", flipped);
  auto torn = flipped;
  torn.resize(100);
  disk->plant("keyframe-04", torn);
  const auto again = made();
  EXPECT_EQ(again->lost(), 2U);
  EXPECT_EQ(again->of(0).size(), 4U);
  EXPECT_EQ(made()->lost(), 0U);
  EXPECT_EQ(*disk->read("keyframe-02.corrupt"), flipped);
  EXPECT_EQ(*disk->read("keyframe-04.torn"), torn);
}

TEST_F(KeyframeStoreTest, LeavesFilesOfANewerVersionAndUnreadableOnesAsTheyAre) {
  drive(*made(), 0, 5);
  const store::Bytes newer = store::encode_envelope({{'K', 'E', 'Y', 'F'}, 99, 64 * 1024}, 7, {});
  disk->plant("keyframe-02", newer);
  const auto unreadable = **disk->read("keyframe-04");
  disk->set_refused("keyframe-04", true);
  auto again = made();
  disk->set_refused("keyframe-04", false);
  EXPECT_EQ(again->lost(), 2U);
  EXPECT_EQ(again->of(0).size(), 4U);
  drive(*again, 100, 100 + 2 * static_cast<double>(KeyframeStore::kMax));
  EXPECT_EQ(*disk->read("keyframe-02"), newer);
  EXPECT_EQ(*disk->read("keyframe-04"), unreadable);
  EXPECT_EQ(again->of(0).size(), KeyframeStore::kMax);
  EXPECT_EQ(made()->of(0).size(), KeyframeStore::kMax - 1);
}

TEST_F(KeyframeStoreTest, SurvivesAFullDisk) {
  auto frames = made();
  disk->set_full(true);
  drive(*frames, 0, 5);
  EXPECT_EQ(frames->of(0).size(), 6U);
  EXPECT_TRUE(made()->of(0).empty());
}

}  // namespace
}  // namespace adit::agent
