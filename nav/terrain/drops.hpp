// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "nav/terrain/ground_grid.hpp"
#include "nav/terrain/terrain_params.hpp"
#include "nav/terrain/view.hpp"

namespace adit::nav {

/// Where the ground is missing: edges, holes, stairs down; a probability for each cell of the ground, as
/// log-odds. For a drop there speak rays that went on below where ground should have stopped them, at the
/// place where they passed the ground's height and between that and the last ground seen; and rays that did
/// not come back though their ring does elsewhere and they did before (a hole too deep to see, water), or
/// ended below ground that was measured (a gap in a floor, or a mirror), which alone make no drop farther
/// away than 2 m. Nor do rays that are too flat or too far apart to tell an edge from a ramp. Ground that is
/// measured speaks against it. What cannot be seen, below the lowest ray, is remembered.
class Drops {
 public:
  /// A cell that is more likely a drop than this blocks, a less likely one slows.
  static constexpr float kBlocks = 0.9f;
  struct Cell {
    std::uint32_t index;  ///< in the ground's window
    float probability;    ///< [0.5, 1)
  };

  struct Geometry {
    float depth;      ///< of the least drop, m
    float sure;       ///< to where a ray that passes the ground's height shows an edge, m
    float half_body;  ///< what is shorter is passed over, m
  };
  Drops(const TerrainParams& params, const Geometry& geometry, const GroundGrid& ground);
  void clear();

  /// `solid`: the cells of the ground's window that hold an obstacle; valid until finish(). `farthest`: to
  /// where three standard deviations of the ground's height are less than a drop, m.
  void begin_scan(const GroundGrid& ground, std::span<const std::uint8_t> solid, float now, float farthest);
  /// A return that lies below the ground.
  void below(const View& view, const Eigen::Vector3f& point, const GroundGrid& ground);
  /// Directions without a return.
  void silent(const View& view, const RayImage& rays, const GroundGrid& ground);
  /// Works out the cells.
  void finish(const View& view, const RayImage& rays, const GroundGrid& ground);

  std::span<const Cell> cells() const { return cells_; }

 private:
  /// `doubtful`: a ray that did not come back, or ended below ground that was seen, as a mirrored one does.
  enum class Cue { none, ray, doubtful };
  /// Votes where a ray passed the ground's height; what it shows, or none.
  Cue pass(const View& view, const Eigen::Vector3f& ray, float end, Cue cue, const GroundGrid& ground);
  /// Whether a ray that passed the ground at `range` went on below ground that was measured, or below what
  /// stands on it, as only a mirrored one does.
  bool under_ground(const View& view, const Eigen::Vector3f& ray, float range, float end,
                    const GroundGrid& ground) const;
  void vote(int index, float range, Cue cue, const GroundGrid& ground);
  /// Whether a ray went below the ground at or beside a cell.
  bool has_cue(int index, const GroundGrid& ground) const;
  /// Works out which column of the lidar looks in each direction of the map.
  void turn_columns(const View& view);

  TerrainParams params_;
  Geometry geometry_;
  int edge_cells_;  ///< most between a ray's place and the last ground seen
  float farthest_{};
  std::span<const std::uint8_t> solid_{};
  std::vector<float> odds_;  ///< log-odds, of a GroundGrid's torus
  std::vector<std::uint8_t> rays_below_;
  std::vector<float> stamp_;
  /// Scans without a return in a direction of the map, by the lidar's row and the map's column.
  std::vector<std::uint8_t> quiet_;
  std::vector<std::uint8_t> returned_;  ///< in this direction of the lidar there ever was a return
  std::array<std::uint8_t, RayImage::kColumns> column_{};  ///< of the lidar, by the map's
  std::vector<Cell> cells_{};
  bool any_{false};
  float now_{};
};

}  // namespace adit::nav
