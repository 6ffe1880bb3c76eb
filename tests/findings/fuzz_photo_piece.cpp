// SPDX-License-Identifier: Apache-2.0
// Pieces of photos as libFuzzer makes them up, one after the other into a store. Built by tools/fuzz.sh. The
// first byte of each piece says its length and whether it gets a correct checksum.
#include <cstdlib>

#include "core/exec/virtual_runtime.hpp"
#include "core/findings/photo_store.hpp"
#include "core/store/crc32c.hpp"
#include "core/store/memory_disk.hpp"

using namespace adit;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  VirtualScheduler scheduler{1};
  const auto machine = scheduler.machine("r1", Duration{});
  const auto strand = machine->strand("home");
  const auto disk = std::make_shared<store::MemoryDisk>();
  constexpr std::size_t kRoom = 8192;
  findings::PhotoStore photos({.max_bytes = kRoom, .max_incoming = 2}, disk, *strand, nullptr, {});
  std::span<const std::uint8_t> left(data, size);
  while (!left.empty()) {
    const std::uint8_t how = left[0];
    left = left.subspan(1);
    const std::size_t length = std::min<std::size_t>(left.size(), std::size_t{how} * 4);
    store::Bytes bytes(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(length));
    left = left.subspan(length);
    if (how % 4 != 0 && !bytes.empty()) {
      bytes[0] = 1;  // The version.
      const std::uint32_t sum = crc32c(bytes);
      for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(sum >> shift));
    }
    const auto piece = findings::decode_photo_piece(bytes);
    if (!piece) continue;
    const auto back = findings::decode_photo_piece(encode(*piece));
    if (!back || *back != *piece) std::abort();
    const bool picture = piece->part == findings::PhotoPart::picture;
    const findings::PhotoRef ref{piece->content, picture ? piece->bytes : 1000,
                                 static_cast<std::uint16_t>(picture ? 100 : piece->bytes)};
    (void)photos.add(*piece, ref, how, "r" + std::to_string(how % 3), [] {});
    if (photos.bytes() > kRoom) std::abort();
    // A picture that is complete has the hash that names it.
    const store::Bytes* whole = photos.find(piece->content, findings::PhotoPart::picture);
    if (whole != nullptr && findings::photo_hash(*whole) != piece->content) std::abort();
    scheduler.run_until(scheduler.elapsed() + Duration(std::chrono::milliseconds(10)));
  }
  // What is on the disk can be read again.
  findings::PhotoStore again({.max_bytes = kRoom}, disk, *strand, nullptr, {});
  if (!again.load().empty()) std::abort();
  return 0;
}
