// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <unordered_map>

#include "nav/routing/tile.hpp"

namespace adit::nav {

/// Blocks of 8 x 8 places of tiles, for the question whether a place is near to one that has a tile.
class SeenBlocks {
 public:
  /// `reach`: places at most this far from a tile are near, tiles; of those farther away up to 7 more, too.
  explicit SeenBlocks(int reach) : reach_((reach + kSide - 1) / kSide) {}

  /// Records that a place got its first tile, or lost its last one.
  void add(int tx, int ty) {
    if (places_[block_of(tx, ty)]++ == 0) count_around(tx >> kShift, ty >> kShift, 1);
  }
  void remove(int tx, int ty) {
    const auto found = places_.find(block_of(tx, ty));
    if (found == places_.end() || --found->second > 0) return;
    places_.erase(found);
    count_around(tx >> kShift, ty >> kShift, -1);
  }
  bool near(int tx, int ty) const { return near_.contains(block_of(tx, ty)); }
  void clear() {
    places_.clear();
    near_.clear();
  }

 private:
  static constexpr int kShift = 3, kSide = 1 << kShift;
  static std::uint64_t block_of(int tx, int ty) { return grid_key(tx >> kShift, ty >> kShift); }
  void count_around(int x, int y, int more) {
    for (int v = y - reach_; v <= y + reach_; ++v)
      for (int u = x - reach_; u <= x + reach_; ++u)
        if ((near_[grid_key(u, v)] += more) == 0) near_.erase(grid_key(u, v));
  }

  int reach_;  // Blocks.
  // Looked up only, never iterated.
  std::unordered_map<std::uint64_t, int> places_{};  // With tiles, of each block.
  std::unordered_map<std::uint64_t, int> near_{};  // Blocks with tiles in reach, of each block that has any.
};

}  // namespace adit::nav
