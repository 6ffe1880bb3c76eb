// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/folders/folders.hpp"

namespace adit {

/// Behaviour trees that contradict the mode table, each in its own way; sorted by name.
inline std::vector<std::string> hostile_trees() {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(source_folder() + "/tests/rehearsal/hostile_trees"))
    files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// The name of a tree's test.
inline std::string tree_name(const std::string& file) { return std::filesystem::path(file).stem().string(); }

}  // namespace adit
