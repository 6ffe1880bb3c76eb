// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace adit::sim {

/// A 128-bit fingerprint of a stream of bytes and numbers, eight bytes a step. Equal streams, equal digests,
/// on every machine of the same byte order. Not meant against somebody who forges one. The mixing step is
/// the finaliser of splitmix64 (Steele et al. 2014), in two lanes.
class Digest {
 public:
  void add(std::uint64_t word);
  void add(double value);
  void add(std::string_view text);
  void add(std::span<const std::uint8_t> bytes);
  /// 32 hexadecimal digits.
  std::string text() const;

 private:
  std::uint64_t a_{0x9e3779b97f4a7c15ULL};
  std::uint64_t b_{0xd1342543de82ef95ULL};
};

}  // namespace adit::sim
