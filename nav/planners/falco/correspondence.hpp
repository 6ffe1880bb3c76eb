// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "nav/geometry/footprint.hpp"
#include "nav/planners/falco/path_tree.hpp"

namespace adit::nav {

/// A set of parts of a PathTree's paths that are blocked: one bit per (stage, node), one cache line in all.
struct alignas(64) PathMask {
  std::array<std::uint64_t, 8> words{};

  void set(int bit) { words[bit >> 6] |= std::uint64_t{1} << (bit & 63); }
  bool test(int bit) const { return (words[bit >> 6] >> (bit & 63)) & 1u; }
  /// Unrolled, so that a mask to which many are added stays in registers.
  PathMask& operator|=(const PathMask& other) {
#pragma GCC unroll 8
    for (std::size_t i = 0; i < words.size(); ++i) words[i] |= other.words[i];
    return *this;
  }
  bool any() const {
    std::uint64_t all = 0;
    for (auto w : words) all |= w;
    return all != 0;
  }
  /// Every path is already blocked in its first stage.
  bool dead() const { return (words[0] & 0x7f) == 0x7f; }
};

/// Correspondence grid: a lookup table of the path parts that an obstacle at a given place blocks.
///
/// Falco stores a Cartesian grid and rotates each obstacle point into each of 36 headings. This grid is
/// *polar*, 1 degree by 5 cm: a rotation by ten degrees is a shift by ten columns, so checking a heading
/// costs one table access and the union of one cache line. The swept body is the footprint's polygon and not
/// a disc around it, so a robot that is longer than wide fits through a door.
///
/// An obstacle that is already inside the body's margin at the start of the path blocks only motion that
/// brings it deeper inside, so a robot that came too close can slide along it or move away.
class CorrespondenceGrid {
 public:
  static constexpr int kAngles = 360;
  static constexpr double kRing = 0.05;  ///< m

  /// Builds the grid by marking each cell of each path's sweep (10 to 20 ms). A default-constructed grid is
  /// empty and blocks nothing.
  CorrespondenceGrid() = default;
  CorrespondenceGrid(const PathTree& tree, const Footprint& body);

  /// Number of rings; an obstacle beyond the last ring blocks nothing.
  int rings() const { return rings_; }
  /// Ring of an obstacle at this range (m); may be >= rings().
  static int ring_of(float range) { return static_cast<int>(range * static_cast<float>(1.0 / kRing)); }
  /// Largest |angle| (degrees, [0, 180]) in this ring at which an obstacle blocks anything, or -1.
  int half_angle(int ring) const { return half_angle_[ring]; }
  /// The parts that an obstacle blocks in this ring at `angle` in [0, 360) degrees, counter-clockwise from
  /// the starting direction of the paths.
  const PathMask& at(int ring, int angle) const { return masks_[ring * kAngles + angle]; }

 private:
  int rings_{0};
  std::vector<int> half_angle_{};
  std::vector<PathMask> masks_{};
};

}  // namespace adit::nav
