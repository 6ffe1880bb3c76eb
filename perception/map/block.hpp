// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <compare>
#include <cstdint>

namespace adit::perception {

/// State of a voxel.
enum class Voxel : std::uint8_t { unknown, free, occupied };

/// Indices of a cube of 0.8 m: it covers [0.8 i, 0.8 (i + 1)) along each axis of its submap, m.
struct BlockIndex {
  static constexpr float kSize = 0.8f;    ///< Edge, m.
  static constexpr int kLimit = 1 << 15;  ///< |index| < kLimit, so 26 km from the submap's origin.
  std::int32_t x{}, y{}, z{};

  auto operator<=>(const BlockIndex&) const = default;
};

/// A block in voxels of 0.2 m: 4 x 4 x 4 of them, bit x + 4 y + 16 z. `occupied` is a subset of `known`; a
/// voxel that is known and not occupied is free.
struct CoarseBlock {
  static constexpr int kEdge = 4;
  static constexpr float kVoxel = 0.2f;  ///< m
  BlockIndex index{};
  std::uint64_t known{};
  std::uint64_t occupied{};

  Voxel at(int x, int y, int z) const {
    const std::uint64_t bit = std::uint64_t{1} << (x + 4 * y + 16 * z);
    return (known & bit) == 0 ? Voxel::unknown : (occupied & bit) != 0 ? Voxel::occupied : Voxel::free;
  }
  bool operator==(const CoarseBlock&) const = default;
};

}  // namespace adit::perception
