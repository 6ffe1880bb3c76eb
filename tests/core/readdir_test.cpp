// SPDX-License-Identifier: Apache-2.0
// A folder that cannot be read to its end: the error is a value, never an exception.
#include <dirent.h>
#include <gmock/gmock.h>

#include <cerrno>
#include <cstring>

#include "core/config/search.hpp"
#include "core/store/file_disk.hpp"
#include "tests/store/scratch_folder.hpp"

namespace {

bool refuse{false};
int calls{0};

/// While it refuses: one entry, then an error; and so on.
template <class Entry>
Entry* next() {
  static Entry entry{};
  errno = 0;
  if (!refuse) return nullptr;
  if (++calls % 2 == 0) {
    errno = EIO;
    return nullptr;
  }
  std::strcpy(entry.d_name, "own.yaml");
  entry.d_type = DT_REG;
  return &entry;
}

}  // namespace

// In place of the C library's, for this executable.
extern "C" dirent* readdir(DIR*) { return next<dirent>(); }
extern "C" dirent64* readdir64(DIR*) { return next<dirent64>(); }

namespace adit {
namespace {

TEST(Readdir, AnErrorOfTheFolderIsNoExceptionOfTheSearch) {
  refuse = true;
  Result<std::string> found{Reason::none, {}};
  EXPECT_NO_THROW(found = config::find_named("platforms", "flying"));
  EXPECT_FALSE(found.ok());
  EXPECT_GT(calls, 1);
  refuse = false;
}

TEST(Readdir, AnErrorOfTheFolderIsNoExceptionOfTheDisk) {
  const store::ScratchFolder folder;
  refuse = true;
  Result<std::shared_ptr<store::FileDisk>> disk = Error{Reason::none, {}};
  EXPECT_NO_THROW(disk = store::FileDisk::open(folder.path()));
  ASSERT_TRUE(disk.ok());
  EXPECT_EQ((*disk)->list().reason(), Reason::cannot_read);
  refuse = false;
}

}  // namespace
}  // namespace adit
