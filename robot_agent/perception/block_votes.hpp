// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace adit::agent {

/// Merges one block of 4 x 4 x 4 voxels from the submaps that saw it, added from the oldest to the newest.
/// The rule is perception::VoxelImage's, for all 64 voxels at once: the newest wins, unless the two before it
/// both say occupied.
class BlockVotes {
 public:
  void add(std::uint64_t known, std::uint64_t occupied) {
    third_ = (third_ & ~known) | (second_ & known);
    second_ = (second_ & ~known) | (newest_ & known);
    newest_ = (newest_ & ~known) | (occupied & known);
    known_ |= known;
  }
  std::uint64_t known() const { return known_; }
  std::uint64_t occupied() const { return newest_ | (second_ & third_); }
  /// Whether both show the same.
  bool shows(const BlockVotes& other) const {
    return known() == other.known() && occupied() == other.occupied();
  }

 private:
  std::uint64_t known_{};
  std::uint64_t newest_{}, second_{}, third_{};  ///< Occupied by the last three votes.
};

}  // namespace adit::agent
