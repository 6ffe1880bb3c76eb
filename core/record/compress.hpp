// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "core/record/bytes.hpp"

namespace adit::record {

/// Whether this build has libzstd.
bool can_compress();
/// Compresses with Zstandard, level 1. Returns false when the result would not be shorter, or libzstd is not
/// built in.
bool compress(ByteSpan data, std::vector<std::uint8_t>& out);
/// Returns false when `data` is not Zstandard of exactly `size` bytes, or libzstd is not built in.
bool decompress(ByteSpan data, std::size_t size, std::vector<std::uint8_t>& out);

}  // namespace adit::record
