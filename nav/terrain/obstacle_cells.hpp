// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "nav/geometry/footprint.hpp"
#include "nav/terrain/ground_grid.hpp"
#include "nav/terrain/lidar_range_image.hpp"
#include "nav/terrain/view.hpp"

namespace adit::nav {

/// Obstacle map of 5 cm cells. A cell is removed when rays passed through it in several scans (so a robot
/// that moved on leaves no trace), when the ground there turns out to be passable, when it was hidden for
/// 4 s, or when the robot leaves it behind. A cell below the lowest ray (the blind spot of a
/// spinning lidar) stays as long as it is near.
class ObstacleCells {
 public:
  static constexpr float kCell = 0.05f;              ///< m
  static constexpr std::size_t kMaxCells = 200'000;  ///< In total.
  struct Entry {
    int ix, iy;
    float z_low, z_high;
    std::uint32_t scan;
    std::int32_t hits;  ///< In the newest scan that hit it.
    std::int32_t free_hits;
    bool solid;            ///< It had more hits than stray returns give.
    bool again;            ///< It was hit more than once: a single return is noise.
    float since, stamp;    ///< Times of the first and last hit, s.
    float mean_x, mean_y;  ///< Mean of the newest returns, m: the position of the surface in the cell.
    std::int32_t weight;   ///< Number of returns in the mean.
    std::int32_t under;    ///< Returns of the newest scan that were low enough to climb.
    float climb;           ///< Highest return of the newest scan above the support height, m.
    float x() const { return (static_cast<float>(ix) + 0.5f) * kCell; }
    float y() const { return (static_cast<float>(iy) + 0.5f) * kCell; }
  };

  /// `range`: radius of the map around the robot, m.
  ObstacleCells(const Footprint& body, double range);
  void clear();

  void begin_scan(float now) {
    ++scan_;
    now_ = now;
  }
  /// Adds a return from an obstacle, `climb` metres above the support height.
  void mark(float x, float y, float z, float climb);
  /// Adds a return nearly as high as an obstacle; call it after all mark(). A cell with more of these than of
  /// obstacle returns, none of them much too high, holds a stair measured with noise.
  void mark_under(float x, float y);
  /// What a further lidar saw.
  struct Seen {
    View view{};
    LidarRangeImage rays{};
  };
  /// Removes cells that are free by now, or at most `step` (m) above the ground as known by now. `more`: what
  /// further lidars saw through.
  void keep(const View& view, const LidarRangeImage& rays, std::span<const Seen> more,
            const GroundGrid& ground, float step);

  std::span<const Entry> entries() const { return entries_; }
  std::size_t max_cells() const { return max_cells_; }

 private:
  static int cell(float v) { return round_down(v * (1.0f / kCell)); }
  std::size_t slot(int ix, int iy) const {
    return static_cast<std::size_t>(((ix & mask_) << bits_) | (iy & mask_));
  }
  bool stays(Entry& entry, const View& view, const LidarRangeImage& rays, std::span<const Seen> more,
             float step, bool passable) const;
  bool stray(const Entry& entry, float dx, float dy, float range) const;

  Footprint body_;
  double range_;                      ///< m
  int bits_, mask_;                   ///< Of a torus more than twice as wide as the range.
  std::size_t max_cells_;             ///< Every cell within range fits, up to kMaxCells.
  std::vector<std::uint32_t> slots_;  ///< Index into entries_ plus one, or 0.
  std::vector<Entry> entries_{};
  std::uint32_t scan_{0};
  float now_{0};
};

}  // namespace adit::nav
