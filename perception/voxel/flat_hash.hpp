// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace adit::perception {

/// Packs the indices of a voxel into a key; each index in [-2^20, 2^20).
inline std::uint64_t voxel_key(std::int32_t x, std::int32_t y, std::int32_t z) {
  constexpr std::int32_t kOffset = 1 << 20;
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
  return (static_cast<std::uint64_t>(x + kOffset) & kMask) |
         (static_cast<std::uint64_t>(y + kOffset) & kMask) << 21 |
         (static_cast<std::uint64_t>(z + kOffset) & kMask) << 42;
}

/// The indices of the voxel of a key.
inline Eigen::Vector3i voxel_of(std::uint64_t key) {
  constexpr std::int32_t kOffset = 1 << 20;
  const auto index = [&](int shift) {
    return static_cast<std::int32_t>(key >> shift & ((std::uint64_t{1} << 21) - 1)) - kOffset;
  };
  return {index(0), index(21), index(42)};
}

/// Hash table from voxel keys to values: open addressing with linear probing, at most 5/8 full. Erasing moves
/// the entries behind back, so that no tombstones accumulate. The order of the slots depends on the keys and
/// the order of insertion only.
template <class Value>
class FlatHash {
 public:
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};  ///< Not the key of any voxel.
  struct Slot {
    std::uint64_t key{kEmpty};
    Value value{};
  };

  FlatHash() : slots_(1024) {}
  /// With room for `count` values.
  explicit FlatHash(std::size_t count) : slots_(std::bit_ceil(std::max<std::size_t>(1024, 2 * count))) {}

  Value* find(std::uint64_t key) { return const_cast<Value*>(std::as_const(*this).find(key)); }
  const Value* find(std::uint64_t key) const {
    for (std::size_t at = home(key);; at = next(at)) {
      const Slot& slot = slots_[at];
      if (slot.key == key) return &slot.value;
      if (slot.key == kEmpty) return nullptr;
    }
  }
  /// The value of `key`, which is made if it is missing. The reference holds until the next call.
  Value& at(std::uint64_t key) {
    if (size_ * 8 >= slots_.size() * 5) grow();
    std::size_t at = home(key);
    while (slots_[at].key != key && slots_[at].key != kEmpty) at = next(at);
    if (slots_[at].key == kEmpty) {
      slots_[at] = {key, Value{}};
      ++size_;
    }
    return slots_[at].value;
  }
  /// Erases the values of `count` slots from `first` on (modulo the capacity) for which `is_old` holds. The
  /// next call continues at the returned slot.
  template <class IsOld>
  std::size_t sweep(std::size_t first, std::size_t count, const IsOld& is_old) {
    std::size_t at = first & (slots_.size() - 1);
    for (std::size_t n = 0; n < count; ++n) {
      // The entry that moves into the place of an erased one is judged as well.
      while (slots_[at].key != kEmpty && is_old(slots_[at].value)) erase(at);
      at = next(at);
    }
    return at;
  }
  /// Makes room: erases the costliest of the next `count` values from the slot `hand` on (modulo the
  /// capacity), unless none costs more than `limit`; at least `count` values must be there. `hand` moves on
  /// behind them.
  ///
  /// @param cost  Called with a slot.
  /// @return Whether a value was erased.
  template <class Cost>
  bool evict(std::size_t& hand, int count, float limit, const Cost& cost) {
    std::size_t at = hand & (slots_.size() - 1), worst = slots_.size();
    for (; count > 0; at = next(at)) {
      if (slots_[at].key == kEmpty) continue;
      --count;
      if (const float each = cost(slots_[at]); each > limit) {
        limit = each;
        worst = at;
      }
    }
    hand = at;
    if (worst == slots_.size()) return false;
    erase(worst);
    return true;
  }
  void clear() {
    for (Slot& slot : slots_) slot.key = kEmpty;
    size_ = 0;
  }

  std::size_t size() const { return size_; }
  /// All slots, the empty ones too; their keys must not be changed.
  std::vector<Slot>& values() { return slots_; }
  const std::vector<Slot>& slots() const { return slots_; }
  std::size_t bytes() const { return slots_.size() * sizeof(Slot); }

 private:
  std::size_t next(std::size_t at) const { return (at + 1) & (slots_.size() - 1); }
  std::size_t home(std::uint64_t key) const {
    key ^= key >> 32;
    key *= 0x9e3779b97f4a7c15ULL;
    return (key ^ key >> 29) & (slots_.size() - 1);
  }
  void erase(std::size_t hole) {
    for (std::size_t at = next(hole); slots_[at].key != kEmpty; at = next(at)) {
      const std::size_t wanted = home(slots_[at].key), mask = slots_.size() - 1;
      // Moves when its home is not between the hole and its place.
      if (((at - wanted) & mask) < ((at - hole) & mask)) continue;
      slots_[hole] = slots_[at];
      hole = at;
    }
    slots_[hole].key = kEmpty;
    --size_;
  }
  void grow() {
    std::vector<Slot> old(slots_.size() * 2);
    old.swap(slots_);
    for (Slot& slot : old) {
      if (slot.key == kEmpty) continue;
      std::size_t at = home(slot.key);
      while (slots_[at].key != kEmpty) at = next(at);
      slots_[at] = std::move(slot);
    }
  }

  std::vector<Slot> slots_;  ///< Their number is a power of two.
  std::size_t size_{};
};

}  // namespace adit::perception
