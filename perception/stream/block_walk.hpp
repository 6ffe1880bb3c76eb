// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/store/crc32c.hpp"
#include "perception/map/block_hash.hpp"
#include "perception/stream/block_coder.hpp"
#include "perception/stream/block_context.hpp"
#include "perception/stream/block_index_walk.hpp"
#include "perception/stream/block_set.hpp"
#include "perception/stream/block_states.hpp"

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
  /// `max_level`: finer sets are not read. `find_base`: see write_blocks().
  explicit BlockWalk(Coder& coder, int max_level = BlockSet::kLevels - 1, FindBase find_base = {})
      : coder_(coder), max_level_(max_level), find_base_(std::move(find_base)) {}

  /// Writes a set whose blocks are in rising order, different, within BlockIndex::kLimit, and at most
  /// kMaxSetBlocks.
  void write(const BlockSet& set) {
    level_ = set.level;
    indices_ = set.indices;
    coarse_blocks_ = set.coarse;
    truth_[level_].resize(set.voxels.size());
    std::transform(set.voxels.begin(), set.voxels.end(), truth_[level_].begin(), BlockStates::state_of);
    truth_.fill_above(level_);
    static_cast<void>(walk());
  }
  /// What read() found.
  enum class Read { good, malformed, other_base };
  /// Reads a set. Takes bounded time and memory whatever the coder returns.
  Read read(BlockSet& set) {
    indices_.clear();
    if (const Read result = walk(); result != Read::good) return result;
    set.level = level_;
    set.indices = indices_;
    const bool any = std::find(coarse_blocks_.begin(), coarse_blocks_.end(), true) != coarse_blocks_.end();
    set.coarse = any ? coarse_blocks_ : std::vector<bool>();
    const States& states = coded_[level_];
    set.voxels.resize(states.size());
    std::transform(states.begin(), states.end(), set.voxels.begin(), [](std::uint8_t s) {
      return (s & kOccupied) != 0 ? Voxel::occupied : (s & kKnown) != 0 ? Voxel::free : Voxel::unknown;
    });
    return Read::good;
  }

 private:
  using States = BlockStates::Level;
  static constexpr int kWidest = 10;
  using Padded = std::array<std::uint8_t, kWidest * kWidest * kWidest>;
  static constexpr std::int32_t kAbsent = -1;
  static constexpr int kBaseLevel = 2;

  static std::size_t size_at(int level) { return BlockStates::size_at(level); }
  static std::size_t in_padded(std::size_t voxel, int level) {
    const std::size_t edge = std::size_t{1} << level, width = edge + 2;
    return voxel % edge + 1 + width * (voxel / edge % edge + 1) + width * width * (voxel / edge / edge + 1);
  }
  static int octant_of(std::size_t voxel, int level) {
    const std::size_t edge = std::size_t{1} << level;
    return static_cast<int>((voxel & 1) | (voxel / edge & 1) << 1 | (voxel / edge / edge & 1) << 2);
  }

  std::uint8_t truth(int level, std::size_t at) const {
    return truth_[level].empty() ? std::uint8_t{0} : truth_[level][at];
  }
  /// Whether all parts of a voxel are known.
  bool is_full(int level, std::size_t block, std::size_t voxel) const {
    if (truth_[level].empty()) return false;
    for (int child = 0; child < 8; ++child)
      if ((truth(level + 1, block * size_at(level + 1) + BlockStates::part_at(voxel, child, level + 1)) &
           kKnown) == 0)
        return false;
    return true;
  }

  Read walk() {
    level_ = static_cast<int>(coder_.raw(static_cast<std::uint32_t>(level_), 2));
    if (level_ > max_level_) return Read::malformed;
    none_.fill(kNotCoded);
    if (!walk_indices(coder_, level_, indices_)) return Read::malformed;
    if (!walk_coarse()) return Read::malformed;
    if (const Read result = walk_bases(); result != Read::good) return result;
    find_neighbours();
    for (int level = 0; level <= level_; ++level)
      coded_[level].assign(indices_.size() * size_at(level), kNotCoded);
    for (std::size_t block = 0; block < indices_.size(); ++block) walk_block(block);
    for (int level = 1; level <= level_; ++level) {
      if (level > 1 || level_ > 1)
        for (std::size_t block = 0; block < indices_.size(); ++block) walk_full(block, level);
      for (std::size_t block = 0; block < indices_.size(); ++block) walk_parts(block, level);
    }
    return Read::good;
  }

  /// Of which blocks only voxels of 0.4 m are known.
  bool walk_coarse() {
    coarse_blocks_.resize(indices_.size());
    if (level_ != kBaseLevel || indices_.empty()) return true;
    const auto count = std::count(coarse_blocks_.begin(), coarse_blocks_.end(), true);
    const std::uint32_t which = choice(static_cast<std::size_t>(count), indices_.size());
    for (std::size_t block = 0; block < indices_.size(); ++block)
      coarse_blocks_[block] = which == 1 || (which == 2 && coder_.raw(coarse_blocks_[block] ? 1 : 0, 1) != 0);
    return which <= 2;
  }
  /// None, all, or a bit for each block: 0, 1, 2.
  std::uint32_t choice(std::size_t count, std::size_t all) {
    return coder_.raw(count == 0 ? 0 : count == all ? 1 : 2, 2);
  }

  /// Which blocks have a base, and a checksum of all of these. Bases are of voxels of 0.2 m.
  Read walk_bases() {
    has_base_.assign(indices_.size(), false);
    if (level_ != kBaseLevel || indices_.empty()) return Read::good;
    const bool writes = !truth_[level_].empty();
    std::vector<std::optional<CoarseBlock>> bases(indices_.size());
    std::size_t count = 0, fine = 0;
    for (std::size_t block = 0; block < indices_.size(); ++block) {
      if (coarse_blocks_[block]) continue;
      ++fine;
      if (!writes || !find_base_) continue;
      bases[block] = find_base_(indices_[block]);
      has_base_[block] = bases[block] && is_known_of(block, bases[block]->known);
      if (!has_base_[block]) bases[block].reset();
      count += has_base_[block] ? 1 : 0;
    }
    const std::uint32_t which = choice(count, fine);
    if (which > 2) return Read::malformed;
    if (which == 0) return Read::good;
    for (std::size_t block = 0; block < indices_.size(); ++block) {
      if (coarse_blocks_[block]) continue;
      has_base_[block] = which == 1 || coder_.raw(has_base_[block] ? 1 : 0, 1) != 0;
      if (!has_base_[block] || writes) continue;
      if (find_base_) bases[block] = find_base_(indices_[block]);
      if (!bases[block]) return Read::other_base;
    }
    const std::uint32_t sum = checksum_of(bases);
    if (coder_.raw(sum, 32) != sum) return Read::other_base;
    States& finest = base_[level_];
    finest.assign(indices_.size() * size_at(level_), kNotCoded);
    for (std::size_t block = 0; block < indices_.size(); ++block)
      for (std::size_t i = 0; bases[block] && i < size_at(level_); ++i)
        finest[block * size_at(level_) + i] = static_cast<std::uint8_t>(
            (bases[block]->known >> i & 1) * kKnown + (bases[block]->occupied >> i & 1) * kOccupied);
    base_.fill_above(level_);
    return Read::good;
  }
  /// Whether the set knows these voxels of a block.
  bool is_known_of(std::size_t block, std::uint64_t known) const {
    for (std::size_t i = 0; i < size_at(level_); ++i)
      if ((known >> i & 1) != 0 && (truth(level_, block * size_at(level_) + i) & kKnown) == 0) return false;
    return true;
  }
  static std::uint32_t checksum_of(const std::vector<std::optional<CoarseBlock>>& bases) {
    std::vector<std::uint8_t> bytes;
    for (const std::optional<CoarseBlock>& base : bases)
      for (int i = 0; base && i < 16; ++i)
        bytes.push_back(static_cast<std::uint8_t>((i < 8 ? base->known : base->occupied) >> 8 * (i % 8)));
    return crc32c(bytes);
  }
  /// The number of a decision about a block.
  int decision_of(std::size_t block, int decision) const {
    return has_base_[block] ? with_base(decision) : decision;
  }
  bool is_known_in_base(std::size_t block, int level, std::size_t voxel) const {
    return has_base_[block] && (base_[level][block * size_at(level) + voxel] & kKnown) != 0;
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
  void pad(const BlockStates& of, int level, std::size_t block, Padded& out) const {
    const int edge = 1 << level;
    const States& states = of[level];
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

  /// Surroundings of a voxel at `at` of the padded level, the `octant`-th part of the one at `parent` of the
  /// padded level above; level 0 has none above.
  VoxelContext context_at(int level, std::size_t at, int octant, std::size_t parent, bool has_base) const {
    const bool top = level == 0;
    return {&fine_[at],
            &steps_at(level, 7),
            top ? &none_[13] : &coarse_[parent],
            top ? &steps_at(0, 7) : &steps_at(level - 1, octant),
            octant,
            level_,
            has_base ? &base_fine_[at] : nullptr,
            has_base && !top ? &base_coarse_[parent] : nullptr};
  }

  void walk_block(std::size_t block) {
    coder_.begin(block);
    pad(coded_, 0, block, fine_);
    if (has_base_[block]) pad(base_, 0, block, base_fine_);
    const VoxelContext context = context_at(0, in_padded(0, 0), 0, 0, has_base_[block]);
    const std::uint8_t is = truth(0, block);
    std::uint8_t& state = coded_[0][block];
    state = kUnknown;
    if (!is_known_in_base(block, 0, 0) &&
        !coder_.decide(decision_of(block, block_known), context, (is & kKnown) != 0))
      return;
    state = kKnown;
    if (coder_.decide(decision_of(block, block_occupied), context, (is & kOccupied) != 0)) {
      state |= kOccupied;
    } else if (level_ > 0 && coder_.decide(decision_of(block, block_uniform), context, (is & kFull) != 0)) {
      for (int level = 0; level <= level_; ++level) {
        States& states = coded_[level];
        const auto first = states.begin() + static_cast<std::ptrdiff_t>(block * size_at(level));
        std::fill_n(first, size_at(level),
                    static_cast<std::uint8_t>(level < level_ ? kKnown | kFull : kKnown));
      }
    }
  }

  /// Whether the level above says what is at this one.
  bool is_given(std::size_t block, int level) const { return level == kBaseLevel && coarse_blocks_[block]; }
  /// Whether all voxels of a block are known to both sides.
  bool is_done(std::size_t block) const { return coded_[level_][block * size_at(level_)] != kNotCoded; }

  /// For each free voxel of the level above: are all its parts known?
  void walk_full(std::size_t block, int level) {
    if (coded_[0][block] == kUnknown || is_done(block)) return;
    if (is_given(block, level)) {
      for (std::size_t voxel = 0; voxel < size_at(level - 1); ++voxel)
        if (std::uint8_t& state = coded_[level - 1][block * size_at(level - 1) + voxel]; state == kKnown)
          state |= kFull;
      return;
    }
    coder_.begin(block);
    const int above = level - 1;
    pad(coded_, above, block, fine_);
    if (above > 0) pad(coded_, above - 1, block, coarse_);
    const bool has_base = has_base_[block];
    if (has_base) pad(base_, above, block, base_fine_);
    if (has_base && above > 0) pad(base_, above - 1, block, base_coarse_);
    States& states = coded_[above];
    for (std::size_t voxel = 0; voxel < size_at(above); ++voxel) {
      std::uint8_t& state = states[block * size_at(above) + voxel];
      if (state != kKnown) continue;
      const std::size_t at = in_padded(voxel, above);
      const int octant = above > 0 ? octant_of(voxel, above) : 0;
      const std::size_t parent = above > 0 ? in_padded(parent_of(voxel, above), above - 1) : 0;
      const VoxelContext context = context_at(above, at, octant, parent, has_base);
      if (!coder_.decide(decision_of(block, decision_at(all_parts_known, level)), context,
                         is_full(above, block, voxel)))
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
    States& parts = coded_[level];
    if (coded_[0][block] == kUnknown) {
      std::fill_n(parts.begin() + static_cast<std::ptrdiff_t>(first), size_at(level), kUnknown);
      return;
    }
    pad(coded_, level, block, fine_);
    pad(coded_, level - 1, block, coarse_);
    const bool has_base = has_base_[block];
    if (has_base) pad(base_, level, block, base_fine_), pad(base_, level - 1, block, base_coarse_);
    for (std::size_t parent = 0; parent < size_at(level - 1); ++parent) {
      const std::size_t above = in_padded(parent, level - 1);
      const std::uint8_t parent_state = coarse_[above];
      std::uint8_t seen = 0;
      for (int child = 0; child < 8; ++child) {
        const std::size_t voxel = BlockStates::part_at(parent, child, level);
        const std::size_t at = in_padded(voxel, level);
        const std::uint8_t is = truth(level, first + voxel);
        std::uint8_t state = kUnknown;
        if ((parent_state & kFull) != 0) {
          state = kKnown;
        } else if (is_given(block, level)) {
          state = parent_state & (kKnown | kOccupied);
        } else if ((parent_state & kKnown) != 0) {
          const VoxelContext context = context_at(level, at, child, above, has_base);
          const bool last = child == 7, had = is_known_in_base(block, level, voxel);
          if ((parent_state & kOccupied) == 0) {
            // Some part is known, and if the level above could say that all are, not all of them.
            const bool known = had || (last && (seen & 0x7f) == 0) ? true
                               : last && (seen & 0x7f) == 0x7f
                                   ? false
                                   : coder_.decide(decision_of(block, decision_at(part_known_of_free, level)),
                                                   context, (is & kKnown) != 0);
            if (known) seen |= static_cast<std::uint8_t>(1u << child);
            state = known ? kKnown : kUnknown;
          } else if (last && seen == 0) {
            state = kKnown | kOccupied;
          } else if (had || coder_.decide(decision_of(block, decision_at(part_known_of_occupied, level)),
                                          context, (is & kKnown) != 0)) {
            const bool occupied = coder_.decide(decision_of(block, decision_at(part_occupied, level)),
                                                context, (is & kOccupied) != 0);
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
  FindBase find_base_;
  std::vector<bool> has_base_{}, coarse_blocks_{};
  BlockStates truth_{}, base_{}, coded_{};
  Padded fine_{}, coarse_{}, base_fine_{}, base_coarse_{};
  std::array<std::uint8_t, 27> none_{};
};

}  // namespace adit::perception
