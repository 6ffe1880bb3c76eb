// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace adit::record {

using ByteSpan = std::span<const std::uint8_t>;
using Text = std::map<std::string, std::string>;

/// Appends MCAP's basic types: little-endian integers, and strings and maps with a length prefix.
class McapPacker {
 public:
  explicit McapPacker(std::vector<std::uint8_t>& out) : out_(out) {}

  template <class Integer>
  void put(Integer value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
      out_.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
  }
  void bytes(ByteSpan data) { out_.insert(out_.end(), data.begin(), data.end()); }
  void text(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size()));
    bytes({reinterpret_cast<const std::uint8_t*>(value.data()), value.size()});
  }
  void map(const Text& value) {
    const std::size_t length_at = out_.size();
    put(std::uint32_t{0});
    for (const auto& [key, entry] : value) text(key), text(entry);
    overwrite(length_at, static_cast<std::uint32_t>(out_.size() - length_at - 4));
  }
  template <class Integer>
  void overwrite(std::size_t at, Integer value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
      out_[at + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
  }

 private:
  std::vector<std::uint8_t>& out_;
};

/// Reads MCAP's basic types. A value that exceeds the bytes left reads as zero or empty, and ok() is then
/// false.
class McapUnpacker {
 public:
  explicit McapUnpacker(ByteSpan data) : rest_(data) {}
  bool ok() const { return ok_; }
  std::size_t left() const { return rest_.size(); }

  template <class Integer>
  Integer get() {
    std::uint64_t value = 0;
    const ByteSpan own = take(sizeof(Integer));
    for (std::size_t i = 0; i < own.size(); ++i) value |= static_cast<std::uint64_t>(own[i]) << (8 * i);
    return static_cast<Integer>(value);
  }
  ByteSpan take(std::uint64_t size) {
    if (size > rest_.size()) {
      ok_ = false;
      rest_ = {};
      return {};
    }
    const ByteSpan own = rest_.first(static_cast<std::size_t>(size));
    rest_ = rest_.subspan(static_cast<std::size_t>(size));
    return own;
  }
  std::string text() {
    const ByteSpan own = take(get<std::uint32_t>());
    return {own.begin(), own.end()};
  }
  Text map() {
    McapUnpacker entries(take(get<std::uint32_t>()));
    Text out;
    while (entries.ok() && entries.left() > 0) {
      std::string key = entries.text();
      out[std::move(key)] = entries.text();
    }
    ok_ = ok_ && entries.ok();
    return out;
  }

 private:
  ByteSpan rest_;
  bool ok_{true};
};

/// CRC-32 as in zlib and MCAP (IEEE 802.3, reflected). `before`: the CRC of the preceding bytes.
std::uint32_t crc32(ByteSpan data, std::uint32_t before = 0);

}  // namespace adit::record
