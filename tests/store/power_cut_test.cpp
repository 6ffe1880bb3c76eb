// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "core/store/memory_disk.hpp"
#include "tests/store/scratch_folder.hpp"

namespace adit::store {
namespace {

constexpr std::uint64_t kSeeds = 40;  // what survives of data that was not synced is drawn: try several

/// The steps of a whole replace().
std::uint64_t steps_of(const Bytes& old, const Bytes& fresh) {
  MemoryDisk disk;
  EXPECT_TRUE(disk.replace("state", old).ok());
  const std::uint64_t before = disk.steps();
  EXPECT_TRUE(disk.replace("state", fresh).ok());
  return disk.steps() - before;
}

TEST(PowerCut, at_every_step_of_a_write_leaves_the_old_or_the_new_file) {
  const Bytes old = bytes("the old state"), fresh = bytes("what the state is from now on");
  const std::uint64_t steps = steps_of(old, fresh);
  ASSERT_EQ(steps, fresh.size() + 4);  // open, the bytes, sync, rename, sync of the folder
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
    for (std::uint64_t at = 0; at <= steps; ++at) {
      MemoryDisk disk(seed);
      ASSERT_TRUE(disk.replace("state", old).ok());
      disk.cut_power_after(at);
      const bool told_done = disk.replace("state", fresh).ok();
      EXPECT_EQ(told_done, at == steps);
      disk.cut_power();
      disk.power_up();
      const auto now = disk.read("state").value();
      ASSERT_TRUE(now.has_value()) << "step " << at << ", seed " << seed;
      ASSERT_TRUE(*now == old || *now == fresh) << "step " << at << ", seed " << seed;
      ASSERT_TRUE(!told_done || *now == fresh) << "acknowledged, and lost: seed " << seed;
    }
}

TEST(PowerCut, at_every_step_of_a_first_write_leaves_nothing_or_the_file) {
  const Bytes fresh = bytes("first");
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
    for (std::uint64_t at = 0; at <= fresh.size() + 4; ++at) {
      MemoryDisk disk(seed);
      disk.cut_power_after(at);
      (void)disk.replace("state", fresh);
      disk.cut_power();
      disk.power_up();
      const auto now = disk.read("state").value();
      ASSERT_TRUE(!now || *now == fresh) << "step " << at << ", seed " << seed;
    }
}

TEST(PowerCut, loses_only_the_end_of_an_append) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
    for (std::uint64_t at = 0; at <= 6; ++at) {
      MemoryDisk disk(seed);
      ASSERT_TRUE(disk.append("log", bytes("kept.")).ok());
      disk.cut_power_after(at);
      (void)disk.append("log", bytes("late"));
      disk.cut_power();
      disk.power_up();
      const Bytes now = disk.read("log").value().value();
      ASSERT_GE(now.size(), 5u);
      EXPECT_EQ(Bytes(now.begin(), now.begin() + 5), bytes("kept.")) << "step " << at << ", seed " << seed;
    }
}

/// The model itself: without the steps that replace() takes, a power cut does harm.
TEST(PowerCut, tears_unsynced_writes) {
  bool lost = false, torn = false;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    MemoryDisk disk(seed);
    ASSERT_TRUE(disk.append("log", bytes("one")).ok());
    disk.cut_power_after(1 + 3);  // opened and written, not synced
    EXPECT_FALSE(disk.append("log", bytes("two")).ok());
    EXPECT_FALSE(disk.read("log").ok()) << "a disk without power answers nothing";
    disk.power_up();
    const Bytes now = disk.read("log").value().value();
    lost = lost || now == bytes("one");
    torn = torn || (now != bytes("one") && now != bytes("onetwo"));
  }
  EXPECT_TRUE(lost);
  EXPECT_TRUE(torn);
}

TEST(PowerCut, is_the_same_for_the_same_seed) {
  const auto survivor = [](std::uint64_t seed) {
    MemoryDisk disk(seed);
    (void)disk.append("log", Bytes(50, 9));
    disk.cut_power_after(40);
    (void)disk.append("log", Bytes(50, 8));
    disk.power_up();
    return disk.read("log").value();
  };
  EXPECT_EQ(survivor(3), survivor(3));
}

}  // namespace
}  // namespace adit::store
