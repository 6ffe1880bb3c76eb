// SPDX-License-Identifier: Apache-2.0
#include "tests/folders/folders.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace adit {
namespace {

/// Removes the folders of the process that made them, not those of a process that forked it.
struct ScratchFolders {
  std::vector<std::string> all{};
  pid_t owner{::getpid()};
  ~ScratchFolders() {
    if (owner != ::getpid()) return;
    std::error_code ignored;  // a leftover file fails no test
    for (const std::string& folder : all) std::filesystem::remove_all(folder, ignored);
  }
};

}  // namespace

const std::string& source_folder() {
  static const std::string folder{ADIT_SOURCE_DIR};
  return folder;
}

const std::string& program_folder() {
  static const std::string folder{ADIT_BIN_DIR};
  return folder;
}

std::string scratch_folder() {
  static ScratchFolders folders;
  std::string path = (std::filesystem::temp_directory_path() / "adit-test-XXXXXX").string();
  if (::mkdtemp(path.data()) == nullptr) throw std::runtime_error("no folder can be made: " + path);
  return folders.all.emplace_back(path);
}

bool all_seeds() { return std::getenv("ADIT_ALL_SEEDS") != nullptr; }

}  // namespace adit
