// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "tests/folders/folders.hpp"

namespace adit::sim {

/// A folder that vanishes after the test.
class Scratch {
 public:
  Scratch() = default;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::filesystem::path write(const std::string& name, std::string_view content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }

 private:
  std::filesystem::path folder_{scratch_folder()};
};

/// The map of a real building, where ./run setup or the package put it; empty when it is not installed.
inline std::filesystem::path building_map() {
  for (const std::string& folder : {source_folder() + "/data/maps", source_folder() + "/config",
                                    std::string("/usr/share/doc/liboctomap-dev/examples/data")})
    if (const auto file = std::filesystem::path(folder) / "geb079.bt"; std::filesystem::exists(file))
      return file;
  return {};
}

}  // namespace adit::sim
