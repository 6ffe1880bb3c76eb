// SPDX-License-Identifier: Apache-2.0
#include "sim/world/read_file.hpp"

#include <fstream>
#include <sstream>

namespace adit::sim {

Result<std::string> read_file(const std::filesystem::path& file) {
  constexpr std::uintmax_t limit = 256u << 20;
  std::error_code failure;
  if (!std::filesystem::is_regular_file(file, failure))
    return {Reason::cannot_read, file.string() + ": no such map; run ./run setup to fetch the maps"};
  const std::uintmax_t size = std::filesystem::file_size(file, failure);
  if (failure || size > limit) return {Reason::cannot_read, file.string() + ": larger than 256 MB"};
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  if (!stream) return {Reason::cannot_read, file.string() + ": cannot be read"};
  return std::move(content).str();
}

}  // namespace adit::sim
