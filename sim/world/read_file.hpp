// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "core/result/result.hpp"

namespace adit::sim {

/// The content of a file, up to 256 MB. Reason::cannot_read names the file and what to do.
Result<std::string> read_file(const std::filesystem::path& file);

}  // namespace adit::sim
