// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "nav/terrain/ground_grid.hpp"
#include "nav/terrain/lidar_range_image.hpp"
#include "nav/terrain/view.hpp"

namespace adit::nav {

/// Detects missing ground: edges, holes and stairs down. Each ground cell has a probability, stored as
/// log-odds. Evidence for a drop are rays that passed below the ground's height where the ground should have
/// stopped them: in the cell where they passed that height, and between it and the last measured ground. Two
/// weaker cues make no drop beyond 2 m on their own: missing returns in a ring that returns elsewhere and did
/// so before (a hole too deep to see, or water), and returns below ground that was measured (a gap in a
/// floor, or a mirror). Rays that are too flat or too sparse to distinguish an edge from a ramp do not count.
/// Measured ground is evidence against a drop. Cells below the lowest ray cannot be seen and keep their
/// probability.
class Drops {
 public:
  /// Cells with a higher drop probability block; cells with a lower one slow the robot.
  static constexpr float kBlocks = 0.9f;
  /// A cell of the ground with the probability of a drop.
  struct Cell {
    std::uint32_t index;  ///< In the ground's window.
    float probability;    ///< [0.5, 1)
  };

  /// Sizes of drops, of the sensor's view and of the body.
  struct Geometry {
    float depth;      ///< Minimum depth of a drop, m.
    float sure;       ///< Range up to which a ray that passes the ground's height shows an edge, m.
    float half_body;  ///< Half the body's length, m; shorter gaps are passable.
    float rings;      ///< Between two rings of the lidar, rad.
  };
  Drops(const Geometry& geometry, const GroundGrid& ground);
  void clear();

  /// Starts a scan. `solid`: marks the cells of the ground's window with an obstacle; valid until finish().
  /// `farthest`: range where three standard deviations of the ground's height reach the depth of a drop, m.
  void begin_scan(const GroundGrid& ground, std::span<const std::uint8_t> solid, float now, float farthest);
  /// Adds a return below the ground.
  void below(const View& view, const Eigen::Vector3f& point, const GroundGrid& ground);
  /// Evaluates the directions without a return.
  void count_missing_returns(const View& view, const LidarRangeImage& rays, const GroundGrid& ground);
  /// Updates cells().
  void finish(const View& view, const LidarRangeImage& rays, const GroundGrid& ground);

  std::span<const Cell> cells() const { return cells_; }

 private:
  /// Evidence that a ray gives for a drop. `missing`: returns that were missing in several scans; `doubtful`:
  /// a return below measured ground or an obstacle, as a mirrored ray gives, or beyond `sure`; `level`: a
  /// return no lower than the ground around the robot, doubtful behind measured ground and none elsewhere.
  enum class Cue { none, ray, missing, doubtful, level };
  /// Votes for a drop where a ray passed the ground's height. Returns the cue that the ray gives, or none.
  Cue pass(const View& view, const Eigen::Vector3f& ray, float end, Cue cue, const GroundGrid& ground);
  /// Whether a ray that passed the ground's height at `range` continued below measured ground or below an
  /// obstacle, which only a mirrored ray does.
  bool under_ground(const View& view, const Eigen::Vector3f& ray, float range, float end,
                    const GroundGrid& ground) const;
  void vote(int index, float range, Cue cue, const GroundGrid& ground);
  /// Whether a ray went below the ground in this cell or a neighbour.
  bool has_cue(int index, const GroundGrid& ground) const;
  /// Computes which lidar column points in each direction of the map.
  void turn_columns(const View& view);

  Geometry geometry_;
  int edge_cells_;  ///< Maximum number of cells between a ray's place and the last measured ground.
  float farthest_{};
  std::span<const std::uint8_t> solid_{};
  std::vector<float> odds_;  ///< Log-odds, on the GroundGrid's torus.
  std::vector<std::uint8_t> rays_below_;
  std::vector<float> stamp_;
  /// Consecutive missing returns per direction, by the lidar's row and the map's column.
  std::vector<std::uint8_t> missing_returns_;
  std::vector<std::uint8_t> returned_;  ///< Lidar directions that have had a return.
  std::array<std::uint8_t, LidarRangeImage::kColumns> column_{};  ///< The lidar's, for each of the map.
  std::vector<Cell> cells_{};
  bool any_{false};
  float now_{};
};

}  // namespace adit::nav
