// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "core/geometry/pose.hpp"
#include "nav/local_map/local_map.hpp"
#include "nav/routing/surface_map.hpp"

namespace adit::nav {

/// The ground near the robot as its local map classified it, on the cells of a SurfaceMap. It decides about
/// walls and other tall things, about what passes, and about the heights of the ground, which the returns of
/// one direction of a single scan show less well. Low things, edges and drops are left to the scan:
/// TileBuilder makes steps of heights.
class NearGround {
 public:
  /// One cell of the surface map, made of those of the local map whose centres lie in it: their worst class
  /// and the mean height of those that were measured.
  struct Cell {
    enum class What : std::uint8_t {
      unknown,  ///< Neither ground nor an obstacle was seen.
      ground,   ///< Measured.
      blocked,  ///< By something tall.
      passing,  ///< Another robot, or what moves: no evidence for or against anything.
    };
    What what{};
    bool measured{};  ///< `low` was measured.
    bool fresh{};     ///< The newest scan measured the ground.
    /// Height of the ground, measured or inherited, m; NaN: none. For a body that climbs stairs inherited
    /// only beside what blocks.
    float low{LocalCell::kNone};
    float x{}, y{};  ///< Place of what blocks, m.
    float height{};  ///< Of it above the ground, m.
  };

  /// `climbs`: the body climbs stairs, so ground that was not measured may be the next tread.
  explicit NearGround(bool climbs);
  /// Takes the cells of a local map. `located`: base_link at its scan in the frame of the surface map.
  void take(const LocalMap& map, const Pose3& located);
  void clear() { side_ = 0; }
  /// The cell of the surface map with these coordinates; null where the local map decides nothing.
  const Cell* find(int ix, int iy) const {
    const auto u = static_cast<unsigned>(ix - x0_), v = static_cast<unsigned>(iy - y0_);
    if (u >= side_ || v >= side_) return nullptr;
    const Cell& cell = cells_[v * kSide + u];
    return std::isnan(cell.low) ? nullptr : &cell;
  }
  /// Writes what blocks, and the ground that was measured. SurfaceMap::begin_scan() must have been called.
  void write(SurfaceMap& map) const;

 private:
  static constexpr float kReach = 4.5f;  ///< The local map classifies so far around the robot, m.
  static constexpr int kHalf = static_cast<int>(kReach / kRouteCellF) + 2;
  static constexpr unsigned kSide = 2 * kHalf + 1;
  /// Sums over the cells of the local map that lie in one cell of the surface map.
  struct Sums {
    float measured{}, inherited{}, x{}, y{}, height{};
    std::uint8_t measured_count{}, inherited_count{}, blocked_count{};
    bool fresh{}, passing{}, undecided{};
  };
  static Cell cell_of(const Sums& sums);
  void forget_far_heights();

  bool climbs_;
  unsigned side_{0};  ///< kSide, or 0: no map.
  int x0_{}, y0_{};
  std::vector<Cell> cells_{};
  std::vector<Sums> sums_{};
};

}  // namespace adit::nav
