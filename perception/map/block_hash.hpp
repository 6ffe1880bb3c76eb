// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "perception/map/block.hpp"

namespace adit::perception {

/// A block's index in 48 bits; keys are ordered as the indices are. `index` must be within
/// BlockIndex::kLimit.
constexpr std::uint64_t block_key(const BlockIndex& index) {
  const auto part = [](std::int32_t v) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(v + BlockIndex::kLimit)) & 0xffffu;
  };
  return part(index.x) << 32 | part(index.y) << 16 | part(index.z);
}

constexpr BlockIndex block_of_key(std::uint64_t key) {
  const auto part = [](std::uint64_t v) {
    return static_cast<std::int32_t>(v & 0xffffu) - BlockIndex::kLimit;
  };
  return {part(key >> 32), part(key >> 16), part(key)};
}

constexpr bool is_within_limit(const BlockIndex& b) {
  constexpr std::int32_t limit = BlockIndex::kLimit;
  return b.x > -limit && b.x < limit && b.y > -limit && b.y < limit && b.z > -limit && b.z < limit;
}

/// Blocks by their index: a dense array in the order in which blocks were added, and an open-addressing table
/// (linear probing, at most half full) that leads into it. Blocks are never removed, so positions are stable.
template <class Value>
class BlockHash {
 public:
  struct Entry {
    std::uint64_t key{};
    Value value{};
  };
  static constexpr std::uint32_t kNone = 0xffffffffu;

  std::size_t size() const { return entries_.size(); }
  Entry& operator[](std::uint32_t position) { return entries_[position]; }
  const Entry& operator[](std::uint32_t position) const { return entries_[position]; }
  const std::vector<Entry>& entries() const { return entries_; }

  /// Position of the block with that key; kNone without one.
  std::uint32_t find(std::uint64_t key) const {
    if (table_.empty()) return kNone;
    for (std::size_t at = home(key);; at = (at + 1) & (table_.size() - 1)) {
      const std::uint32_t position = table_[at];
      if (position == kNone || entries_[position].key == key) return position;
    }
  }

  /// Position of the block with that key, which is added when there is none.
  std::uint32_t find_or_add(std::uint64_t key) {
    if (2 * (entries_.size() + 1) > table_.size()) grow();
    for (std::size_t at = home(key);; at = (at + 1) & (table_.size() - 1)) {
      const std::uint32_t position = table_[at];
      if (position != kNone && entries_[position].key != key) continue;
      if (position != kNone) return position;
      table_[at] = static_cast<std::uint32_t>(entries_.size());
      entries_.push_back({key, Value{}});
      return table_[at];
    }
  }

  /// Positions of all blocks, by rising index.
  std::vector<std::uint32_t> sorted() const {
    std::vector<std::uint32_t> positions(entries_.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) positions[i] = i;
    std::sort(positions.begin(), positions.end(),
              [this](std::uint32_t a, std::uint32_t b) { return entries_[a].key < entries_[b].key; });
    return positions;
  }

  std::size_t bytes() const {
    return entries_.capacity() * sizeof(Entry) + table_.capacity() * sizeof(std::uint32_t);
  }

 private:
  /// Fibonacci hashing: the upper bits of the product.
  std::size_t home(std::uint64_t key) const {
    return static_cast<std::size_t>(key * 0x9e3779b97f4a7c15u >> shift_);
  }

  void grow() {
    const std::size_t size = table_.empty() ? kFirstSize : 2 * table_.size();
    shift_ = table_.empty() ? 64 - kFirstBits : shift_ - 1;
    table_.assign(size, kNone);
    for (std::uint32_t i = 0; i < entries_.size(); ++i) {
      std::size_t at = home(entries_[i].key);
      while (table_[at] != kNone) at = (at + 1) & (size - 1);
      table_[at] = i;
    }
  }

  static constexpr int kFirstBits = 6;
  static constexpr std::size_t kFirstSize = std::size_t{1} << kFirstBits;

  std::vector<Entry> entries_{};
  std::vector<std::uint32_t> table_{};
  int shift_{64 - kFirstBits};
};

}  // namespace adit::perception
