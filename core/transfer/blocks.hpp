// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace adit::transfer {

/// Which blocks of one content are at a peer, and which are on their way to it.
struct Blocks {
  std::vector<bool> has{}, flying{};
  std::size_t left{};  ///< Neither there nor on their way.

  /// Begins with so many blocks, of which none is there.
  void begin(std::size_t count) {
    has.assign(count, false);
    flying.assign(count, false);
    left = count;
  }
  /// Whether a block is neither there nor on its way.
  bool lacks(std::size_t index) const { return index < has.size() && !has[index] && !flying[index]; }
  /// Whether all blocks are there.
  bool complete() const {
    return !has.empty() && std::ranges::all_of(has, [](bool one) { return one; });
  }
  /// Notes that a block that the peer lacks is on its way.
  void sent(std::size_t index) {
    flying[index] = true;
    --left;
  }
  /// Notes that blocks are there, whether or not they were on their way.
  void acknowledged(std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count && i < has.size(); ++i) {
      if (lacks(i)) --left;
      has[i] = true;
      flying[i] = false;
    }
  }
  /// Notes that blocks are not on their way any more.
  void lost(std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count && i < has.size(); ++i) {
      if (!flying[i]) continue;
      flying[i] = false;
      if (!has[i]) ++left;
    }
  }
};

}  // namespace adit::transfer
