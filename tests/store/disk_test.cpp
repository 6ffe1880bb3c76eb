// SPDX-License-Identifier: Apache-2.0
#include "core/store/disk.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>

#include "core/store/file_disk.hpp"
#include "core/store/memory_disk.hpp"
#include "tests/store/scratch_folder.hpp"

namespace adit::store {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

enum class Kind { file, memory };

/// The same over both disks.
class Disks : public testing::TestWithParam<Kind> {
 protected:
  Disks() {
    if (GetParam() == Kind::memory) {
      disk_ = std::make_shared<MemoryDisk>();
    } else {
      auto opened = FileDisk::open(folder_.path("a/b"));
      if (opened) disk_ = *opened;
    }
  }
  std::optional<Bytes> content(const std::string& name) {
    auto read = disk_->read(name);
    EXPECT_TRUE(read.ok()) << read.error().text;
    return read ? *read : std::optional<Bytes>{};
  }
  ScratchFolder folder_{};
  std::shared_ptr<Disk> disk_{};
};

TEST_P(Disks, give_back_what_was_written) {
  ASSERT_TRUE(disk_);
  EXPECT_EQ(content("state"), std::nullopt);
  ASSERT_TRUE(disk_->replace("state", bytes("one")).ok());
  EXPECT_EQ(content("state"), bytes("one"));
  ASSERT_TRUE(disk_->replace("state", bytes("")).ok());
  EXPECT_EQ(content("state"), bytes(""));
  ASSERT_TRUE(disk_->replace("state", Bytes(200'000, 7)).ok());
  EXPECT_EQ(content("state"), Bytes(200'000, 7));
}

TEST_P(Disks, append_and_make_the_file_when_it_is_missing) {
  ASSERT_TRUE(disk_->append("log", bytes("one ")).ok());
  ASSERT_TRUE(disk_->append("log", bytes("two")).ok());
  EXPECT_EQ(content("log"), bytes("one two"));
}

TEST_P(Disks, list_their_files_sorted_and_without_temporary_ones) {
  ASSERT_TRUE(disk_->replace("b", bytes("1")).ok());
  ASSERT_TRUE(disk_->replace("a.bin", bytes("1")).ok());
  ASSERT_TRUE(disk_->append("c", bytes("1")).ok());
  EXPECT_THAT(disk_->list().value(), ElementsAre("a.bin", "b", "c"));
  ASSERT_TRUE(disk_->remove("b").ok());
  ASSERT_TRUE(disk_->remove("b").ok()) << "what is not there is no error";
  EXPECT_THAT(disk_->list().value(), ElementsAre("a.bin", "c"));
}

TEST_P(Disks, refuse_names_that_lead_elsewhere) {
  for (const char* name : {"", ".", "..", ".hidden", "a/b", "/etc/passwd", "a b", "\xc3\xa4"}) {
    EXPECT_EQ(disk_->replace(name, bytes("x")).reason(), Reason::bad_argument) << name;
    EXPECT_EQ(disk_->append(name, bytes("x")).reason(), Reason::bad_argument) << name;
    EXPECT_EQ(disk_->remove(name).reason(), Reason::bad_argument) << name;
    EXPECT_EQ(disk_->read(name).reason(), Reason::bad_argument) << name;
  }
  EXPECT_EQ(disk_->replace(std::string(129, 'a'), bytes("x")).reason(), Reason::bad_argument);
  EXPECT_THAT(disk_->list().value(), IsEmpty());
}

TEST_P(Disks, do_not_read_more_than_they_are_asked_to) {
  ASSERT_TRUE(disk_->replace("big", Bytes(1000, 1)).ok());
  EXPECT_TRUE(disk_->read("big", 1000).ok());
  EXPECT_EQ(disk_->read("big", 999).reason(), Reason::cannot_read);
}

TEST_P(Disks, know_what_is_free) { EXPECT_GT(disk_->free(), 1'000'000u); }

INSTANTIATE_TEST_SUITE_P(Store, Disks, testing::Values(Kind::file, Kind::memory),
                         [](const auto& which) { return which.param == Kind::file ? "file" : "memory"; });

TEST(FileDisk, keeps_its_folder_and_files_to_its_owner) {
  const ScratchFolder folder;
  const auto disk = FileDisk::open(folder.path("state")).value();
  ASSERT_TRUE(disk->replace("state", bytes("x")).ok());
  struct stat status {};
  ASSERT_EQ(::stat(folder.path("state").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700u);
  ASSERT_EQ(::stat(folder.path("state/state").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
}

TEST(FileDisk, sweeps_up_what_a_crash_left_unfinished) {
  const ScratchFolder folder;
  std::ofstream(folder.path(".state.new")) << "half";
  std::ofstream(folder.path("state")) << "whole";
  const auto disk = FileDisk::open(folder.path()).value();
  EXPECT_FALSE(std::filesystem::exists(folder.path(".state.new")));
  EXPECT_EQ(disk->read("state").value(), bytes("whole"));
}

TEST(FileDisk, says_why_a_folder_cannot_be_used) {
  const ScratchFolder folder;
  std::ofstream(folder.path("file")) << "x";
  const auto opened = FileDisk::open(folder.path("file/below"));
  ASSERT_FALSE(opened.ok());
  EXPECT_EQ(opened.reason(), Reason::cannot_write);
  EXPECT_THAT(opened.error().text, HasSubstr(folder.path("file/below")));
}

TEST(FileDisk, follows_no_link_and_reads_no_folder) {
  const ScratchFolder folder;
  const auto disk = FileDisk::open(folder.path()).value();
  std::ofstream(folder.path("elsewhere")) << "secret";
  std::filesystem::create_symlink(folder.path("elsewhere"), folder.path("link"));
  std::filesystem::create_directory(folder.path("folder"));
  EXPECT_EQ(disk->read("link").reason(), Reason::cannot_read);
  EXPECT_EQ(disk->read("folder").reason(), Reason::cannot_read);
  EXPECT_EQ(disk->append("link", bytes("x")).reason(), Reason::cannot_write);
  EXPECT_EQ(disk->replace("folder", bytes("x")).reason(), Reason::cannot_write);
  EXPECT_THAT(disk->list().value(), ElementsAre("elsewhere")) << "and nothing temporary is left";
  EXPECT_FALSE(std::filesystem::exists(folder.path(".folder.new")));
}

TEST(FileDisk, leaves_the_old_file_when_it_cannot_write) {
  const ScratchFolder folder;
  const auto disk = FileDisk::open(folder.path()).value();
  ASSERT_TRUE(disk->replace("state", bytes("old")).ok());
  std::filesystem::create_directory(folder.path(".state.new"));
  EXPECT_EQ(disk->replace("state", bytes("new")).reason(), Reason::cannot_write);
  EXPECT_EQ(disk->read("state").value(), bytes("old"));
}

TEST(MemoryDisk, that_is_full_keeps_the_old_file) {
  MemoryDisk disk;
  ASSERT_TRUE(disk.replace("state", bytes("old")).ok());
  disk.set_full(true);
  EXPECT_EQ(disk.free(), 0u);
  EXPECT_EQ(disk.replace("state", bytes("new")).reason(), Reason::cannot_write);
  EXPECT_EQ(disk.read("state").value(), bytes("old"));
  disk.set_full(false);
  EXPECT_TRUE(disk.replace("state", bytes("new")).ok());
  EXPECT_EQ(disk.read("state").value(), bytes("new"));
}

TEST(MemoryDisk, holds_no_more_than_its_capacity) {
  MemoryDisk disk(1, 100);
  EXPECT_TRUE(disk.replace("a", Bytes(60, 1)).ok());
  EXPECT_EQ(disk.replace("b", Bytes(60, 1)).reason(), Reason::cannot_write);
  EXPECT_EQ(disk.free(), 40u) << "the half written one is gone again";
}

}  // namespace
}  // namespace adit::store
