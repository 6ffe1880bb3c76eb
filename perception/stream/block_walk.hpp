// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "perception/map/block_hash.hpp"
#include "perception/stream/block_coder.hpp"
#include "perception/stream/block_context.hpp"
#include "perception/stream/block_index_walk.hpp"
#include "perception/stream/block_set.hpp"

namespace adit::perception {

/// Visits the decisions that make up a set of blocks, in the order in which they are coded: the indices, then
/// all blocks at level 0, then all at level 1 and so on, so that a voxel's surroundings are known on the
/// level above wherever a block is in the set. The same code writes, reads, and trains.
///
/// `Coder` has bool decide(int decision, const VoxelContext&, bool value), which returns the value that was
/// coded, bool raw(bool value), std::uint32_t raw(std::uint32_t value, int bits), std::uint32_t
/// number(std::uint32_t), and void begin(std::size_t block), which is called before the decisions of a block.
template <class Coder>
class BlockWalk {
 public:
  /// `max_level`: finer sets are not read.
  explicit BlockWalk(Coder& coder, int max_level = BlockSet::kLevels - 1)
      : coder_(coder), max_level_(max_level) {}

  /// Writes a set whose blocks are in rising order, different, within BlockIndex::kLimit, and at most
  /// kMaxSetBlocks.
  void write(const BlockSet& set) {
    level_ = set.level;
    indices_ = set.indices;
    prepare_truth(set);
    walk();
  }
  /// Reads a set; false if it makes no sense. Takes bounded time and memory whatever the coder returns.
  bool read(BlockSet& set) {
    indices_.clear();
    if (!walk()) return false;
    set.level = level_;
    set.indices = indices_;
    const std::vector<std::uint8_t>& states = coded_[static_cast<std::size_t>(level_)];
    set.voxels.resize(states.size());
    std::transform(states.begin(), states.end(), set.voxels.begin(), [](std::uint8_t s) {
      return (s & kOccupied) != 0 ? Voxel::occupied : (s & kKnown) != 0 ? Voxel::free : Voxel::unknown;
    });
    return true;
  }

 private:
  using States = std::vector<std::uint8_t>;
  static constexpr int kWidest = 10;
  using Padded = std::array<std::uint8_t, kWidest * kWidest * kWidest>;
  static constexpr std::int32_t kAbsent = -1;

  static std::size_t size_at(int level) { return std::size_t{1} << (3 * level); }
  /// Where part `child` of voxel `parent` is in its block.
  static std::size_t part_at(std::size_t parent, int child, int level) {
    const std::size_t edge = std::size_t{1} << level, half = edge / 2;
    const std::size_t x = parent % half, y = parent / half % half, z = parent / half / half;
    const auto c = static_cast<std::size_t>(child);
    return (2 * x + (c & 1)) + edge * (2 * y + (c >> 1 & 1)) + edge * edge * (2 * z + (c >> 2));
  }
  static std::size_t in_padded(std::size_t voxel, int level) {
    const std::size_t edge = std::size_t{1} << level, width = edge + 2;
    return voxel % edge + 1 + width * (voxel / edge % edge + 1) + width * width * (voxel / edge / edge + 1);
  }
  static int octant_of(std::size_t voxel, int level) {
    const std::size_t edge = std::size_t{1} << level;
    return static_cast<int>((voxel & 1) | (voxel / edge & 1) << 1 | (voxel / edge / edge & 1) << 2);
  }

  void prepare_truth(const BlockSet& set) {
    States& finest = truth_[static_cast<std::size_t>(level_)];
    finest.resize(set.voxels.size());
    std::transform(set.voxels.begin(), set.voxels.end(), finest.begin(), [](Voxel v) -> std::uint8_t {
      return v == Voxel::unknown ? kUnknown : v == Voxel::free ? kKnown : kKnown | kOccupied;
    });
    for (int level = level_; level > 0; --level) {
      const States& parts = truth_[static_cast<std::size_t>(level)];
      States& wholes = truth_[static_cast<std::size_t>(level - 1)];
      const std::size_t size = size_at(level - 1);
      wholes.assign(indices_.size() * size, 0);
      for (std::size_t i = 0; i < wholes.size(); ++i) {
        std::uint8_t any = 0, all = kFull | kKnown;
        for (int child = 0; child < 8; ++child) {
          const std::uint8_t part = parts[i / size * 8 * size + part_at(i % size, child, level)];
          any |= part & (kKnown | kOccupied);
          if ((part & kKnown) == 0 || (level < level_ && (part & kFull) == 0)) all = 0;
        }
        const bool full = (any & kOccupied) == 0 && all != 0;
        // kFull here means that all voxels at the finest level are free; see is_full().
        wholes[i] = static_cast<std::uint8_t>(any | (full ? kFull : 0));
      }
    }
  }
  std::uint8_t truth(int level, std::size_t at) const {
    const States& states = truth_[static_cast<std::size_t>(level)];
    return states.empty() ? std::uint8_t{0} : states[at];
  }
  /// Whether all parts of a voxel are known.
  bool is_full(int level, std::size_t block, std::size_t voxel) const {
    if (truth_[static_cast<std::size_t>(level)].empty()) return false;
    for (int child = 0; child < 8; ++child)
      if ((truth(level + 1, block * size_at(level + 1) + part_at(voxel, child, level + 1)) & kKnown) == 0)
        return false;
    return true;
  }

  bool walk() {
    level_ = static_cast<int>(coder_.raw(static_cast<std::uint32_t>(level_), 2));
    if (level_ > max_level_) return false;
    none_.fill(kNotCoded);
    if (!walk_indices(coder_, level_, indices_)) return false;
    find_neighbours();
    for (int level = 0; level <= level_; ++level)
      coded_[static_cast<std::size_t>(level)].assign(indices_.size() * size_at(level), kNotCoded);
    for (std::size_t block = 0; block < indices_.size(); ++block) walk_block(block);
    for (int level = 1; level <= level_; ++level) {
      if (level > 1 || level_ > 1)
        for (std::size_t block = 0; block < indices_.size(); ++block) walk_full(block, level);
      for (std::size_t block = 0; block < indices_.size(); ++block) walk_parts(block, level);
    }
    return true;
  }

  void find_neighbours() {
    neighbours_.assign(indices_.size(), {});
    for (std::size_t n = 0; n < 27; ++n) {
      const auto cell = static_cast<int>(n);
      std::size_t at = 0;  // What is looked for rises with the blocks.
      for (std::size_t block = 0; block < indices_.size(); ++block) {
        const BlockIndex wanted{indices_[block].x + cell % 3 - 1, indices_[block].y + cell / 3 % 3 - 1,
                                indices_[block].z + cell / 9 - 1};
        while (at < indices_.size() && indices_[at] < wanted) ++at;
        const bool found = at < indices_.size() && indices_[at] == wanted;
        neighbours_[block][n] = found ? static_cast<std::int32_t>(at) : kAbsent;
      }
    }
  }

  /// Copies a level of a block with a margin of one voxel of its neighbours.
  void pad(int level, std::size_t block, Padded& out) const {
    const int edge = 1 << level;
    const States& states = coded_[static_cast<std::size_t>(level)];
    std::size_t at = 0;
    for (int z = -1; z <= edge; ++z)
      for (int y = -1; y <= edge; ++y)
        for (int x = -1; x <= edge; ++x, ++at) {
          const auto part = [edge](int v) { return v < 0 ? 0 : v < edge ? 1 : 2; };
          const std::int32_t from =
              neighbours_[block][static_cast<std::size_t>(part(x) + 3 * part(y) + 9 * part(z))];
          const int mask = edge - 1;
          const int voxel = (x & mask) + edge * (y & mask) + edge * edge * (z & mask);
          out[at] =
              from == kAbsent
                  ? kNotCoded
                  : states[static_cast<std::size_t>(from) * size_at(level) + static_cast<std::size_t>(voxel)];
        }
  }

  static const std::array<std::int16_t, kNeighbours>& steps_at(int level, int octant) {
    static constexpr auto kSteps = [] {
      std::array<std::array<std::array<std::int16_t, kNeighbours>, 8>, BlockSet::kLevels> out{};
      for (int l = 0; l < BlockSet::kLevels; ++l)
        for (int o = 0; o < 8; ++o)
          out[static_cast<std::size_t>(l)][static_cast<std::size_t>(o)] = neighbour_steps((1 << l) + 2, o);
      return out;
    }();
    return kSteps[static_cast<std::size_t>(level)][static_cast<std::size_t>(octant)];
  }

  void walk_block(std::size_t block) {
    coder_.begin(block);
    pad(0, block, fine_);
    const VoxelContext context{&fine_[13], &steps_at(0, 7), &none_[13], &steps_at(0, 7), 0, level_};
    const std::uint8_t is = truth(0, block);
    std::uint8_t& state = coded_[0][block];
    state = kUnknown;
    if (!coder_.decide(block_known, context, (is & kKnown) != 0)) return;
    state = kKnown;
    if (coder_.decide(block_occupied, context, (is & kOccupied) != 0)) {
      state |= kOccupied;
    } else if (level_ > 0 && coder_.decide(block_uniform, context, (is & kFull) != 0)) {
      for (int level = 0; level <= level_; ++level) {
        States& states = coded_[static_cast<std::size_t>(level)];
        const auto first = states.begin() + static_cast<std::ptrdiff_t>(block * size_at(level));
        std::fill_n(first, size_at(level),
                    static_cast<std::uint8_t>(level < level_ ? kKnown | kFull : kKnown));
      }
    }
  }

  /// Whether all voxels of a block are known to both sides.
  bool is_done(std::size_t block) const {
    return coded_[static_cast<std::size_t>(level_)][block * size_at(level_)] != kNotCoded;
  }

  /// For each free voxel of the level above: are all its parts known?
  void walk_full(std::size_t block, int level) {
    if (coded_[0][block] == kUnknown || is_done(block)) return;
    coder_.begin(block);
    const int above = level - 1;
    pad(above, block, fine_);
    if (above > 0) pad(above - 1, block, coarse_);
    States& states = coded_[static_cast<std::size_t>(above)];
    for (std::size_t voxel = 0; voxel < size_at(above); ++voxel) {
      std::uint8_t& state = states[block * size_at(above) + voxel];
      if (state != kKnown) continue;
      const std::size_t at = in_padded(voxel, above);
      const int octant = above > 0 ? octant_of(voxel, above) : 0;
      const VoxelContext context{
          &fine_[at],
          &steps_at(above, 7),
          above > 0 ? &coarse_[in_padded(parent_of(voxel, above), above - 1)] : &none_[13],
          above > 0 ? &steps_at(above - 1, octant) : &steps_at(0, 7),
          octant,
          level_};
      if (!coder_.decide(decision_at(all_parts_known, level), context, is_full(above, block, voxel)))
        continue;
      state |= kFull;
      fine_[at] = state;
    }
  }
  static std::size_t parent_of(std::size_t voxel, int level) {
    const std::size_t edge = std::size_t{1} << level, half = edge / 2;
    return voxel % edge / 2 + half * (voxel / edge % edge / 2) + half * half * (voxel / edge / edge / 2);
  }

  void walk_parts(std::size_t block, int level) {
    if (coded_[0][block] != kUnknown && is_done(block)) return;
    coder_.begin(block);
    const std::size_t first = block * size_at(level);
    States& parts = coded_[static_cast<std::size_t>(level)];
    if (coded_[0][block] == kUnknown) {
      std::fill_n(parts.begin() + static_cast<std::ptrdiff_t>(first), size_at(level), kUnknown);
      return;
    }
    pad(level, block, fine_);
    pad(level - 1, block, coarse_);
    for (std::size_t parent = 0; parent < size_at(level - 1); ++parent) {
      const std::size_t above = in_padded(parent, level - 1);
      const std::uint8_t whole = coarse_[above];
      std::uint8_t seen = 0;
      for (int child = 0; child < 8; ++child) {
        const std::size_t voxel = part_at(parent, child, level);
        const std::size_t at = in_padded(voxel, level);
        const std::uint8_t is = truth(level, first + voxel);
        std::uint8_t state = kUnknown;
        if ((whole & kFull) != 0) {
          state = kKnown;
        } else if ((whole & kKnown) != 0) {
          const VoxelContext context{
              &fine_[at], &steps_at(level, 7), &coarse_[above], &steps_at(level - 1, child), child, level_};
          const bool last = child == 7;
          if ((whole & kOccupied) == 0) {
            // Some part is known, and if the level above could say that all are, not all of them.
            const bool known =
                last && (seen & 0x7f) == 0 ? true
                : last && (seen & 0x7f) == 0x7f
                    ? false
                    : coder_.decide(decision_at(part_known_of_free, level), context, (is & kKnown) != 0);
            if (known) seen |= static_cast<std::uint8_t>(1u << child);
            state = known ? kKnown : kUnknown;
          } else if (last && seen == 0) {
            state = kKnown | kOccupied;
          } else if (coder_.decide(decision_at(part_known_of_occupied, level), context, (is & kKnown) != 0)) {
            const bool occupied =
                coder_.decide(decision_at(part_occupied, level), context, (is & kOccupied) != 0);
            state = occupied ? kKnown | kOccupied : kKnown;
            if (occupied) seen = 1;
          }
        }
        fine_[at] = state;
        parts[first + voxel] = state;
      }
    }
  }

  Coder& coder_;
  int max_level_;
  int level_{0};
  std::vector<BlockIndex> indices_{};
  std::vector<std::array<std::int32_t, 27>> neighbours_{};
  std::array<States, BlockSet::kLevels> truth_{};
  std::array<States, BlockSet::kLevels> coded_{};
  Padded fine_{}, coarse_{};
  std::array<std::uint8_t, 27> none_{};
};

}  // namespace adit::perception
