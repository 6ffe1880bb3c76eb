// SPDX-License-Identifier: Apache-2.0
#include "core/store/state_file.hpp"

#include <gmock/gmock.h>

#include "core/store/file_disk.hpp"
#include "core/store/memory_disk.hpp"
#include "core/time/random.hpp"
#include "tests/store/scratch_folder.hpp"

namespace adit::store {
namespace {

using testing::HasSubstr;

constexpr StateFormat kFormat{{'T', 'E', 'S', 'T'}, 3, 64};

Bytes sealed(std::uint16_t version = 3) {
  StateFormat format = kFormat;
  format.version = version;
  return encode_envelope(format, 7, bytes("holder op1"));
}

TEST(StateFile, gives_back_the_state_and_its_generation) {
  const auto disk = std::make_shared<MemoryDisk>();
  const StateFile file(disk, "state", kFormat);
  EXPECT_EQ(file.load().found, LoadStatus::nothing);
  ASSERT_TRUE(file.save(7, bytes("holder op1")).ok());
  const State state = file.load();
  EXPECT_EQ(state.found, LoadStatus::good) << state.text;
  EXPECT_EQ(state.generation, 7u);
  EXPECT_EQ(state.payload, bytes("holder op1"));
}

TEST(StateFile, is_the_same_on_a_real_disk) {
  const ScratchFolder folder;
  const StateFile file(FileDisk::open(folder.path()).value(), "state", kFormat);
  ASSERT_TRUE(file.save(1, {}).ok());
  ASSERT_TRUE(file.save(2, bytes("two")).ok());
  EXPECT_EQ(file.load().payload, bytes("two"));
}

TEST(StateFile, takes_no_more_than_its_format_allows) {
  const auto disk = std::make_shared<MemoryDisk>();
  const StateFile file(disk, "state", kFormat);
  ASSERT_TRUE(file.save(1, Bytes(64, 1)).ok());
  EXPECT_EQ(file.save(2, Bytes(65, 1)).reason(), Reason::out_of_range);
  EXPECT_EQ(file.load().generation, 1u);
}

TEST(StateFile, detects_a_torn_file) {
  const Bytes complete = sealed();
  for (std::size_t size = 0; size < complete.size(); ++size) {
    const State state = decode_envelope(kFormat, std::span(complete).first(size));
    EXPECT_EQ(state.found, LoadStatus::torn) << size << " bytes";
    EXPECT_TRUE(state.payload.empty());
    EXPECT_THAT(state.text, HasSubstr(std::to_string(size)));
  }
  EXPECT_EQ(decode_envelope(kFormat, Bytes(complete.size(), 0)).found, LoadStatus::torn)
      << "blocks that were never written";
}

TEST(StateFile, detects_every_changed_byte) {
  for (std::size_t at = 0; at < sealed().size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      Bytes bent = sealed();
      bent[at] = static_cast<std::uint8_t>(bent[at] ^ (1u << bit));
      const State state = decode_envelope(kFormat, bent);
      EXPECT_NE(state.found, LoadStatus::good) << "byte " << at;
      EXPECT_NE(state.found, LoadStatus::older) << "byte " << at << ": a version that nobody wrote";
      EXPECT_NE(state.found, LoadStatus::newer) << "byte " << at;
      EXPECT_TRUE(state.payload.empty());
    }
  Bytes longer = sealed();
  longer.push_back(0);
  EXPECT_EQ(decode_envelope(kFormat, longer).found, LoadStatus::corrupt);
}

TEST(StateFile, distinguishes_older_and_newer_versions) {
  EXPECT_EQ(decode_envelope(kFormat, sealed(2)).found, LoadStatus::older);
  EXPECT_EQ(decode_envelope(kFormat, sealed(2)).version, 2);
  EXPECT_EQ(decode_envelope(kFormat, sealed(2)).payload, bytes("holder op1"))
      << "for a program that still reads it";
  EXPECT_TRUE(decode_envelope(kFormat, sealed(4)).payload.empty());
  EXPECT_EQ(decode_envelope(kFormat, sealed(4)).found, LoadStatus::newer);
  EXPECT_THAT(decode_envelope(kFormat, sealed(4)).text, HasSubstr("version 4"));
}

TEST(StateFile, detects_a_foreign_file) {
  StateFormat other = kFormat;
  other.kind = {'E', 'L', 'S', 'E'};
  EXPECT_EQ(decode_envelope(kFormat, encode_envelope(other, 1, {})).found, LoadStatus::foreign);
  EXPECT_EQ(decode_envelope(kFormat, bytes("name: r1\nplatform: wheeled\nand so on, a file of somebody else"))
                .found,
            LoadStatus::foreign);
  EXPECT_EQ(decode_envelope(kFormat, bytes("x")).found, LoadStatus::foreign);
}

TEST(StateFile, says_when_the_disk_refuses) {
  const auto disk = std::make_shared<MemoryDisk>();
  const StateFile file(disk, "state", kFormat);
  disk->cut_power();
  EXPECT_EQ(file.load().found, LoadStatus::unreadable);
  EXPECT_EQ(file.save(1, {}).reason(), Reason::cannot_write);
  disk->power_up();
  disk->plant("state", Bytes(100'000, 'A'));
  EXPECT_EQ(file.load().found, LoadStatus::unreadable) << "not even read into memory";
}

TEST(StateFile, takes_any_bytes) {
  Random random(5);
  for (int i = 0; i < 20'000; ++i) {
    Bytes junk = random.chance(0.5) ? sealed() : Bytes(random.below(120));
    const std::uint64_t edits = 1 + random.below(4);
    for (std::uint64_t k = 0; k < edits && !junk.empty(); ++k)
      junk[random.below(junk.size())] = static_cast<std::uint8_t>(random.next());
    if (random.chance(0.3)) junk.resize(random.below(junk.size() + 20));
    const State state = decode_envelope(kFormat, junk);
    EXPECT_TRUE(state.found != LoadStatus::good || junk == sealed()) << "only what was written is good";
  }
}

TEST(StateFile, is_the_old_or_the_new_state_after_a_power_cut_at_every_byte) {
  const Bytes old = bytes("held by op1, locked"), fresh = bytes("held by op2");
  MemoryDisk measure;
  (void)measure.replace("state", encode_envelope(kFormat, 2, fresh));
  const std::uint64_t steps = measure.steps();
  std::size_t olds = 0, news = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (std::uint64_t at = 0; at <= steps; ++at) {
      const auto disk = std::make_shared<MemoryDisk>(seed);
      const StateFile file(disk, "state", kFormat);
      ASSERT_TRUE(file.save(1, old).ok());
      disk->cut_power_after(at);
      const bool saved = file.save(2, fresh).ok();
      disk->cut_power();
      disk->power_up();
      const State state = file.load();
      ASSERT_EQ(state.found, LoadStatus::good) << "step " << at << ", seed " << seed << ": " << state.text;
      ASSERT_EQ(state.payload, state.generation == 1 ? old : fresh);
      ASSERT_TRUE(!saved || state.generation == 2);
      ++(state.generation == 1 ? olds : news);
      // And the next write works on whatever was left behind.
      ASSERT_TRUE(file.save(3, old).ok());
      ASSERT_EQ(file.load().generation, 3u);
    }
  EXPECT_GT(olds, 0u);
  EXPECT_GT(news, 0u);
}

}  // namespace
}  // namespace adit::store
