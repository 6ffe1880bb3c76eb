// SPDX-License-Identifier: Apache-2.0
#include "core/store/state_file.hpp"

#include <algorithm>

#include "core/store/crc32c.hpp"
#include "core/store/pack.hpp"

namespace adit::store {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'A', 'D', 'I', 'T'};
constexpr std::size_t kHeader = 24, kChecksum = 4;

std::array<std::uint8_t, 4> octets(const std::array<char, 4>& kind) {
  std::array<std::uint8_t, 4> out{};
  std::transform(kind.begin(), kind.end(), out.begin(), [](char c) { return static_cast<std::uint8_t>(c); });
  return out;
}

State flawed(LoadStatus found, std::string text, std::span<const std::uint8_t> bytes = {}) {
  State state{};
  state.found = found;
  state.text = std::move(text);
  const auto remains = bytes.subspan(std::min(bytes.size(), kHeader));
  state.remains.assign(remains.begin(), remains.end());
  return state;
}

/// Whether the bytes are the beginning of our header; zeros after it come from an incomplete write.
bool begun(std::span<const std::uint8_t> bytes, const std::array<std::uint8_t, 4>& kind) {
  Bytes start(kMagic.begin(), kMagic.end());
  start.insert(start.end(), kind.begin(), kind.end());
  start.resize(std::min(start.size(), bytes.size()));
  const auto differs = std::mismatch(start.begin(), start.end(), bytes.begin());
  return differs.first == start.end() ||
         std::all_of(differs.second, bytes.end(), [](std::uint8_t b) { return b == 0; });
}

}  // namespace

std::string_view name(LoadStatus found) {
  switch (found) {
    case LoadStatus::good:
      return "good";
    case LoadStatus::nothing:
      return "nothing";
    case LoadStatus::foreign:
      return "foreign";
    case LoadStatus::torn:
      return "torn";
    case LoadStatus::corrupt:
      return "corrupt";
    case LoadStatus::older:
      return "older";
    case LoadStatus::newer:
      return "newer";
    case LoadStatus::unreadable:
      return "unreadable";
  }
  return "unknown";
}

Bytes encode_envelope(const StateFormat& format, std::uint64_t generation,
                      std::span<const std::uint8_t> payload) {
  Packer out;
  out.put(kMagic).put(octets(format.kind)).put(format.version).put(std::uint16_t{0});
  out.put(static_cast<std::uint32_t>(payload.size())).put(generation).raw(payload);
  const std::uint32_t checksum = crc32c(out.bytes());
  out.put(checksum);
  return out.bytes();
}

State decode_envelope(const StateFormat& format, std::span<const std::uint8_t> bytes) {
  const auto kind = octets(format.kind);
  if (!begun(bytes, kind)) return flawed(LoadStatus::foreign, "it is no file of this kind", bytes);
  if (bytes.size() < kHeader + kChecksum || bytes[7] != kind[3])
    return flawed(LoadStatus::torn, "it ends after " + std::to_string(bytes.size()) + " bytes", bytes);
  Unpacker in(bytes);
  (void)in.array<8>();
  const auto version = in.get<std::uint16_t>();
  const auto zero = in.get<std::uint16_t>();
  const std::size_t size = in.get<std::uint32_t>();
  const auto generation = in.get<std::uint64_t>();
  const std::size_t length = kHeader + size + kChecksum;
  if (bytes.size() < length)
    return flawed(
        LoadStatus::torn,
        "it ends after " + std::to_string(bytes.size()) + " of " + std::to_string(length) + " bytes", bytes);
  const auto payload = bytes.subspan(kHeader, size);
  const auto checksum = Unpacker(bytes.subspan(kHeader + size)).get<std::uint32_t>();
  if (bytes.size() > length || zero != 0 || checksum != crc32c(bytes.first(kHeader + size)))
    return flawed(LoadStatus::corrupt, "its checksum does not match", bytes);
  if (version > format.version)
    return flawed(LoadStatus::newer, "it is of version " + std::to_string(version) +
                                         ", this program reads versions up to " +
                                         std::to_string(format.version));
  if (size > format.max_bytes) return flawed(LoadStatus::corrupt, "it is longer than it can be");
  State state{};
  state.found = version < format.version ? LoadStatus::older : LoadStatus::good;
  if (state.found == LoadStatus::older) state.text = "it is of version " + std::to_string(version);
  state.generation = generation;
  state.payload.assign(payload.begin(), payload.end());
  state.version = version;
  return state;
}

State StateFile::load() const {
  const auto bytes = disk_->read(file_, kHeader + format_.max_bytes + kChecksum);
  if (!bytes) return flawed(LoadStatus::unreadable, bytes.error().text);
  if (!*bytes) return {};
  return decode_envelope(format_, **bytes);
}

Result<void> StateFile::save(std::uint64_t generation, std::span<const std::uint8_t> payload) const {
  if (payload.size() > format_.max_bytes)
    return {Reason::out_of_range, file_ + " would be " + std::to_string(payload.size()) + " bytes long, " +
                                      std::to_string(format_.max_bytes) + " are allowed"};
  return disk_->replace(file_, encode_envelope(format_, generation, payload));
}

}  // namespace adit::store
