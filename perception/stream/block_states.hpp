// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "perception/stream/block_context.hpp"
#include "perception/stream/block_set.hpp"

namespace adit::perception {

/// States of the voxels of a set of blocks, bits of block_context.hpp, at each of its levels: those of block
/// b at a level from b 8^level on.
class BlockStates {
 public:
  using Level = std::vector<std::uint8_t>;

  static constexpr std::size_t size_at(int level) { return std::size_t{1} << (3 * level); }
  /// Where part `child` of voxel `parent` is in its block, at the level of the part.
  static constexpr std::size_t part_at(std::size_t parent, int child, int level) {
    const std::size_t edge = std::size_t{1} << level, half = edge / 2;
    const std::size_t x = parent % half, y = parent / half % half, z = parent / half / half;
    const auto c = static_cast<std::size_t>(child);
    return (2 * x + (c & 1)) + edge * (2 * y + (c >> 1 & 1)) + edge * edge * (2 * z + (c >> 2));
  }

  Level& operator[](int level) { return levels_[static_cast<std::size_t>(level)]; }
  const Level& operator[](int level) const { return levels_[static_cast<std::size_t>(level)]; }

  static constexpr std::uint8_t state_of(Voxel v) {
    return v == Voxel::unknown ? kUnknown : v == Voxel::free ? kKnown : kKnown | kOccupied;
  }

  /// Fills the levels above `finest` from it. kFull then means that all voxels of the finest level are free.
  /// A voxel with a part that is kNotCoded is kNotCoded, too.
  void fill_above(int finest) {
    for (int level = finest; level > 0; --level) {
      const Level& parts = (*this)[level];
      Level& parents = (*this)[level - 1];
      const std::size_t size = size_at(level - 1);
      parents.assign(parts.size() / 8, 0);
      for (std::size_t i = 0; i < parents.size(); ++i) {
        std::uint8_t any = 0, all = kFull | kKnown;
        for (int child = 0; child < 8; ++child) {
          const std::uint8_t part = parts[i / size * 8 * size + part_at(i % size, child, level)];
          any |= part & (kKnown | kOccupied | kNotCoded);
          if ((part & kKnown) == 0 || (level < finest && (part & kFull) == 0)) all = 0;
        }
        const bool full = (any & kOccupied) == 0 && all != 0;
        parents[i] = static_cast<std::uint8_t>(any | (full ? kFull : 0));
      }
    }
  }

 private:
  std::array<Level, BlockSet::kLevels> levels_{};
};

}  // namespace adit::perception
