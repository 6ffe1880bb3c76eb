// SPDX-License-Identifier: Apache-2.0
// Pieces of pictures as libFuzzer makes them up, one after the other into a store, and what they show. Built
// by tools/fuzz.sh. The first byte of each piece says its length and whether it gets a correct checksum.
#include <cstdlib>

#include "core/store/crc32c.hpp"
#include "perception/camera/stripe_store.hpp"

using namespace adit;
using namespace adit::perception;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  StripeStore store;
  std::span<const std::uint8_t> left(data, size);
  while (!left.empty()) {
    const std::uint8_t how = left[0];
    left = left.subspan(1);
    const std::size_t length = std::min<std::size_t>(left.size(), std::size_t{how} * 4);
    std::vector<std::uint8_t> bytes(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(length));
    left = left.subspan(length);
    if (how % 4 != 0 && !bytes.empty()) {
      bytes[0] = 1;  // The version.
      const std::uint32_t sum = crc32c(bytes);
      for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(sum >> shift));
    }
    const auto piece = decode_picture_piece(bytes);
    if (!piece) continue;
    const auto back = decode_picture_piece(encode(*piece));
    if (!back || *back != *piece) std::abort();
    const bool taken = store.take(*piece);
    if (taken && store.newest()->frame != piece->header.frame) std::abort();
    if (store.missing().size() > PictureFormat::kMaxStripes / 8) std::abort();
  }
  const auto jpeg = store.as_jpeg();
  if (jpeg.empty() == store.newest().has_value()) std::abort();
  if (jpeg.empty()) return 0;
  // Whatever the stripes are, there is a picture.
  auto shown = decode_jpeg_tolerant(jpeg, 320, 240);
  if (!shown) std::abort();
  mark_missing(*shown, store.newest()->format, store.missing(), store.absent(), {});
  return 0;
}
