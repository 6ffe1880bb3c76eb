// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace adit::perception {

/// Probabilities of a bit are in units of 2^-16, [1, 65535].
constexpr int kProbabilityBits = 16;

/// Writes bits of known probability as a number in [0, 1), whose digits are bytes: a binary range coder with
/// 32 bits of range, which carries into bytes that it wrote before.
///
/// G. N. N. Martin, Range encoding (1979); the carry is handled as in LZMA (I. Pavlov, 7-Zip).
class RangeEncoder {
 public:
  /// Writes a bit, which is 1 with probability `one`.
  void bit(bool value, std::uint32_t one) {
    const std::uint32_t bound = (range_ >> kProbabilityBits) * one;
    if (value) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    while (range_ < kSmallest) {
      range_ <<= 8;
      shift();
    }
  }
  /// Writes the lowest `count` bits of a value, [0, 32], all equally probable.
  void bits(std::uint32_t value, int count) {
    while (count-- > 0) bit((value >> count & 1) != 0, 1u << (kProbabilityBits - 1));
  }
  /// Writes a number, [0, 2^32 - 2]; small ones are short: Elias gamma code of the number plus one.
  void number(std::uint32_t value);

  /// Bits that were written, to about one bit.
  std::size_t position() const;
  /// Ends the number with as few bytes as possible. The encoder is used up.
  std::vector<std::uint8_t> finish();

 private:
  static constexpr std::uint32_t kSmallest = 1u << 24;
  void shift();

  std::uint64_t low_{0};
  std::uint32_t range_{0xffffffffu};
  std::uint8_t held_{0};    ///< Byte that a carry may still change.
  std::size_t pending_{0};  ///< Bytes of 0xff after it.
  bool started_{false};     ///< The byte before the first one is always zero, and is not written.
  std::vector<std::uint8_t> bytes_{};
};

/// Reads what RangeEncoder wrote, given the same probabilities. Bytes after the end read as zero, so that any
/// input gives some bits; nothing outside the span is read.
class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const std::uint8_t> bytes);

  bool bit(std::uint32_t one) {
    const std::uint32_t bound = (range_ >> kProbabilityBits) * one;
    const bool value = code_ < bound;
    if (value) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    while (range_ < kSmallest) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
    return value;
  }
  std::uint32_t bits(int count) {
    std::uint32_t value = 0;
    while (count-- > 0) value = value << 1 | (bit(1u << (kProbabilityBits - 1)) ? 1u : 0u);
    return value;
  }
  std::uint32_t number();

 private:
  static constexpr std::uint32_t kSmallest = 1u << 24;
  std::uint32_t next() { return at_ < bytes_.size() ? bytes_[at_++] : 0u; }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_{0};
  std::uint32_t range_{0xffffffffu};
  std::uint32_t code_{0};
};

}  // namespace adit::perception
