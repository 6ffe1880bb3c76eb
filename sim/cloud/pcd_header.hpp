// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "core/result/result.hpp"

namespace adit::sim {

/// Checks what the header of a PCD file promises (Point Cloud Library, version 0.7) before the library reads
/// it, because that trusts what a file says of its size: ascii, binary or binary_compressed; fields x, y and
/// z of 4 or 8 byte floats; at most 10 million points, which fit into the file. Errors name file and line:
/// Reason::cannot_read, syntax, not_supported.
Result<void> check_pcd(const std::filesystem::path& file);

}  // namespace adit::sim
