// SPDX-License-Identifier: Apache-2.0
// What FileDisk syncs and closes, seen between it and the C library.
#include <gmock/gmock.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "core/store/file_disk.hpp"
#include "tests/store/scratch_folder.hpp"

namespace {

struct Calls {
  bool watch{false}, close_fails{false};
  int writer{-1};                      ///< The descriptor that wrote, not closed yet
  bool synced{false};                  ///< It was synced after its last write.
  std::vector<std::string> folders{};  ///< Folders that were synced.
  int unsynced{0};                     ///< Files that were closed without
};
Calls calls;

std::string path_of(int fd) {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(fd), error).string();
}

}  // namespace

extern "C" ssize_t write(int fd, const void* bytes, std::size_t size) {
  if (calls.watch) calls.writer = fd;
  if (calls.watch) calls.synced = false;
  return syscall(SYS_write, fd, bytes, size);
}
extern "C" int fsync(int fd) {
  if (calls.watch && fd == calls.writer) calls.synced = true;
  if (calls.watch && std::filesystem::is_directory(path_of(fd))) calls.folders.push_back(path_of(fd));
  return static_cast<int>(syscall(SYS_fsync, fd));
}
extern "C" int close(int fd) {
  const auto closed = static_cast<int>(syscall(SYS_close, fd));
  if (!calls.watch || fd != calls.writer) return closed;
  calls.writer = -1;
  if (!calls.synced) ++calls.unsynced;
  if (!calls.close_fails) return closed;
  errno = EIO;
  return -1;
}

namespace adit::store {
namespace {

class SyncOrder : public testing::Test {
 protected:
  SyncOrder() {
    calls = {};
    calls.watch = true;
  }
  ~SyncOrder() override { calls = {}; }
  ScratchFolder folder_{};
};

TEST_F(SyncOrder, TheParentsOfAFolderThatIsMadeAreSynced) {
  const std::string top = std::filesystem::canonical(folder_.path()).string();
  ASSERT_TRUE(FileDisk::open(folder_.path("a/b/c")).ok());
  EXPECT_THAT(calls.folders, testing::ElementsAre(top, top + "/a", top + "/a/b"));
  calls.folders.clear();
  ASSERT_TRUE(FileDisk::open(folder_.path("a/b/c")).ok());
  EXPECT_THAT(calls.folders, testing::IsEmpty()) << "nothing was made";
}

TEST_F(SyncOrder, AFileIsSyncedByTheDescriptorThatWroteIt) {
  const auto disk = FileDisk::open(folder_.path()).value();
  ASSERT_TRUE(disk->replace("state", bytes("one")).ok());
  ASSERT_TRUE(disk->append("log", bytes("one")).ok());
  EXPECT_EQ(calls.unsynced, 0);
}

TEST_F(SyncOrder, AnErrorAtClosingIsAnErrorOfTheWrite) {
  const auto disk = FileDisk::open(folder_.path()).value();
  ASSERT_TRUE(disk->replace("state", bytes("one")).ok());
  calls.close_fails = true;
  EXPECT_EQ(disk->replace("state", bytes("two")).reason(), Reason::cannot_write);
  calls.close_fails = false;
  EXPECT_EQ(disk->read("state").value(), bytes("one")) << "the old state stays";
}

}  // namespace
}  // namespace adit::store
