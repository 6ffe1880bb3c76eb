// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "core/store/disk.hpp"

namespace adit::store {

/// Serialises values in sequence, little endian, without padding.
class Packer {
 public:
  template <std::unsigned_integral T>
  Packer& put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes_.push_back(static_cast<std::uint8_t>(std::uint64_t{value} >> (8 * i)));
    return *this;
  }
  Packer& put(bool value) = delete;  // Use flag().
  Packer& flag(bool value) { return put(static_cast<std::uint8_t>(value ? 1 : 0)); }
  Packer& put(double value) { return put(std::bit_cast<std::uint64_t>(value)); }
  /// Writes seven bits a byte, the lowest first (LEB128): small numbers are short.
  Packer& varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) put(static_cast<std::uint8_t>(value | 0x80));
    return put(static_cast<std::uint8_t>(value));
  }
  /// Writes a varint in which numbers near zero of both signs are short.
  Packer& zigzag(std::int64_t value) {
    return varint(static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63));
  }
  /// Writes the text after its length, cut off at the largest Length.
  template <std::unsigned_integral Length = std::uint16_t>
  Packer& text(std::string_view value) {
    value = value.substr(0, std::numeric_limits<Length>::max());
    put(static_cast<Length>(value.size()));
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    return *this;
  }
  template <std::size_t N>
  Packer& put(const std::array<std::uint8_t, N>& value) {
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    return *this;
  }
  Packer& raw(std::span<const std::uint8_t> value) {
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    return *this;
  }
  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_{};
};

/// Deserialises values. After the first value that does not fit, all further ones fail: check good() at the
/// end.
class Unpacker {
 public:
  explicit Unpacker(std::span<const std::uint8_t> bytes) : left_(bytes) {}

  template <std::unsigned_integral T>
  T get() {
    const auto part = take(sizeof(T));
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < part.size(); ++i) value |= std::uint64_t{part[i]} << (8 * i);
    return static_cast<T>(value);
  }
  /// Any value except 0 and 1 fails.
  bool flag() {
    const auto value = get<std::uint8_t>();
    if (value > 1) good_ = false;
    return value == 1;
  }
  double number() { return std::bit_cast<double>(get<std::uint64_t>()); }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto byte = get<std::uint8_t>();
      value |= std::uint64_t{byte & 0x7fu} << shift;
      if ((byte & 0x80u) == 0) return good_ ? value : 0;
    }
    good_ = false;
    return 0;
  }
  std::int64_t zigzag() {
    const std::uint64_t value = varint();
    return static_cast<std::int64_t>(value >> 1 ^ (~(value & 1) + 1));
  }
  /// A text longer than `max` fails.
  template <std::unsigned_integral Length = std::uint16_t>
  std::string text(std::size_t max) {
    const auto size = get<Length>();
    if (size > max) good_ = false;
    const auto part = take(size);
    return {part.begin(), part.end()};
  }
  template <std::size_t N>
  std::array<std::uint8_t, N> array() {
    std::array<std::uint8_t, N> value{};
    const auto part = take(N);
    for (std::size_t i = 0; i < part.size(); ++i) value[i] = part[i];
    return value;
  }
  /// Bytes after their number, as 16 bits; more than `max` fail.
  std::span<const std::uint8_t> bytes(std::size_t max) { return take(count(max)); }
  /// Reads a number of elements; more than `max` fails and returns 0.
  std::size_t count(std::size_t max) {
    const auto value = get<std::uint16_t>();
    if (value > max) good_ = false;
    return good_ ? value : 0;
  }
  /// Refuses what was read: good() is false from now on.
  void fail() { good_ = false; }
  bool good() const { return good_; }
  /// Whether everything was good and no bytes are left.
  bool done() const { return good_ && left_.empty(); }
  std::span<const std::uint8_t> rest() const { return left_; }

 private:
  /// Returns an empty span when fewer than `size` bytes are left.
  std::span<const std::uint8_t> take(std::size_t size) {
    if (!good_ || size > left_.size()) {
      good_ = false;
      return {};
    }
    const auto part = left_.first(size);
    left_ = left_.subspan(size);
    return part;
  }
  std::span<const std::uint8_t> left_;
  bool good_{true};
};

}  // namespace adit::store
