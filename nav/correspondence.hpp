// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "nav/footprint.hpp"
#include "nav/path_tree.hpp"

namespace adit::nav {

/// The parts of a PathTree's paths that are blocked: one bit per (stage, node); one cache line.
struct alignas(64) PathMask {
  std::array<std::uint64_t, 8> words{};

  void set(int bit) { words[bit >> 6] |= std::uint64_t{1} << (bit & 63); }
  bool test(int bit) const { return (words[bit >> 6] >> (bit & 63)) & 1u; }
  PathMask& operator|=(const PathMask& other) {
    for (std::size_t i = 0; i < words.size(); ++i) words[i] |= other.words[i];
    return *this;
  }
  bool any() const {
    std::uint64_t all = 0;
    for (auto w : words) all |= w;
    return all != 0;
  }
  /// Every path is blocked in its first stage already.
  bool dead() const { return (words[0] & 0x7f) == 0x7f; }
};

/// The correspondence grid: which parts of which paths an obstacle at a place blocks.
///
/// Falco keeps a Cartesian grid and rotates each obstacle point into each of 36 headings. This grid is
/// *polar*, 1 degree by 5 cm: a turn of ten degrees is a shift of ten columns, so that checking a heading
/// costs one table access and the union of one cache line. And the body is the polygon that moves, not a disc
/// around it: a robot longer than wide still fits a door.
///
/// An obstacle that is inside the body's margin already where the path starts blocks only what would bring it
/// deeper in: a robot that came too close can slide along or away.
class CorrespondenceGrid {
 public:
  static constexpr int kAngles = 360;
  static constexpr double kRing = 0.05;  ///< m

  /// Builds the grid: each cell of a path's sweep is marked (10 to 20 ms). An empty grid, which blocks
  /// nothing, is what a default-constructed one is.
  CorrespondenceGrid() = default;
  CorrespondenceGrid(const PathTree& tree, const Footprint& body);

  /// Rings of the grid; an obstacle in a ring beyond blocks nothing.
  int rings() const { return rings_; }
  /// The ring of an obstacle at this range (m); may be >= rings().
  static int ring_of(float range) { return static_cast<int>(range * static_cast<float>(1.0 / kRing)); }
  /// Largest |angle| (degrees, of 0..180) in this ring at which something blocks anything, or -1.
  int half_angle(int ring) const { return half_angle_[ring]; }
  /// What is blocked by an obstacle in this ring at `angle` in [0, 360) degrees, counter-clockwise from the
  /// direction in which the paths start.
  const PathMask& at(int ring, int angle) const { return masks_[ring * kAngles + angle]; }

 private:
  int rings_{0};
  std::vector<int> half_angle_{};
  std::vector<PathMask> masks_{};
};

}  // namespace adit::nav
