// SPDX-License-Identifier: Apache-2.0
#include "core/findings/finding_fields.hpp"

#include <bit>

namespace adit::findings {
namespace {

constexpr std::uint64_t kWithdrawn = 1, kAnchor = 2, kPhoto = 4;
constexpr int kFlags = 3;  // Bits.

/// Revision and flags as one number, short while the revision is small.
std::uint64_t change_of(const Finding& f) {
  return std::uint64_t{f.revision} << kFlags | (f.withdrawn ? kWithdrawn : 0) | (f.anchor ? kAnchor : 0) |
         (f.photo ? kPhoto : 0);
}

std::size_t varint_size(std::uint64_t value) {
  std::size_t size = 1;
  for (; value >= 0x80; value >>= 7) ++size;
  return size;
}

float real(store::Unpacker& in) { return std::bit_cast<float>(in.get<std::uint32_t>()); }

void pack(store::Packer& out, const Anchor& anchor) {
  out.put(anchor.start).varint(anchor.submap);
  for (const float value : anchor.offset) out.put(std::bit_cast<std::uint32_t>(value));
  out.put(std::bit_cast<std::uint32_t>(anchor.yaw));
}

Anchor anchor(store::Unpacker& in) {
  Anchor out{.start = in.get<std::uint64_t>()};
  const std::uint64_t submap = in.varint();
  out.submap = static_cast<std::uint32_t>(std::min<std::uint64_t>(submap, UINT32_MAX));
  for (float& value : out.offset) value = real(in);
  out.yaw = real(in);
  return out;
}

}  // namespace

std::size_t packed_size(const Finding& f) {
  const std::size_t anchored = f.anchor ? 8 + varint_size(f.anchor->submap) + 3 * 4 + 4 : 0;
  const std::size_t pictured = f.photo ? 8 + 4 + 2 : 0;
  return 8 + varint_size(change_of(f)) + 2 + f.kind.size() + 1 + 3 * 8 + 8 + 2 + f.text.size() + 2 +
         f.data.size() + anchored + pictured;
}

void pack_fields(store::Packer& out, const Finding& f) {
  out.put(f.key.id).varint(change_of(f)).text(f.kind).put(f.importance);
  for (const double value : f.position) out.put(value);
  out.put(f.stamp).text(f.text).put(static_cast<std::uint16_t>(f.data.size())).raw(f.data);
  if (f.anchor) pack(out, *f.anchor);
  if (f.photo) out.put(f.photo->content).put(f.photo->bytes).put(f.photo->thumbnail);
}

void unpack_content(store::Unpacker& in, Finding& f) {
  f.kind = in.text(Finding::kKind);
  f.importance = in.get<std::uint8_t>();
  for (double& value : f.position) value = in.number();
  f.stamp = in.get<std::uint64_t>();
  f.text = in.text(Finding::kText);
  const auto data = in.bytes(Finding::kData);
  f.data.assign(data.begin(), data.end());
}

void unpack_fields(store::Unpacker& in, std::uint8_t version, Finding& f) {
  f.key.id = in.get<std::uint64_t>();
  std::uint64_t flags = 0;
  if (version > kFirstVersion) {
    const int bits = version == kVersion ? kFlags : 1;
    const std::uint64_t change = in.varint();
    flags = change & ((1u << bits) - 1);
    f.revision = static_cast<std::uint32_t>(change >> bits);
    if (change >> bits > UINT32_MAX) in.fail();
  }
  f.withdrawn = (flags & kWithdrawn) != 0;
  unpack_content(in, f);
  if ((flags & kAnchor) != 0) f.anchor = anchor(in);
  if ((flags & kPhoto) != 0)
    f.photo = {in.get<std::uint64_t>(), in.get<std::uint32_t>(), in.get<std::uint16_t>()};
}

}  // namespace adit::findings
