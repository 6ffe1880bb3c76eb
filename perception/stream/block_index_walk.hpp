// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "perception/map/block.hpp"
#include "perception/stream/block_coder.hpp"
#include "perception/stream/block_context.hpp"

namespace adit::perception {

/// Steps to the neighbours in an array of `width`^3, x fastest; with `mirrored`, bit a set: along axis a
/// positive is outward of that part of its parent, else of the opposite one.
constexpr std::array<std::int16_t, kNeighbours> neighbour_steps(int width, int octant) {
  std::array<std::int16_t, kNeighbours> out{};
  for (int n = 0; n < kNeighbours; ++n) {
    const auto offset = neighbour_offset(n);
    int step = 0;
    for (int axis = 2; axis >= 0; --axis)
      step = step * width + ((octant >> axis & 1) != 0 ? offset[static_cast<std::size_t>(axis)]
                                                       : -offset[static_cast<std::size_t>(axis)]);
    out[static_cast<std::size_t>(n)] = static_cast<std::int16_t>(step);
  }
  return out;
}

/// Numbers of both signs as numbers without, small ones small.
inline std::uint32_t zigzag(std::int32_t v) {
  return static_cast<std::uint32_t>(v) << 1 ^ static_cast<std::uint32_t>(v >> 31);
}
inline std::int32_t unzigzag(std::uint32_t v) { return static_cast<std::int32_t>(v >> 1 ^ (~(v & 1) + 1)); }
/// Visits the decisions that make up the indices of a set of blocks: the box around them, and then, if there
/// are at most kDenseCells cells a block in it, for each cell whether a block is there, else the gaps between
/// blocks. See BlockWalk for `Coder`. False if what was read makes no sense.
template <class Coder>
bool walk_indices(Coder& coder, int level, std::vector<BlockIndex>& indices) {
  constexpr std::uint32_t kDenseCells = 16;
  std::array<std::uint8_t, 27> none{};
  none.fill(kNotCoded);
  const bool writes = !indices.empty();
  BlockIndex low{}, high{};
  if (writes) {
    low = high = indices.front();
    for (const BlockIndex& i : indices) {
      low = {std::min(low.x, i.x), std::min(low.y, i.y), std::min(low.z, i.z)};
      high = {std::max(high.x, i.x), std::max(high.y, i.y), std::max(high.z, i.z)};
    }
  }
  const std::uint32_t count = coder.number(static_cast<std::uint32_t>(indices.size()));
  if (count > kMaxSetBlocks) return false;
  if (count == 0) return true;
  std::array<std::uint64_t, 3> size{};
  const std::array<std::int32_t*, 3> lows{&low.x, &low.y, &low.z}, highs{&high.x, &high.y, &high.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    *lows[axis] = unzigzag(coder.number(zigzag(*lows[axis])));
    const std::uint32_t extent = coder.number(static_cast<std::uint32_t>(*highs[axis] - *lows[axis]));
    if (*lows[axis] <= -BlockIndex::kLimit || *lows[axis] >= BlockIndex::kLimit ||
        extent >= 2 * BlockIndex::kLimit ||
        *lows[axis] + static_cast<std::int32_t>(extent) >= BlockIndex::kLimit)
      return false;
    size[axis] = extent + 1;
  }
  const std::uint64_t volume = size[0] * size[1] * size[2];
  if (volume < count) return false;
  const auto cell_of = [&](const BlockIndex& i) {
    return (static_cast<std::uint64_t>(i.x - low.x) * size[1] + static_cast<std::uint64_t>(i.y - low.y)) *
               size[2] +
           static_cast<std::uint64_t>(i.z - low.z);
  };
  const auto block_in = [&](std::uint64_t cell) {
    return BlockIndex{low.x + static_cast<std::int32_t>(cell / size[2] / size[1]),
                      low.y + static_cast<std::int32_t>(cell / size[2] % size[1]),
                      low.z + static_cast<std::int32_t>(cell % size[2])};
  };
  std::vector<BlockIndex> got;
  if (volume <= std::uint64_t{kDenseCells} * count) {
    // An array with a margin, z fastest.
    const auto wide_y = static_cast<std::size_t>(size[1] + 2), wide_z = static_cast<std::size_t>(size[2] + 2);
    std::vector<std::uint8_t> grid(static_cast<std::size_t>(size[0] + 2) * wide_y * wide_z, kNotCoded);
    std::array<std::int16_t, kNeighbours> steps{};
    std::size_t next = 0;
    std::array<std::uint8_t, 27> around{};
    steps = neighbour_steps(3, 7);
    for (std::uint64_t cell = 0; cell < volume; ++cell) {
      const BlockIndex index = block_in(cell);
      const std::size_t at = (static_cast<std::size_t>(index.x - low.x + 1) * wide_y +
                              static_cast<std::size_t>(index.y - low.y + 1)) *
                                 wide_z +
                             static_cast<std::size_t>(index.z - low.z + 1);
      const bool is_there = writes && next < indices.size() && indices[next] == index;
      bool there = false;
      const std::uint64_t left = count - got.size();
      if (left == volume - cell) {
        there = true;
      } else if (left != 0) {
        for (int n = 0; n < kNeighbours; ++n) {
          const auto o = neighbour_offset(n);
          const std::ptrdiff_t to =
              (o[0] * static_cast<std::ptrdiff_t>(wide_y) + o[1]) * static_cast<std::ptrdiff_t>(wide_z) +
              o[2];
          around[static_cast<std::size_t>(13 + steps[static_cast<std::size_t>(n)])] =
              grid[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + to)];
        }
        const VoxelContext context{&around[13], &steps, &none[13], &steps, 0, level};
        there = coder.decide(block_present, context, is_there);
      }
      grid[at] = there ? kKnown : kUnknown;
      if (there) got.push_back(index);
      if (is_there) ++next;
    }
  } else {
    // Gaps between the blocks' cells, in Golomb's code for their mean.
    const int low_bits = std::bit_width(volume / count) - 1;
    std::uint64_t cell = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint64_t gap = writes ? cell_of(indices[i]) - cell : 0;
      std::uint64_t value = coder.number(static_cast<std::uint32_t>(gap >> low_bits));
      if (value > volume >> low_bits) return false;
      const int high_bits = std::max(0, low_bits - 24);
      value = value << high_bits |
              coder.raw(static_cast<std::uint32_t>(gap >> (low_bits - high_bits)) & ((1u << high_bits) - 1),
                        high_bits);
      value = value << (low_bits - high_bits) |
              coder.raw(static_cast<std::uint32_t>(gap) & ((1u << (low_bits - high_bits)) - 1),
                        low_bits - high_bits);
      cell += value;
      if (cell >= volume) return false;
      got.push_back(block_in(cell));
      ++cell;
    }
  }
  indices = std::move(got);
  return true;
}

}  // namespace adit::perception
