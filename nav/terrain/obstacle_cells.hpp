// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "nav/footprint.hpp"
#include "nav/terrain/ground_grid.hpp"
#include "nav/terrain/terrain_params.hpp"
#include "nav/terrain/view.hpp"

namespace adit::nav {

/// What stands in the way, as 5 cm cells. A cell stays until rays went through it in several scans (a robot
/// that moved on leaves no ghost), until the ground there turns out to be passable, until it was hidden for
/// `memory`, or until the robot leaves it behind; a cell below the lowest ray (the blind spot of a spinning
/// lidar) is remembered as long as it is near.
class ObstacleCells {
 public:
  static constexpr float kCell = 0.05f;              ///< m
  static constexpr std::size_t kMaxCells = 200'000;  ///< in all
  struct Entry {
    int ix, iy;
    float z_low, z_high;
    std::uint32_t scan;
    std::int32_t hits;  ///< of the newest scan that hit it
    std::int32_t misses;
    bool solid;            ///< once hit by more than stray returns
    bool again;            ///< hit more than once: a single return is noise
    float since, stamp;    ///< hit first and last, s
    float mean_x, mean_y;  ///< of the newest returns, m: where in the cell the surface is
    std::int32_t weight;   ///< of them
    std::int32_t under;    ///< returns of the newest scan from what may be climbed
    float climb;           ///< above the ground before it, the highest of the newest scan, m
    float x() const { return (static_cast<float>(ix) + 0.5f) * kCell; }
    float y() const { return (static_cast<float>(iy) + 0.5f) * kCell; }
  };

  ObstacleCells(const Footprint& body, const TerrainParams& params);
  void clear();

  void begin_scan(float now) {
    ++scan_;
    now_ = now;
  }
  /// A return from an obstacle, `climb` metres above the ground before it.
  void mark(float x, float y, float z, float climb);
  /// A return from something that is no obstacle but nearly as high, after all that are from one: a cell with
  /// more of these than of those, none of which is much too high, holds a stair measured with noise.
  void mark_under(float x, float y);
  /// Drops what is free by now, or no more than a `step` (m) above the ground as it is known by now.
  void keep(const View& view, const RayImage& rays, const GroundGrid& ground, float step);

  std::span<const Entry> entries() const { return entries_; }
  std::size_t max_cells() const { return max_cells_; }

 private:
  static int cell(float v) { return floor_int(v * (1.0f / kCell)); }
  std::size_t slot(int ix, int iy) const {
    return static_cast<std::size_t>(((ix & mask_) << bits_) | (iy & mask_));
  }
  bool stays(Entry& entry, const View& view, const RayImage& rays, float step, bool passable) const;
  bool stray(const Entry& entry, float dx, float dy, float range) const;

  Footprint body_;
  TerrainParams params_;
  int bits_, mask_;                   ///< of a torus that is more than twice as wide as the range
  std::size_t max_cells_;             ///< every cell within range fits, up to kMaxCells
  std::vector<std::uint32_t> slots_;  ///< index into entries_ plus one, or 0
  std::vector<Entry> entries_{};
  std::uint32_t scan_{0};
  float now_{0};
};

}  // namespace adit::nav
