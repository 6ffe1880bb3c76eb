// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/range_coder.hpp"

#include <bit>
#include <utility>

namespace adit::perception {

void RangeEncoder::shift() {
  const bool carry = low_ >> 32 != 0;
  const auto top = static_cast<std::uint8_t>(low_ >> 24);
  if (carry || top != 0xff) {
    if (started_) bytes_.push_back(static_cast<std::uint8_t>(held_ + (carry ? 1 : 0)));
    bytes_.insert(bytes_.end(), pending_, static_cast<std::uint8_t>(carry ? 0x00 : 0xff));
    pending_ = 0;
    held_ = top;
    started_ = true;
  } else {
    ++pending_;
  }
  low_ = (low_ & 0x00ffffffu) << 8;
}

void RangeEncoder::number(std::uint32_t value) {
  const std::uint32_t shown = value + 1;
  const int length = std::bit_width(shown);
  for (int i = 1; i < length; ++i) bits(1, 1);
  if (length < 32) bits(0, 1);
  bits(shown & ((1u << (length - 1)) - 1), length - 1);
}

std::size_t RangeEncoder::position() const {
  return 8 * (bytes_.size() + pending_ + (started_ ? 1 : 0)) +
         static_cast<std::size_t>(std::countl_zero(range_));
}

std::vector<std::uint8_t> RangeEncoder::finish() {
  // The number of the interval that ends in most zeros.
  for (int zeros = 32; zeros >= 0; zeros -= 8) {
    const std::uint64_t unit = std::uint64_t{1} << zeros;
    const std::uint64_t rounded = (low_ + unit - 1) / unit * unit;
    if (rounded - low_ >= range_) continue;
    low_ = rounded;
    break;
  }
  for (int i = 0; i < 5; ++i) shift();
  while (!bytes_.empty() && bytes_.back() == 0) bytes_.pop_back();
  return std::move(bytes_);
}

RangeDecoder::RangeDecoder(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
  for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
}

std::uint32_t RangeDecoder::number() {
  int length = 1;
  while (length < 32 && bits(1) != 0) ++length;
  return ((1u << (length - 1)) | bits(length - 1)) - 1;
}

}  // namespace adit::perception
