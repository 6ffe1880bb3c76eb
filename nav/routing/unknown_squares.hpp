// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace adit::nav {

/// Numbers the squares of unknown space that a search reaches, in the order in which it does, in a hash table
/// that keeps its memory from search to search.
class UnknownSquares {
 public:
  /// Place of a tile, and height in levels from the start's.
  struct Square {
    int tx, ty, level;
    bool operator==(const Square&) const = default;
  };
  static constexpr std::size_t kMax = 262'144;  ///< With their four nodes each 17 MB.

  void clear() {
    squares_.clear();
    if (++round_ == 0) {
      std::fill(slots_.begin(), slots_.end(), Slot{});
      round_ = 1;
    }
  }
  /// Number of a square, or -1.
  int find(const Square& square) const { return slots_.empty() ? -1 : at(slot_of(square)); }
  /// Adds a square that find() does not know; -1: there are kMax already.
  int add(const Square& square) {
    if (full()) return -1;
    if (slots_.size() < 2 * (squares_.size() + 1)) grow();
    squares_.push_back(square);
    const int index = static_cast<int>(squares_.size()) - 1;
    slots_[slot_of(square)] = {round_, index};
    return index;
  }
  bool full() const { return squares_.size() >= kMax; }
  std::size_t size() const { return squares_.size(); }
  const Square& operator[](std::size_t index) const { return squares_[index]; }
  /// bytes
  std::size_t memory() const {
    return slots_.capacity() * sizeof(Slot) + squares_.capacity() * sizeof(Square);
  }

 private:
  struct Slot {
    std::uint32_t round{0};
    int index{-1};
  };
  int at(std::size_t slot) const { return slots_[slot].round == round_ ? slots_[slot].index : -1; }
  /// The slot of a square, or the free one for it.
  std::size_t slot_of(const Square& square) const {
    std::uint64_t hash = static_cast<std::uint32_t>(square.tx) * 0x9e3779b97f4a7c15u;
    hash = (hash ^ (hash >> 29) ^ static_cast<std::uint32_t>(square.ty)) * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ (hash >> 32) ^ static_cast<std::uint32_t>(square.level)) * 0x94d049bb133111ebu;
    std::size_t slot = static_cast<std::size_t>(hash >> 32) & (slots_.size() - 1);
    for (; at(slot) >= 0; slot = (slot + 1) & (slots_.size() - 1))
      if (squares_[static_cast<std::size_t>(at(slot))] == square) break;
    return slot;
  }
  void grow() {
    constexpr std::size_t kFirst = 4096;  // A power of two.
    slots_.assign(std::max(kFirst, 2 * slots_.size()), Slot{});
    for (std::size_t i = 0; i < squares_.size(); ++i)
      slots_[slot_of(squares_[i])] = {round_, static_cast<int>(i)};
  }

  std::vector<Slot> slots_{};
  std::vector<Square> squares_{};
  std::uint32_t round_{1};
};

}  // namespace adit::nav
