// SPDX-License-Identifier: Apache-2.0
#include "core/record/compress.hpp"

#if ADIT_ZSTD
#include <zstd.h>
#endif

namespace adit::record {

#if ADIT_ZSTD

bool can_compress() { return true; }

bool compress(ByteSpan data, std::vector<std::uint8_t>& out) {
  out.resize(ZSTD_compressBound(data.size()));
  const std::size_t size = ZSTD_compress(out.data(), out.size(), data.data(), data.size(), 1);
  if (ZSTD_isError(size) != 0 || size >= data.size()) return false;
  out.resize(size);
  return true;
}

bool decompress(ByteSpan data, std::size_t size, std::vector<std::uint8_t>& out) {
  // The size in the frame header is checked before anything is allocated for it.
  if (ZSTD_getFrameContentSize(data.data(), data.size()) != size) return false;
  out.resize(size);
  return ZSTD_decompress(out.data(), out.size(), data.data(), data.size()) == size;
}

#else

bool can_compress() { return false; }
bool compress(ByteSpan, std::vector<std::uint8_t>&) { return false; }
bool decompress(ByteSpan, std::size_t, std::vector<std::uint8_t>&) { return false; }

#endif

}  // namespace adit::record
