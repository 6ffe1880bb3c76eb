// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <compare>
#include <cstdint>
#include <string>

namespace adit::perception {

/// Names a submap on the air, on disk and in the station.
struct SubmapKey {
  std::string robot{};  ///< 1 to 32 characters.
  /// Id of the map that the robot began; a new map has a new id. From the highest bit: 1 (1 bit), the count
  /// of the robot's starts on its disk (15), a hash of its 128-bit id (32), random bits (16). Where the
  /// highest bit is 0, an earlier release gave the id: random bits are in the place of the hash.
  std::uint64_t start{};
  std::uint32_t index{};  ///< Number within that map, from 0.

  auto operator<=>(const SubmapKey&) const = default;
};

/// The SubmapKey::start of a robot's map. `count`: 1 for the first on its disk; `owner`: hash of its id.
constexpr std::uint64_t map_start(std::uint64_t count, std::uint32_t owner, std::uint64_t random) {
  return std::uint64_t{1} << 63U | (count & 0x7FFFU) << 48U | std::uint64_t{owner} << 16U |
         (random & 0xFFFFU);
}
constexpr std::uint64_t count_of(std::uint64_t start) { return start >> 48U & 0x7FFFU; }
/// Distinguishes robots of one name: counts of different owners cannot be compared. 0: an earlier release
/// gave the id.
constexpr std::uint32_t owner_of(std::uint64_t start) {
  return start >> 63U == 0 ? 0 : static_cast<std::uint32_t>(start >> 16U);
}

}  // namespace adit::perception
