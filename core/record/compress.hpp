#pragma once
#include <vector>

#include "core/record/bytes.hpp"

namespace adit::record {

/// True when this build has libzstd.
bool can_compress();
/// Zstandard, level 1. False when it would not be shorter, or is not built in.
bool compress(ByteSpan data, std::vector<std::uint8_t>& out);
/// False when `data` is not Zstandard of exactly `size` bytes, or it is not built in.
bool decompress(ByteSpan data, std::size_t size, std::vector<std::uint8_t>& out);

}  // namespace adit::record
